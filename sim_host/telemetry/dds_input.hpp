#pragma once
/// Input over DDS: object lists and lane maps from topics, as protected frames for the ECU. What the ECU
/// checks of frames it checks of these.
///
/// | topic                       | type                                    |
/// |-----------------------------|-----------------------------------------|
/// | rt/s4tp/input/tracked_objects | autoware_perception_msgs TrackedObjects |
/// | rt/s4tp/input/lane_map        | s4tp_msgs LaneMap                       |

#include <dds/dds.h>

#include <cstdint>
#include <ostream>

#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/track_list.hpp"
#include "hal/can.hpp"
#include "sim_host/telemetry/dds_input_values.hpp"
#include "sim_host/telemetry/input_report.hpp"
#include "sim_host/telemetry/rate_guard.hpp"

namespace s4tp::telemetry {

/// TELE-040 The same objects and the same map give the frames a node on the bus would send, to the bit.
class DdsInput {
 public:
  static constexpr std::uint32_t kPeriodMs = 10;
  static constexpr std::uint32_t kMapStandsMs = 2000;

  /// \param complaints  hears of refused messages, once a second a topic; must outlive this
  /// \throws std::runtime_error with Cyclone's reason
  DdsInput(dds_entity_t participant, std::ostream& complaints);

  /// TELE-044 Takes what has come; a message with anything wrong in it is refused whole, counted and told.
  void look(std::uint32_t now_ms);
  /// A share of 10 ms: at most 12 frames of the list and 7 of the map. TELE-045 A map that has not been told
  /// again for 2 s is not sent any longer: the ECU shall not take an ended publisher's map for confirmed.
  void send(std::uint32_t now_ms, hal::Can& can);
  [[nodiscard]] const InputReport& report() const { return report_; }

 private:
  struct Topic {
    explicit Topic(const char* topic) : name(topic) {}
    const char* name;
    dds_entity_t reader = 0;
    RateGuard rate;
    std::uint32_t told_ms = 0;
    bool told = false;
  };
  void open(dds_entity_t participant, const dds_topic_descriptor_t& type, Topic& topic);
  template <class Message, class Take>
  void take(Topic& topic, InputCounts& counts, std::uint32_t now_ms, Take take_one);

  std::ostream& complaints_;
  Topic objects_{"rt/s4tp/input/tracked_objects"};
  Topic maps_{"rt/s4tp/input/lane_map"};
  InputReport report_;
  TrackIds ids_;
  wire::Map map_;
  wire::TrackListSender track_sender_;
  wire::MapSender map_sender_;
  std::uint32_t map_ms_ = 0;
  bool map_known_ = false;
};

}  // namespace s4tp::telemetry
