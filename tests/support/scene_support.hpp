#pragma once
/// Short ways to a scene in tests.

#include <algorithm>
#include <cmath>
#include <vector>

#include "algo/core/trajectory.hpp"
#include "algo/scene/scene_builder.hpp"

namespace s4tp::test {

inline EgoState ego_at(float x_m, float y_m, float heading_rad, float speed_mps) {
  EgoState ego;
  ego.rear_axle = {x_m, y_m, heading_rad};
  ego.speed_mps = speed_mps;
  return ego;
}

inline TrackList track_list(const std::vector<Track>& tracks) {
  TrackList list;
  for (const Track& track : tracks) (void)list.push(track);
  return list;
}

/// The scene of one instant: no past, tracks as fresh as the scene.
inline scene::Scene scene_of(const LaneMap& map, const EgoState& ego, const std::vector<Track>& tracks,
                             const Parameters& parameters = {}, std::uint32_t time_ms = 1000) {
  scene::Scene scene;
  scene::SceneBuilder builder;
  (void)builder.build(time_ms, ego, track_list(tracks), time_ms, &map, parameters, scene);
  return scene;
}

/// The agent with that track id, or null.
inline const scene::Agent* find_agent(const scene::Scene& scene, int id) {
  for (const scene::Agent& agent : scene.agents) {
    if (agent.track.id == id) return &agent;
  }
  return nullptr;
}

/// Our motion along our present heading: constant acceleration, and `left_m` sideways on a quintic within
/// `duration_s`.
inline Trajectory plan_of(const EgoState& ego, float acceleration_mps2 = 0.0F, float left_m = 0.0F,
                          float duration_s = 3.0F) {
  Trajectory plan;
  float along_m = 0.0F;
  float speed_mps = ego.speed_mps;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    const float u = std::min(kStepS * static_cast<float>(i) / duration_s, 1.0F);
    const float d_m = left_m * u * u * u * (10.0F - 15.0F * u + 6.0F * u * u);
    const float rate_mps = u < 1.0F ? left_m * 30.0F * u * u * (1.0F - u) * (1.0F - u) / duration_s : 0.0F;
    TrajectoryPoint& point = plan.points[i];
    point.rear_axle.x_m = ego.rear_axle.x_m + along_m * std::cos(ego.rear_axle.heading_rad) -
                          d_m * std::sin(ego.rear_axle.heading_rad);
    point.rear_axle.y_m = ego.rear_axle.y_m + along_m * std::sin(ego.rear_axle.heading_rad) +
                          d_m * std::cos(ego.rear_axle.heading_rad);
    point.rear_axle.heading_rad = ego.rear_axle.heading_rad + std::atan2(rate_mps, std::max(speed_mps, 1.0F));
    point.speed_mps = speed_mps;
    point.acceleration_mps2 = speed_mps > 0.0F || acceleration_mps2 > 0.0F ? acceleration_mps2 : 0.0F;
    const float next_mps = std::max(speed_mps + kStepS * acceleration_mps2, 0.0F);
    along_m += 0.5F * kStepS * (speed_mps + next_mps);
    speed_mps = next_mps;
  }
  return plan;
}

/// Speed of a predicted vehicle over the step before `step` [m/s].
template <typename ModeT>
float predicted_speed(const ModeT& mode, int step) {
  const Pose& a = mode.steps[step - 1];
  const Pose& b = mode.steps[step];
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) / kStepS;
}

}  // namespace s4tp::test
