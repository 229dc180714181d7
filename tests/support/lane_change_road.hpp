#pragma once
/// A straight road of two lanes, and our ways on it: to stay in the right one, or to change to the left one.

#include "tests/support/shared_ground.hpp"

namespace s4tp::test {

struct LaneChangeRoad {
  LaneMap map = straight_road(2, 400.0F);
  scene::Scene scene;
  Parameters parameters;

  LaneChangeRoad() {
    add_ego_path(scene, map, path_of(map, {0}));
    add_ego_path(scene, map, path_of(map, {1}), scene::Manoeuvre::kLeft);
  }
};

}  // namespace s4tp::test
