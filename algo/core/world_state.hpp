#pragma once
/// What the planner is told about the world at one instant: the input side of the core. Ranges are as
/// input_ranges.hpp has them.
/// Positions are in the local odometry frame; the reference point is named per type.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/core/config.hpp"
#include "algo/core/geometry.hpp"

namespace s4tp {

/// Our own car at one instant; the reference point is the rear axle.
struct EgoState {
  Pose rear_axle;
  float speed_mps = 0.0F;          ///< 0 .. 60; forward only
  float acceleration_mps2 = 0.0F;  ///< -12 .. 12
  float yaw_rate_radps = 0.0F;     ///< -2 .. 2
  float steering_rad = 0.0F;       ///< road-wheel angle, left positive; -0.8 .. 0.8
};

/// Another vehicle at the list's time; the reference point is the centre of its box.
struct Track {
  std::uint8_t id = 0;  ///< stable while the vehicle is tracked
  Pose centre;
  float speed_mps = 0.0F;          ///< 0 .. 60, along the heading
  float acceleration_mps2 = 0.0F;  ///< -12 .. 12
  float yaw_rate_radps = 0.0F;     ///< -1.3 .. 1.3
  float length_m = 0.0F;           ///< 0.5 .. 25
  float width_m = 0.0F;            ///< 0.3 .. 3
};

/// A list that does not hold all vehicles names those who can be near us soonest, by distance less the way of so long at
/// the difference of their velocity and ours: a column that stands around us hides nobody who comes fast, and one that
/// drives along with us nobody who stands ahead.
inline constexpr float kListLeadS = 2.0F;

/// The vehicles of one list.
struct TrackList : BoundedVector<Track, kMaxTracks> {
  std::uint8_t left_out = 0;  ///< how many more there are, none that comes before any of these
};

using LaneIndex = std::int8_t;
inline constexpr LaneIndex kNoLaneIndex = -1;

enum class LaneKind : std::uint8_t { kOurs = 0, kOpposite = 1, kShoulder = 2 };

/// One lane: a centre line and what the map node says of it. Index 0 of `points` is the start.
struct Lane {
  bool present = false;
  LaneKind kind = LaneKind::kOurs;
  bool in_junction = false;  ///< connects lanes across a junction
  LaneIndex successors[kMaxSuccessors] = {kNoLaneIndex, kNoLaneIndex, kNoLaneIndex};
  LaneIndex left = kNoLaneIndex;  ///< neighbour of the same direction, change allowed
  LaneIndex right = kNoLaneIndex;
  std::int8_t changes_needed = 0;  ///< lane changes to the route's lane: > 0 to the left
  bool on_route = false;           ///< leads to the goal, if need be after `changes_needed`
  std::uint8_t point_count = 0;
  float width_m = 3.2F;
  float speed_limit_mps = 13.89F;
  float length_m = 0.0F;  ///< of the centre line
  float route_remaining_m =
      0.0F;  ///< from the lane's start, how far the route can be followed without a change
  float goal_distance_m = 0.0F;  ///< from the lane's start along the route to the goal
  float stop_line_m = -1.0F;     ///< arc length to stop at; < 0: none
  Point points[kMaxLanePoints];
};

enum class Priority : std::uint8_t { kFirstYields = 0, kFirstHasPriority = 1, kFirstCome = 2 };

/// Two lanes share ground. Arc lengths are from each lane's start, of the centre of a car's box: inside
/// (entry, exit) a box of usual width on the one lane may touch one on the other.
struct Conflict {
  LaneIndex first = kNoLaneIndex;
  LaneIndex second = kNoLaneIndex;
  Priority priority = Priority::kFirstCome;
  float first_entry_m = 0.0F;
  float first_exit_m = 0.0F;
  float second_entry_m = 0.0F;
  float second_exit_m = 0.0F;
};

/// The lanes within the horizon (about 150 m); slots keep their index while a lane stays within it.
struct LaneMap {
  Lane lanes[kMaxLanes];
  BoundedVector<Conflict, kMaxConflicts> conflicts;
  std::uint8_t lanes_left_out = 0;  ///< how many more the map node had no slot for
};

}  // namespace s4tp
