#pragma once
/// Maps for callers of the C facade.

#include <cstdint>

#include "algo/api/s4tp.h"
#include "algo/core/world_state.hpp"

namespace s4tp::test {

/// A lane map of the core's as a caller in C would write it.
inline s4tp_lane_map in_c(const LaneMap& from) {
  s4tp_lane_map to;
  static_cast<void>(s4tp_clear_map(&to));
  for (int i = 0; i < kMaxLanes; ++i) {
    const Lane& lane = from.lanes[i];
    s4tp_lane& c = to.lanes[i];
    if (!lane.present) continue;
    c.present = 1;
    c.kind = static_cast<std::uint8_t>(lane.kind);
    c.in_junction = lane.in_junction ? 1 : 0;
    c.on_route = lane.on_route ? 1 : 0;
    c.changes_needed = lane.changes_needed;
    c.left = lane.left;
    c.right = lane.right;
    for (int k = 0; k < kMaxSuccessors; ++k) c.successors[k] = lane.successors[k];
    c.point_count = lane.point_count;
    c.width_m = lane.width_m;
    c.speed_limit_mps = lane.speed_limit_mps;
    c.route_remaining_m = lane.route_remaining_m;
    c.goal_distance_m = lane.goal_distance_m;
    c.stop_line_m = lane.stop_line_m;
    for (int k = 0; k < lane.point_count; ++k) {
      c.x_m[k] = lane.points[k].x_m;
      c.y_m[k] = lane.points[k].y_m;
    }
  }
  for (const Conflict& conflict : from.conflicts) {
    to.conflicts[to.conflict_count++] = {
        conflict.first,         conflict.second,       static_cast<std::uint8_t>(conflict.priority),
        conflict.first_entry_m, conflict.first_exit_m, conflict.second_entry_m,
        conflict.second_exit_m};
  }
  return to;
}

}  // namespace s4tp::test
