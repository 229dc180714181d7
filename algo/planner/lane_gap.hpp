#pragma once
/// Gaps between the vehicles of a lane beside: which one we can be in, and how soon. A driver who has to
/// change lanes looks for a gap early, and takes on its speed before signalling.

#include "algo/core/bounded.hpp"
#include "algo/core/config.hpp"
#include "algo/core/parameters.hpp"

namespace s4tp::planner {

/// A vehicle at the horizon's end, along a path; it keeps its speed before and after.
struct LaneVehicle {
  float s_m = 0.0F;  ///< of its box centre
  float length_m = 0.0F;
  float speed_mps = 0.0F;
  bool in_lane = false;  ///< of the path; else in the route's lane, which we have to change to
};
using LaneVehicles = BoundedVector<LaneVehicle, kMaxTracks>;

/// Places of our rear axle at the horizon's end, along the path, where a lane change to it keeps the
/// distances of change_gaps.hpp to the one in front and the one behind; they move on at `speed_mps`.
struct LaneGap {
  bool found = false;
  bool bounded_ahead = false;   ///< somebody is in front
  bool bounded_behind = false;  ///< somebody is behind
  float front_s_m = 0.0F;
  float rear_s_m = 0.0F;
  float speed_mps = 0.0F;
};

/// Us, along the path of the gap's lane.
struct GapSeeker {
  float s_m = 0.0F;  ///< of our rear axle, at plan start
  float speed_mps = 0.0F;
  float limit_mps = 0.0F;
  bool change_due = false;
  float end_s_m = 0.0F;     ///< then: where our front is at the end of the lane we are in
  bool has_leader = false;  ///< in the lane we are in
  float leader_s_m = 0.0F;  ///< where our rear axle would touch it, at plan start
  float leader_mps = 0.0F;
};

/// Foremost first. A vehicle faster than the one ahead by 0.5 m/s at most is in a column with it and comes no nearer
/// (GAP-004).
void put_in_order(LaneVehicles& vehicles);

/// Time [s] until we are in the gap at its speed, by comfortable drive and braking; occupancy::kNeverS: never.
/// \param ahead_s  when we are at `s_m`, before (positive) the horizon's end
[[nodiscard]] float time_to_meet_s(const LaneGap& gap, float ahead_s, float s_m, float speed_mps,
                                   float limit_mps, const Parameters& parameters);

/// Where we are when we are in it after `time_s`: at its nearer end, or where matching its speed takes us.
[[nodiscard]] float place_in_gap_m(const LaneGap& gap, float ahead_s, float s_m, float speed_mps,
                                   float time_s);

/// The gap behind `front` and ahead of `rear`; nullptr: nobody is there.
[[nodiscard]] LaneGap gap_between(const LaneVehicle* front, const LaneVehicle* rear, float limit_mps,
                                  const Parameters& parameters);

/// GAP-001 The foremost gap that takes a car of ours and can be met within 8 s, or 20 s when the change is
/// due, not by running into our own leader (GAP-002), and where we can still stop from its speed, or
/// change, before our lane ends (GAP-003). Not found: none, or the lane is free. \pre vehicles are in order
[[nodiscard]] LaneGap find_lane_gap(const LaneVehicles& vehicles, const GapSeeker& us,
                                    const Parameters& parameters);

}  // namespace s4tp::planner
