#pragma once
/// The topics. Names and types are those ROS 2 gives "/s4tp/...", so its tools read them as they are.
///
/// | topic                     | type                                  | rate [Hz] | late joiner gets the
/// last |
/// |---------------------------|---------------------------------------|-----------|---------------------------|
/// | rt/s4tp/tracked_objects   | autoware_perception_msgs TrackedObjects   | 10    | no  |
/// | rt/s4tp/predicted_objects | autoware_perception_msgs PredictedObjects | 10    | no  |
/// | rt/s4tp/trajectory        | autoware_planning_msgs Trajectory         | 10    | yes |
/// | rt/s4tp/fail_safe         | autoware_planning_msgs Trajectory         | 10    | yes |
/// | rt/s4tp/candidates        | visualization_msgs MarkerArray            | 10    | yes |
/// | rt/s4tp/control           | autoware_control_msgs Control             | 100   | no  |
/// | rt/s4tp/risk              | nav_msgs OccupancyGrid                    | 10, while somebody reads it |
/// yes | | rt/s4tp/path              | nav_msgs Path                             | 10    | yes | |
/// rt/s4tp/lanes             | visualization_msgs MarkerArray            | 1     | yes | |
/// rt/s4tp/explanation       | std_msgs String                           | 10    | yes | | rt/diagnostics |
/// diagnostic_msgs DiagnosticArray           | 1, and at mode changes | yes | | rt/tf                     |
/// tf2_msgs TFMessage                        | 10    | no  |
///
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

/// TELE-031 On the wire it is plain RTPS: tshark finds every message well formed, and its topic and type.
class DdsPublisher {
 public:
  /// TELE-030 Speaks on the loopback interface alone unless given another one or CYCLONEDDS_URI: Debian's
  /// Cyclone DDS has no DDS Security. \throws std::runtime_error with Cyclone's reason
  DdsPublisher(std::uint32_t domain, const std::string& interface_name);
  ~DdsPublisher();
  DdsPublisher(const DdsPublisher&) = delete;
  DdsPublisher& operator=(const DdsPublisher&) = delete;

  /// Publishes what is new. \param input  told on the diagnostics topic, without an ECU too; may be null
  void publish(const Watch& watch, const News& news, const InputReport* input = nullptr);
  [[nodiscard]] dds_entity_t participant() const { return participant_; }
  [[nodiscard]] std::uint64_t written(Topic topic) const { return written_[topic]; }
  [[nodiscard]] static const char* name(Topic topic);

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
