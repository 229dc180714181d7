#pragma once
/// Short ways to a scene in tests.

#include <vector>

#include "algo/scene/scene.hpp"

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
inline Scene scene_of(const LaneMap& map, const EgoState& ego, const std::vector<Track>& tracks,
                      const Parameters& parameters = {}, std::uint32_t time_ms = 1000) {
  Scene scene;
  SceneBuilder builder;
  (void)builder.build(time_ms, ego, track_list(tracks), time_ms, &map, parameters, scene);
  return scene;
}

/// The agent with that track id, or null.
inline const Agent* find_agent(const Scene& scene, int id) {
  for (const Agent& agent : scene.agents) {
    if (agent.track.id == id) return &agent;
  }
  return nullptr;
}

}  // namespace s4tp::test
