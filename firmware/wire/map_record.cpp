#include "firmware/wire/map_record.hpp"

#include "firmware/wire/codec.hpp"

namespace s4tp::wire {
namespace {

/// For messages that name a lane slot and its revision.
template <typename Message>
Message of_lane(int slot, std::uint8_t revision) {
  Message message;
  message.lane = static_cast<std::uint8_t>(slot);
  message.revision = revision;
  return message;
}

bool encode_header(const Lane& lane, int slot, std::uint8_t revision, Frame& frame) {
  auto header = of_lane<LaneHeader>(slot, revision);
  header.kind = lane.kind;
  header.in_junction = lane.in_junction ? 1 : 0;
  header.on_route = lane.on_route ? 1 : 0;
  header.point_count = lane.point_count;
  header.changes_needed = lane.changes_needed;
  header.speed_limit_mps = lane.speed_limit_mps;
  header.width_m = lane.width_m;
  const bool no_stop_line = lane.stop_line_m < 0.0F;
  header.has_stop_line = no_stop_line ? 0 : 1;
  header.stop_line_m = no_stop_line ? 0.0F : lane.stop_line_m;
  header.signal_state = lane.signal_state;
  return encode(header, frame);
}

bool encode_route(const Lane& lane, int slot, std::uint8_t revision, Frame& frame) {
  auto route = of_lane<LaneRoute>(slot, revision);
  route.route_remaining_m = lane.route_remaining_m;
  route.goal_distance_m = lane.goal_distance_m;
  return encode(route, frame);
}

bool encode_links(const Lane& lane, int slot, std::uint8_t revision, Frame& frame) {
  auto links = of_lane<LaneLinks>(slot, revision);
  links.successor_0 = lane.successors[0];
  links.successor_1 = lane.successors[1];
  links.successor_2 = lane.successors[2];
  links.left = lane.left;
  links.right = lane.right;
  return encode(links, frame);
}

bool encode_point(const Lane& lane, int slot, std::uint8_t revision, int index, Frame& frame) {
  auto point = of_lane<LanePoint>(slot, revision);
  point.index = static_cast<std::uint8_t>(index);
  point.x_m = lane.x_m[index];
  point.y_m = lane.y_m[index];
  return encode(point, frame);
}

bool encode_first(const Conflict& conflict, int slot, std::uint8_t revision, Frame& frame) {
  ConflictFirst first;
  first.conflict = static_cast<std::uint8_t>(slot);
  first.revision = revision;
  if (conflict.present) {
    first.first = conflict.first;
    first.second = conflict.second;
    first.priority = conflict.priority;
    first.first_entry_m = conflict.first_entry_m;
    first.first_exit_m = conflict.first_exit_m;
  }
  return encode(first, frame);
}

bool encode_second(const Conflict& conflict, int slot, std::uint8_t revision, Frame& frame) {
  ConflictSecond second;
  second.conflict = static_cast<std::uint8_t>(slot);
  second.revision = revision;
  if (conflict.present) {
    second.second_entry_m = conflict.second_entry_m;
    second.second_exit_m = conflict.second_exit_m;
  }
  return encode(second, frame);
}

bool exists_or_none(std::uint8_t link, const LaneSet& lanes) {
  return link == kNoLane || contains(lanes, link);
}

}  // namespace

bool contains(const LaneSet& lanes, int lane) {
  return lane >= 0 && lane < kMaxLanes && ((lanes[lane / 32] >> (lane % 32)) & 1U) != 0U;
}

int part_count(const Lane& lane) {
  return kFirstPointPart + lane.point_count;
}
int part_count(const Conflict&) {
  return kConflictParts;
}

bool encode_part(const Lane& lane, int slot, std::uint8_t revision, int part, Frame& frame) {
  bool encoded = false;
  switch (part) {
    case kLaneHeaderPart:
      encoded = encode_header(lane, slot, revision, frame);
      break;
    case kLaneRoutePart:
      encoded = encode_route(lane, slot, revision, frame);
      break;
    case kLaneLinksPart:
      encoded = encode_links(lane, slot, revision, frame);
      break;
    default:
      encoded = encode_point(lane, slot, revision, part - kFirstPointPart, frame);
      break;
  }
  if (encoded) e2e_seal(frame);
  return encoded;
}

bool encode_part(const Conflict& conflict, int slot, std::uint8_t revision, int part, Frame& frame) {
  const bool encoded = part == 0 ? encode_first(conflict, slot, revision, frame)
                                 : encode_second(conflict, slot, revision, frame);
  if (encoded) e2e_seal(frame);
  return encoded;
}

bool links_exist(const Lane& lane, const LaneSet& lanes) {
  for (const std::uint8_t successor : lane.successors) {
    if (!exists_or_none(successor, lanes)) return false;
  }
  return exists_or_none(lane.left, lanes) && exists_or_none(lane.right, lanes);
}

bool conflict_holds(const Conflict& conflict, const LaneSet& lanes) {
  return conflict.first != conflict.second && contains(lanes, conflict.first) &&
         contains(lanes, conflict.second) && conflict.first_entry_m <= conflict.first_exit_m &&
         conflict.second_entry_m <= conflict.second_exit_m;
}

}  // namespace s4tp::wire
