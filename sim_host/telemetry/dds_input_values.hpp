#pragma once
/// Messages of the input topics as lists and maps of the wire. A message is believed whole or not at all.

#include <autoware_msgs.h>
#include <s4tp_msgs.h>

#include <array>
#include <cstdint>

#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/track_list.hpp"
#include "sim_host/telemetry/input_report.hpp"

namespace s4tp::telemetry {

using LaneMapMessage = s4tp_msgs_msg_dds__LaneMap_;

/// Track ids of objects: the last byte of the uuid where that is free, else the one longest unused.
class TrackIds {
 public:
  using Uuid = std::array<std::uint8_t, 16>;
  /// Once a list, before its objects.
  void next_list() { ++list_; }
  [[nodiscard]] std::uint8_t id_of(const Uuid& uuid);

 private:
  struct Holder {
    Uuid uuid{};
    std::uint64_t list = 0;  ///< that named it last; 0: free
  };
  std::uint64_t list_ = 0;
  std::array<Holder, 256> holders_;
};

/// TELE-041 At most 16 objects in frame "odom" (whom to name of more is the publisher's choice), boxes by centre and
/// size, stamped with vehicle time. Refused: a number that is none, a value the wire cannot carry, a box
/// without a size, no unit quaternion, an object named twice. Backwards slower than 1 m/s counts as standing.
/// \param tracks  written when taken only
[[nodiscard]] Refusal to_tracks(const autoware_perception_msgs_msg_dds__TrackedObjects_& message,
                                TrackIds& ids, wire::Tracks& tracks);

/// TELE-042 The same for the lane map: slots named once and in range, 2 .. 12 points a lane, conflicts of
/// lanes that are there and entered before they are left. \param map  written when taken only
[[nodiscard]] Refusal to_map(const LaneMapMessage& message, wire::Map& map);

}  // namespace s4tp::telemetry
