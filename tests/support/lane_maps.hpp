#pragma once
/// Small hand-made lane maps for tests: straight roads, a curve, a cross junction with conflicts, a merge.
/// Traffic drives on the right; lanes are 3.2 m wide, the limit is 13.89 m/s unless said otherwise.

#include <cmath>
#include <initializer_list>
#include <vector>

#include "algo/core/geometry.hpp"
#include "algo/core/world_state.hpp"
#include "algo/scene/lane_path.hpp"

namespace s4tp::test {

inline constexpr float kLaneWidthM = 3.2F;
inline constexpr float kLimitMps = 13.89F;

/// Puts a lane into the next free slot; it is on the route, with the goal at its own end until linked.
inline LaneIndex add_lane(LaneMap& map, const std::vector<Point>& points) {
  for (int slot = 0; slot < kMaxLanes; ++slot) {
    Lane& lane = map.lanes[slot];
    if (lane.present) continue;
    lane = Lane{};
    lane.present = true;
    lane.on_route = true;
    lane.width_m = kLaneWidthM;
    lane.speed_limit_mps = kLimitMps;
    lane.point_count = static_cast<std::uint8_t>(points.size());
    float length_m = 0.0F;
    for (std::size_t i = 0; i < points.size(); ++i) {
      lane.points[i] = points[i];
      if (i > 0) length_m += std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
    }
    lane.length_m = lane.route_remaining_m = lane.goal_distance_m = length_m;
    return static_cast<LaneIndex>(slot);
  }
  return kNoLaneIndex;
}

/// `to` continues `from`; route distances of `from` grow by those of `to` when both are on the route.
inline void link(LaneMap& map, LaneIndex from, LaneIndex to) {
  Lane& lane = map.lanes[from];
  for (LaneIndex& successor : lane.successors) {
    if (successor != kNoLaneIndex) continue;
    successor = to;
    break;
  }
  if (lane.on_route && map.lanes[to].on_route) {
    lane.route_remaining_m = lane.length_m + map.lanes[to].route_remaining_m;
    lane.goal_distance_m = lane.length_m + map.lanes[to].goal_distance_m;
  }
}

/// `left` and `right` lie side by side, change allowed both ways.
inline void neighbours(LaneMap& map, LaneIndex right, LaneIndex left) {
  map.lanes[right].left = left;
  map.lanes[left].right = right;
}

/// Vertices of an arc from `start`, turning by `angle_rad` (left positive) on `radius_m`.
inline std::vector<Point> arc(const Pose& start, float radius_m, float angle_rad, int vertices) {
  std::vector<Point> points;
  const float side = angle_rad >= 0.0F ? 1.0F : -1.0F;
  const float centre_x = start.x_m - side * radius_m * std::sin(start.heading_rad);
  const float centre_y = start.y_m + side * radius_m * std::cos(start.heading_rad);
  for (int i = 0; i < vertices; ++i) {
    const float heading =
        start.heading_rad + angle_rad * static_cast<float>(i) / static_cast<float>(vertices - 1);
    points.push_back(
        {centre_x + side * radius_m * std::sin(heading), centre_y - side * radius_m * std::cos(heading)});
  }
  return points;
}

/// Centre of a lane at arc length `s_m`, by its chords: independent of the code under test.
inline Pose on_lane(const Lane& lane, float s_m) {
  for (int i = 0; i + 1 < lane.point_count; ++i) {
    const float dx = lane.points[i + 1].x_m - lane.points[i].x_m;
    const float dy = lane.points[i + 1].y_m - lane.points[i].y_m;
    const float length_m = std::hypot(dx, dy);
    if (s_m <= length_m || i + 2 == lane.point_count) {
      const float t = length_m > 0.0F ? s_m / length_m : 0.0F;
      return {lane.points[i].x_m + t * dx, lane.points[i].y_m + t * dy, std::atan2(dy, dx)};
    }
    s_m -= length_m;
  }
  return {};
}

/// Adds the conflict of two lanes, if boxes of 5.0 x 1.8 m on both can touch.
inline void add_conflict(LaneMap& map, LaneIndex first, LaneIndex second, Priority priority) {
  const Lane& a = map.lanes[first];
  const Lane& b = map.lanes[second];
  Conflict conflict{first, second, priority, 1e9F, -1.0F, 1e9F, -1.0F};
  for (float s = 0.0F; s <= a.length_m; s += 0.25F) {
    for (float u = 0.0F; u <= b.length_m; u += 0.25F) {
      if (!overlap({on_lane(a, s), 5.0F, 1.8F}, {on_lane(b, u), 5.0F, 1.8F}, 0.0F)) continue;
      conflict.first_entry_m = std::fmin(conflict.first_entry_m, s);
      conflict.first_exit_m = std::fmax(conflict.first_exit_m, s);
      conflict.second_entry_m = std::fmin(conflict.second_entry_m, u);
      conflict.second_exit_m = std::fmax(conflict.second_exit_m, u);
    }
  }
  if (conflict.first_exit_m >= 0.0F) (void)map.conflicts.push(conflict);
}

/// Parallel lanes along +x from (0, 0); lane 0 is the rightmost and lies on y = 0.
inline LaneMap straight_road(int lanes, float length_m, float limit_mps = kLimitMps) {
  LaneMap map;
  for (int i = 0; i < lanes; ++i) {
    const float y_m = kLaneWidthM * static_cast<float>(i);
    const LaneIndex lane = add_lane(map, {{0.0F, y_m}, {length_m, y_m}});
    map.lanes[lane].speed_limit_mps = limit_mps;
    if (i > 0) neighbours(map, static_cast<LaneIndex>(lane - 1), lane);
  }
  return map;
}

/// 50 m straight along +x, a left (angle > 0) or right curve, 50 m straight again: lanes 0, 1, 2.
inline LaneMap curved_road(float radius_m, float angle_rad) {
  LaneMap map;
  const LaneIndex before = add_lane(map, {{-50.0F, 0.0F}, {0.0F, 0.0F}});
  const LaneIndex curve = add_lane(map, arc({0.0F, 0.0F, 0.0F}, radius_m, angle_rad, kMaxLanePoints));
  const Point end = map.lanes[curve].points[kMaxLanePoints - 1];
  const LaneIndex after =
      add_lane(map, {end, {end.x_m + 50.0F * std::cos(angle_rad), end.y_m + 50.0F * std::sin(angle_rad)}});
  link(map, curve, after);
  link(map, before, curve);
  return map;
}

/// Cross junction, one lane each way, box of 16 x 16 m around (0, 0), arms of `arm_m`. The road along y has
/// priority; a left turn yields to who comes straight or right from the opposite arm.
/// Arms are named by direction of travel: `in[kEast]` is the lane that enters heading +x.
struct CrossJunction {
  enum Heading { kEast = 0, kNorth = 1, kWest = 2, kSouth = 3 };
  enum Turn { kLeft = 0, kStraight = 1, kRight = 2 };

