#include "firmware/ecu/map_conversion.hpp"

namespace s4tp::ecu {
namespace {

static_assert(wire::kMaxLanes == kMaxLanes && wire::kMaxLanePoints == kMaxLanePoints &&
              wire::kMaxConflicts == kMaxConflicts);

void convert(const wire::Lane& from, Lane& to) {
  to = Lane{};
  if (!from.present || from.point_count < 2 || from.point_count > kMaxLanePoints) return;
  to.point_count = from.point_count;
  for (int i = 0; i < from.point_count; ++i) {
    to.points[i] = {from.x_m[i], from.y_m[i]};
    if (i > 0) to.length_m += distance(to.points[i - 1], to.points[i]);
  }
  to.present = to.length_m > 0.0F;
  to.kind = from.kind == 1 ? LaneKind::kOpposite : from.kind == 2 ? LaneKind::kShoulder : LaneKind::kOurs;
  to.in_junction = from.in_junction;
  to.changes_needed = from.changes_needed;
  to.on_route = from.on_route;
  to.width_m = from.width_m;
  to.speed_limit_mps = from.speed_limit_mps;
  to.route_remaining_m = from.route_remaining_m;
  to.goal_distance_m = from.goal_distance_m;
  to.stop_line_m = from.stop_line_m;
}

LaneIndex existing(std::uint8_t slot, const LaneMap& map) {
  return slot < kMaxLanes && map.lanes[slot].present ? static_cast<LaneIndex>(slot) : kNoLaneIndex;
}

Priority priority_of(std::uint8_t code) {
  if (code == 0) return Priority::kFirstYields;
  return code == 1 ? Priority::kFirstHasPriority : Priority::kFirstCome;
}

}  // namespace

void convert(const wire::Map& from, LaneMap& to) {
  for (int i = 0; i < kMaxLanes; ++i) convert(from.lanes[i], to.lanes[i]);
  for (int i = 0; i < kMaxLanes; ++i) {
    Lane& lane = to.lanes[i];
    if (!lane.present) continue;
    for (int k = 0; k < kMaxSuccessors; ++k) lane.successors[k] = existing(from.lanes[i].successors[k], to);
    lane.left = existing(from.lanes[i].left, to);
    lane.right = existing(from.lanes[i].right, to);
  }
  to.conflicts.clear();
  for (const wire::Conflict& record : from.conflicts) {
    if (!record.present) continue;
    Conflict conflict;
    conflict.first = existing(record.first, to);
    conflict.second = existing(record.second, to);
    conflict.priority = priority_of(record.priority);
    conflict.first_entry_m = record.first_entry_m;
    conflict.first_exit_m = record.first_exit_m;
    conflict.second_entry_m = record.second_entry_m;
    conflict.second_exit_m = record.second_exit_m;
    if (conflict.first == kNoLaneIndex || conflict.second == kNoLaneIndex) continue;
    static_cast<void>(to.conflicts.push(conflict));  // as many slots as the wire has
  }
  to.lanes_left_out = from.lanes_left_out;
}

}  // namespace s4tp::ecu
