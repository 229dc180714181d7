#pragma once
/// The maps that the facade's fuzz target plans on, and what becomes of them.

#include <array>
#include <cstdint>

#include "algo/api/s4tp.h"
#include "tests/fuzz/input.hpp"
#include "tests/support/c_map.hpp"
#include "tests/support/lane_maps.hpp"

namespace s4tp::fuzz {

inline const s4tp_lane_map& base_map(int which) {
  static const auto maps = [] {
    test::CrossJunction left = test::cross_junction();
    test::set_route(left, test::CrossJunction::kEast, test::CrossJunction::kLeft);
    test::CrossJunction straight = test::cross_junction();
    test::set_route(straight, test::CrossJunction::kEast, test::CrossJunction::kStraight);
    return std::array{test::in_c(left.map), test::in_c(test::straight_road(2, 300.0F)),
                      test::in_c(test::curved_road(20.0F, 1.2F)), test::in_c(straight.map)};
  }();
  return maps[static_cast<std::size_t>(which) % maps.size()];
}

/// One number of a map becomes another, as documented or not.
inline void wound(Input& input, s4tp_lane_map& map) {
  s4tp_lane& lane = map.lanes[input.below(20)];
  const float any = input.below(4) == 0 ? input.take<float>() : input.real(-50.0F, 150.0F);
  const int point = input.below(S4TP_MAX_LANE_POINTS);
  s4tp_conflict& conflict = map.conflicts[input.below(S4TP_MAX_CONFLICTS)];
  switch (input.below(16)) {
    case 0:
      lane.x_m[point] = any;
      break;
    case 1:
      lane.y_m[point] = any;
      break;
    case 2:
      lane.width_m = any;
      break;
    case 3:
      lane.speed_limit_mps = any;
      break;
    case 4:
      lane.route_remaining_m = any;
      break;
    case 5:
      lane.goal_distance_m = any;
      break;
    case 6:
      lane.stop_line_m = any;
      break;
    case 7:
      lane.point_count = input.byte();
      break;
    case 8:
      lane.kind = input.byte() % 4;
      break;
    case 9:
      lane.left = static_cast<std::int8_t>(input.byte() % 24 - 2);
      break;
    case 10:
      lane.successors[input.below(3)] = static_cast<std::int8_t>(input.byte() % 24 - 2);
      break;
    case 11:
      lane.present = input.byte() % 2;
      break;
    case 12:
      lane.changes_needed = static_cast<std::int8_t>(input.byte());
      break;
    case 13:
      map.conflict_count = input.below(4) == 3 ? input.take<std::int32_t>() : input.below(S4TP_MAX_CONFLICTS);
      break;
    case 14:
      input.copy(&conflict.first, 3);
      conflict.first_entry_m = any;
      break;
    default:
      conflict.first_exit_m = any;
      conflict.second_exit_m = input.real(-50.0F, 150.0F);
  }
}

}  // namespace s4tp::fuzz
