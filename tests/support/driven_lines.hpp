#pragma once
/// The lines of a scene's paths as candidates take them, at the lateral offsets that the paths have.

#include "algo/trajectory/reference_line.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::test {

inline void build_lines_of(const scene::Scene& scene, const TrajectoryPoint& start,
                           const Parameters& parameters, trajectory::ReferenceLines& lines) {
  for (int i = 0; i < scene.ego_paths.size(); ++i) {
    const scene::EgoPath& path = scene.ego_paths[i];
    int work = 0;
    const scene::Frenet at =
        scene::project(*scene.map, path.path, position(start.rear_axle), path.frenet.s_m, 10.0F, work);
    trajectory::build_reference(*scene.map, path.path, at.s_m, start.speed_mps, parameters, lines[i]);
    lines[i].lateral_offset_m = path.lateral_offset_m;
  }
}

}  // namespace s4tp::test
