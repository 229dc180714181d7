#include "sim_host/telemetry/dds_input_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/map_record.hpp"

namespace s4tp::telemetry {
namespace {

constexpr double kUnitTolerance = 0.01;
constexpr double kRollingBackMps = 1.0;

template <class... Value>
bool all_finite(Value... value) {
  return (std::isfinite(value) && ...);
}

Refusal judge(const std_msgs_msg_dds__Header_& header) {
  if (header.frame_id == nullptr || std::strcmp(header.frame_id, "odom") != 0) return Refusal::kFrame;
  const bool time = header.stamp.sec >= 0 && header.stamp.nanosec < 1'000'000'000U;
  return time ? Refusal::kNone : Refusal::kStamp;
}

bool fits_the_wire(const wire::Track& track) {
  wire::Tracks one;
  one.count = 1;
  one.items[0] = track;
  wire::TrackListSender sender;
  sender.start(one);
  wire::Frame frame;
  wire::TrackList list;
  return sender.next(frame) && wire::decode(frame, list) && list.count == 1;
}

Refusal to_track(const autoware_perception_msgs_msg_dds__TrackedObject_& object, wire::Track& track) {
  const auto& pose = object.kinematics.pose_with_covariance.pose;
  const auto& twist = object.kinematics.twist_with_covariance.twist;
  const auto& turn = pose.orientation;
  const double speed_mps = twist.linear.x;
  const double acceleration_mps2 = object.kinematics.acceleration_with_covariance.accel.linear.x;
  const auto& size = object.shape.dimensions;
  if (!all_finite(pose.position.x, pose.position.y, turn.x, turn.y, turn.z, turn.w, speed_mps,
                  acceleration_mps2, twist.angular.z, size.x, size.y))
    return Refusal::kNotANumber;
  const double norm = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w;
  if (!(std::abs(norm - 1.0) < kUnitTolerance) || size.x <= 0.0 || size.y <= 0.0) return Refusal::kOutOfRange;
  const bool rolls_back = speed_mps < 0.0 && speed_mps > -kRollingBackMps;
  track.x_m = static_cast<float>(pose.position.x);
  track.y_m = static_cast<float>(pose.position.y);
  track.heading_rad = static_cast<float>(
      std::atan2(2.0 * (turn.w * turn.z + turn.x * turn.y), 1.0 - 2.0 * (turn.y * turn.y + turn.z * turn.z)));
  track.speed_mps = rolls_back ? 0.0F : static_cast<float>(speed_mps);
  track.acceleration_mps2 = static_cast<float>(acceleration_mps2);
  track.yaw_rate_radps = static_cast<float>(twist.angular.z);
  track.length_m = static_cast<float>(size.x);
  track.width_m = static_cast<float>(size.y);
  return fits_the_wire(track) ? Refusal::kNone : Refusal::kOutOfRange;
}

Refusal to_lane(const s4tp_msgs_msg_dds__Lane_& from, wire::Lane& lane) {
  if (from.points._length < 2 || from.points._length > wire::kMaxLanePoints) return Refusal::kTooMany;
  if (!all_finite(from.speed_limit_mps, from.width_m, from.stop_line_m, from.route_remaining_m,
                  from.goal_distance_m))
    return Refusal::kNotANumber;
  lane.present = true;
  lane.kind = from.kind;
  lane.in_junction = from.in_junction;
  lane.on_route = from.on_route;
  lane.changes_needed = from.changes_needed;
  lane.speed_limit_mps = from.speed_limit_mps;
  lane.width_m = from.width_m;
  lane.stop_line_m = from.stop_line_m;
  lane.route_remaining_m = from.route_remaining_m;
  lane.goal_distance_m = from.goal_distance_m;
  std::copy(std::begin(from.successors), std::end(from.successors), lane.successors);
  lane.left = from.left;
  lane.right = from.right;
  lane.point_count = static_cast<std::uint8_t>(from.points._length);
  for (std::uint32_t i = 0; i < from.points._length; ++i) {
    if (!all_finite(from.points._buffer[i].x, from.points._buffer[i].y)) return Refusal::kNotANumber;
    lane.x_m[i] = from.points._buffer[i].x;
    lane.y_m[i] = from.points._buffer[i].y;
  }
  wire::Frame frame;
  for (int part = 0; part < wire::part_count(lane); ++part) {
    if (!wire::encode_part(lane, from.slot, 0, part, frame)) return Refusal::kOutOfRange;
  }
  return Refusal::kNone;
}

Refusal to_conflict(const s4tp_msgs_msg_dds__Conflict_& from, const wire::LaneSet& lanes,
                    wire::Conflict& conflict) {
  if (!all_finite(from.first_entry_m, from.first_exit_m, from.second_entry_m, from.second_exit_m))
    return Refusal::kNotANumber;
  conflict = {true,
              from.first,
              from.second,
              from.priority,
              from.first_entry_m,
              from.first_exit_m,
              from.second_entry_m,
              from.second_exit_m};
  if (!wire::conflict_holds(conflict, lanes)) return Refusal::kOutOfRange;
  wire::Frame frame;
  for (int part = 0; part < wire::kConflictParts; ++part) {
    if (!wire::encode_part(conflict, from.slot, 0, part, frame)) return Refusal::kOutOfRange;
  }
  return Refusal::kNone;
}

}  // namespace

std::uint8_t TrackIds::id_of(const Uuid& uuid) {
  const auto known = std::find_if(holders_.begin(), holders_.end(), [&](const Holder& holder) {
    return holder.list != 0 && holder.uuid == uuid;
  });
  auto chosen = known;
  if (known == holders_.end()) {
    chosen = holders_.begin() + uuid[15];
    if (chosen->list != 0) {
      chosen = std::min_element(holders_.begin(), holders_.end(),
                                [](const Holder& a, const Holder& b) { return a.list < b.list; });
    }
  }
  *chosen = {uuid, list_};
  return static_cast<std::uint8_t>(chosen - holders_.begin());
}

Refusal to_tracks(const autoware_perception_msgs_msg_dds__TrackedObjects_& message, TrackIds& ids,
                  wire::Tracks& tracks) {
  if (const Refusal refusal = judge(message.header); refusal != Refusal::kNone) return refusal;
  if (message.objects._length > wire::kMaxTracks) return Refusal::kTooMany;
  wire::Tracks list;
  TrackIds::Uuid uuids[wire::kMaxTracks];
  list.count = static_cast<std::uint8_t>(message.objects._length);
  for (int i = 0; i < list.count; ++i) {
    const auto& object = message.objects._buffer[i];
    if (const Refusal refusal = to_track(object, list.items[i]); refusal != Refusal::kNone) return refusal;
    std::copy(std::begin(object.object_id.uuid), std::end(object.object_id.uuid), uuids[i].begin());
    if (std::find(uuids, uuids + i, uuids[i]) != uuids + i) return Refusal::kOutOfRange;
  }
  ids.next_list();
  for (int i = 0; i < list.count; ++i) list.items[i].id = ids.id_of(uuids[i]);
  const auto& stamp = message.header.stamp;
  const std::uint64_t time_ms = static_cast<std::uint64_t>(stamp.sec) * 1000U + stamp.nanosec / 1'000'000U;
  list.vehicle_time_ms = static_cast<std::uint16_t>(time_ms & 0xFFFFU);
  tracks = list;
  return Refusal::kNone;
}

Refusal to_map(const LaneMapMessage& message, wire::Map& map) {
  if (const Refusal refusal = judge(message.header); refusal != Refusal::kNone) return refusal;
  if (message.lanes._length > wire::kMaxLanes || message.conflicts._length > wire::kMaxConflicts)
    return Refusal::kTooMany;
  const auto fresh = std::make_unique<wire::Map>();
  fresh->lanes_left_out = message.lanes_left_out;
  wire::LaneSet lanes = {};
  for (std::uint32_t i = 0; i < message.lanes._length; ++i) {
    const auto& from = message.lanes._buffer[i];
    if (from.slot >= wire::kMaxLanes || fresh->lanes[from.slot].present) return Refusal::kOutOfRange;
    const Refusal refusal = to_lane(from, fresh->lanes[from.slot]);
    if (refusal != Refusal::kNone) return refusal;
    lanes[from.slot / 32] |= std::uint32_t{1} << (from.slot % 32);
  }
  for (std::uint32_t i = 0; i < message.conflicts._length; ++i) {
    const auto& from = message.conflicts._buffer[i];
    if (from.slot >= wire::kMaxConflicts || fresh->conflicts[from.slot].present) return Refusal::kOutOfRange;
    const Refusal refusal = to_conflict(from, lanes, fresh->conflicts[from.slot]);
    if (refusal != Refusal::kNone) return refusal;
  }
  map = *fresh;
  return Refusal::kNone;
}

}  // namespace s4tp::telemetry