  LaneMap map;
  LaneIndex in[4] = {};
  LaneIndex out[4] = {};
  LaneIndex connection[4][3] = {};  ///< [heading on entry][turn]
};

inline CrossJunction cross_junction(float arm_m = 60.0F) {
  constexpr float kBox = 8.0F;
  constexpr float kQuarter = 1.57079633F;
  CrossJunction cross;
  LaneMap& map = cross.map;
  const auto pose_at = [](int heading, float ahead_m) {
    const float angle = kQuarter * static_cast<float>(heading);
    const float right_m = 0.5F * kLaneWidthM;
    return Pose{ahead_m * std::cos(angle) + right_m * std::sin(angle),
                ahead_m * std::sin(angle) - right_m * std::cos(angle), angle};
  };
  const auto straight = [&](int heading, float from_m, float to_m) {
    const Pose a = pose_at(heading, from_m);
    const Pose b = pose_at(heading, to_m);
    return std::vector<Point>{{a.x_m, a.y_m}, {b.x_m, b.y_m}};
  };
  for (int h = 0; h < 4; ++h) {
    cross.in[h] = add_lane(map, straight(h, -arm_m, -kBox));
    cross.out[h] = add_lane(map, straight(h, kBox, arm_m));
    map.lanes[cross.in[h]].stop_line_m = map.lanes[cross.in[h]].length_m - 0.5F;
  }
  for (int h = 0; h < 4; ++h) {
    const Pose entry = pose_at(h, -kBox);
    const LaneIndex left = add_lane(map, arc(entry, kBox + 0.5F * kLaneWidthM, kQuarter, kMaxLanePoints));
    const LaneIndex ahead = add_lane(map, straight(h, -kBox, kBox));
    const LaneIndex right = add_lane(map, arc(entry, kBox - 0.5F * kLaneWidthM, -kQuarter, kMaxLanePoints));
    const LaneIndex turns[3] = {left, ahead, right};
    const int exits[3] = {(h + 1) % 4, h, (h + 3) % 4};
    for (int turn = 0; turn < 3; ++turn) {
      map.lanes[turns[turn]].in_junction = true;
      cross.connection[h][turn] = turns[turn];
      link(map, turns[turn], cross.out[exits[turn]]);
    }
    for (int turn : {CrossJunction::kStraight, CrossJunction::kLeft, CrossJunction::kRight}) {
      link(map, cross.in[h], turns[turn]);
    }
  }
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      for (int turn_a = 0; turn_a < 3; ++turn_a) {
        for (int turn_b = 0; turn_b < 3; ++turn_b) {
          Priority priority = a % 2 == 1 ? Priority::kFirstHasPriority : Priority::kFirstYields;
          if (b - a == 2) {
            const bool left_a = turn_a == CrossJunction::kLeft;
            const bool left_b = turn_b == CrossJunction::kLeft;
            priority = left_a == left_b ? Priority::kFirstCome
                       : left_a         ? Priority::kFirstYields
                                        : Priority::kFirstHasPriority;
          }
          add_conflict(map, cross.connection[a][turn_a], cross.connection[b][turn_b], priority);
        }
      }
    }
  }
  return cross;
}

