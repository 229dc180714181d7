#pragma once
/// What lies along one of our paths: who leads, who follows, where the road ends. Geometry of the present
/// only.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::trajectory {

/// Room on both sides of our width that a vehicle may not reach into.
inline constexpr float kStripM = 0.2F;

/// A vehicle seen along one of our paths.
struct OnPath {
  bool overlaps = false;    ///< its box reaches into the strip a car of our width needs; standing across
                            ///< or against us: our box would come within kStripM of it; standing in a lane
                            ///< that is none of the path's: our box would touch it
  float centre_s_m = 0.0F;  ///< of its box centre
  float centre_d_m = 0.0F;
  float half_length_m = 0.0F;  ///< of its box along the path, whatever its heading
  float half_width_m = 0.0F;
  float left_mps = 0.0F;   ///< speed across the path
  float along_mps = 0.0F;  ///< speed along the path; negative: towards us
  /// Moving, more than 45 degrees off the path's direction or against it. CAND-028 Not so who turns off where the path's lanes
  /// fork: it was ahead of us, and no zone tells of it.
  bool crossing = false;
  int work = 0;  ///< what seeing it took [WorkMeter's units]
};

/// Where `lane` begins along the way. \return false: the way does not lead along it
[[nodiscard]] bool lane_start(const scene::LanePath& way, LaneIndex lane, float& start_s_m);

/// \param whole_road  also vehicles that are plainly in another lane
/// \param known  receives false for a vehicle far off, or safely in a lane that is none of the path's
[[nodiscard]] OnPath see_on_path(const scene::Scene& scene, const scene::EgoPath& path,
                                 const scene::Agent& agent, const Parameters& parameters, bool whole_road,
                                 bool& known);

/// Whether the vehicle is coming into a lane of the path from the lane beside it.
[[nodiscard]] bool joins(const scene::Scene& scene, const scene::EgoPath& path, const scene::Agent& agent);

/// The nearest vehicle ahead of us in the strip; crossing ones are the business of conflict zones.
struct Leader {
  int agent = -1;          ///< index into Scene::agents; -1: the way is free
  float gap_m = 0.0F;      ///< bumper to bumper at the scene's time; may be negative
  float speed_mps = 0.0F;  ///< along the path, >= 0
  float acceleration_mps2 = 0.0F;
  int work = 0;  ///< what finding it took [WorkMeter's units]
};

/// \param rear_axle_s_m  ours, along `path`, at the scene's time
[[nodiscard]] Leader find_leader(const scene::Scene& scene, const scene::EgoPath& path, float rear_axle_s_m,
                                 const Parameters& parameters);

/// The nearest vehicle behind us in the strip, moving along; gap_m from its front to our rear bumper.
[[nodiscard]] Leader find_follower(const scene::Scene& scene, const scene::EgoPath& path, float rear_axle_s_m,
                                   const Parameters& parameters);

/// Arc length where `path` ends for good, or kNoDeadEndM: not where only our knowledge ends, nor at the goal.
inline constexpr float kNoDeadEndM = 1e6F;
[[nodiscard]] float dead_end_s_m(const scene::Scene& scene, const scene::EgoPath& path);
/// Room before such an end in which the lane changes still due can be made, even from rest.
[[nodiscard]] float change_room_m(const scene::Scene& scene, const scene::EgoPath& path);

}  // namespace s4tp::trajectory
