#pragma once
/// One way a vehicle may go, as the predictor reads it from the scene: what it drives towards, whom it
/// follows, whom it lets pass, and where our paths may cross. Times count from plan start, arc lengths along
/// its path.

#include "algo/core/bounded.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::satp {

/// A zone this vehicle shares with a lane that is on one of our paths.
struct PathConflict {
  LaneIndex our_lane = kNoLaneIndex;
  Priority priority = Priority::kFirstCome;  ///< seen from the vehicle: kFirstYields = it yields to us
  float entry_s_m = 0.0F;                    ///< of its box centre
  float exit_s_m = 0.0F;
  float our_entry_m = 0.0F;  ///< on our lane
  float our_exit_m = 0.0F;
};

inline constexpr int kMaxPathConflicts = 4;

struct PathHypothesis {
  float start_s_m = 0.0F;  ///< of the vehicle's centre at plan start
  float speed_mps = 0.0F;
  float desired_mps = 0.0F;
  /// The stretch ahead that forces it to slow down most: a turn, or a lower limit.
  float slow_from_s_m = 0.0F;
  float slow_to_s_m = 0.0F;
  float slow_mps = 0.0F;
  float after_mps = 0.0F;  ///< desired beyond it
  /// The vehicle in front.
  bool follows = false;
  float leader_rear_s_m = 0.0F;  ///< of its rear bumper at plan start
  float leader_mps = 0.0F;
  float headway_s = 0.0F;  ///< it keeps the headway it has, if that is shorter than usual
  /// Where its centre waits for others to pass, and until when; until <= 0: nowhere.
  float hold_s_m = 0.0F;
  float hold_until_s = 0.0F;
  BoundedVector<PathConflict, kMaxPathConflicts> conflicts;  ///< nearest first
};

/// Reads path `path` of agent `index`. \pre scene.map is there and the agent has that path
[[nodiscard]] PathHypothesis read_path_hypothesis(const scene::Scene& scene, int index, int path,
                                                  float lead_s);

}  // namespace s4tp::satp