/// Only what lies behind `turn` of the entry heading `h` is on the route to the end of the exit lane.
inline void set_route(CrossJunction& cross, int h, CrossJunction::Turn turn) {
  for (Lane& lane : cross.map.lanes) {
    lane.on_route = false;
    lane.route_remaining_m = lane.goal_distance_m = 0.0F;
  }
  const int exits[3] = {(h + 1) % 4, h, (h + 3) % 4};
  float behind_m = 0.0F;
  for (LaneIndex index : {cross.out[exits[turn]], cross.connection[h][turn], cross.in[h]}) {
    Lane& lane = cross.map.lanes[index];
    lane.on_route = true;
    behind_m += lane.length_m;
    lane.route_remaining_m = lane.goal_distance_m = behind_m;
  }
}

/// A ramp joins a two-lane road along +x and gives way: both it and the right lane end in the same lane.
/// \code
///   main_left  ------------------------------> after_left
///   main_right --------------> main_joint ---> after_right
///         ramp_ --------> ramp_joint --'
/// \endcode
struct Merge {
  LaneMap map;
  LaneIndex ramp = kNoLaneIndex;
  LaneIndex ramp_joint = kNoLaneIndex;  ///< in the junction, yields
  LaneIndex main_right = kNoLaneIndex;
  LaneIndex main_joint = kNoLaneIndex;
  LaneIndex main_left = kNoLaneIndex;
  LaneIndex left_joint = kNoLaneIndex;
  LaneIndex after_right = kNoLaneIndex;
  LaneIndex after_left = kNoLaneIndex;
};

inline Merge merge_road() {
  Merge merge;
  LaneMap& map = merge.map;
  constexpr float kLeftY = kLaneWidthM;
  merge.ramp = add_lane(map, {{-80.0F, -14.0F}, {-20.0F, -3.5F}});
  merge.ramp_joint =
      add_lane(map, {{-20.0F, -3.5F}, {-13.0F, -2.25F}, {-6.0F, -1.0F}, {0.0F, -0.2F}, {6.0F, 0.0F}});
  merge.main_right = add_lane(map, {{-120.0F, 0.0F}, {-20.0F, 0.0F}});
  merge.main_joint = add_lane(map, {{-20.0F, 0.0F}, {6.0F, 0.0F}});
  merge.main_left = add_lane(map, {{-120.0F, kLeftY}, {-20.0F, kLeftY}});
  merge.left_joint = add_lane(map, {{-20.0F, kLeftY}, {6.0F, kLeftY}});
  merge.after_right = add_lane(map, {{6.0F, 0.0F}, {150.0F, 0.0F}});
  merge.after_left = add_lane(map, {{6.0F, kLeftY}, {150.0F, kLeftY}});
  for (LaneIndex joint : {merge.ramp_joint, merge.main_joint, merge.left_joint})
    map.lanes[joint].in_junction = true;
  link(map, merge.ramp_joint, merge.after_right);
  link(map, merge.main_joint, merge.after_right);
  link(map, merge.left_joint, merge.after_left);
  link(map, merge.ramp, merge.ramp_joint);
  link(map, merge.main_right, merge.main_joint);
  link(map, merge.main_left, merge.left_joint);
  neighbours(map, merge.main_right, merge.main_left);
  neighbours(map, merge.after_right, merge.after_left);
  map.lanes[merge.ramp].stop_line_m = map.lanes[merge.ramp].length_m - 0.5F;
  add_conflict(map, merge.ramp_joint, merge.main_joint, Priority::kFirstYields);
  return merge;
}

/// A path along the given lanes.
inline scene::LanePath path_along(const LaneMap& map, std::initializer_list<LaneIndex> lanes) {
  scene::LanePath path;
  for (LaneIndex lane : lanes) {
    (void)path.lanes.push({lane, path.length_m});
    path.length_m += map.lanes[lane].length_m;
  }
  return path;
}

/// A car of 5.0 x 1.8 m.
inline Track car(int id, float x_m, float y_m, float heading_rad, float speed_mps) {
  Track track;
  track.id = static_cast<std::uint8_t>(id);
  track.centre = {x_m, y_m, heading_rad};
  track.speed_mps = speed_mps;
  track.length_m = 5.0F;
  track.width_m = 1.8F;
  return track;
}

}  // namespace s4tp::test
