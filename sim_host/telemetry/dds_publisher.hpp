#pragma once
/// The topics. Names and types are those ROS 2 gives "/s4tp/...", so its tools read them as they are.
///
/// docs/telemetry.md has the table of topics, their types, rates and what a late joiner gets.
/// All are reliable, keep the last 1 (rt/tf: 10); "late joiner": durability transient local, else volatile.

#include <dds/dds.h>

#include <chrono>
#include <cstdint>
#include <string>

#include "sim_host/telemetry/input_report.hpp"
#include "sim_host/telemetry/watch.hpp"

namespace s4tp::telemetry {

enum Topic : std::uint8_t {
  kTrackedTopic = 0,
  kPredictedTopic,
  kTrajectoryTopic,
  kFailSafeTopic,
  kCandidatesTopic,
  kControlTopic,
  kRiskTopic,
  kPathTopic,
  kLanesTopic,
  kExplanationTopic,
  kDiagnosticsTopic,
  kTransformTopic,
  kTopicCount
};

/// Cyclone DDS's configuration: this interface alone, loopback where none is named; a CYCLONEDDS_URI goes before.
[[nodiscard]] std::string dds_configuration(const std::string& interface_name);

/// TELE-031 On the wire it is plain RTPS: tshark finds every message well formed, and its topic and type.
class DdsPublisher {
 public:
  /// TELE-030 Speaks on the loopback interface alone unless given another one or CYCLONEDDS_URI: Debian's
  /// Cyclone DDS has no DDS Security. \throws std::runtime_error with Cyclone's reason
  DdsPublisher(std::uint32_t domain, const std::string& interface_name);
  ~DdsPublisher();
  DdsPublisher(const DdsPublisher&) = delete;
  DdsPublisher& operator=(const DdsPublisher&) = delete;

  /// TELE-032 What reached the actuators, at its own pace: may be called beside the other publish(), by another
  /// thread, as what is made of a plan takes longer than a command stays in the memory.
  void publish(const ecu::ControlRecord& record);
  /// Publishes all else that is new. \param input  told on the diagnostics topic, without an ECU too; may be null
  void publish(const Watch& watch, const News& news, const InputReport* input = nullptr);
  [[nodiscard]] dds_entity_t participant() const { return participant_; }
  [[nodiscard]] std::uint64_t written(Topic topic) const { return written_[topic]; }
  [[nodiscard]] static const char* name(Topic topic);
  [[nodiscard]] static const dds_topic_descriptor_t& type(Topic topic);

 private:
  template <class Message>
  void write(Topic topic, const Message& message);
  void publish_plan(const Watch& watch);
  [[nodiscard]] bool anybody(Topic topic) const;

  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
  dds_entity_t writers_[kTopicCount] = {};
  std::uint64_t written_[kTopicCount] = {};
  std::uint32_t lanes_ms_ = 0;
  bool lanes_told_ = false;
  std::uint32_t diagnostics_ms_ = 0;
  bool diagnosed_ = false;
  std::chrono::steady_clock::time_point input_told_{};
};

}  // namespace s4tp::telemetry
