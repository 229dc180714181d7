#include "sim_host/world/ego_road.hpp"

namespace s4tp::world {

traffic::CarState ego_state(const nodes::Vehicle& vehicle, const traffic::LanePlace& place) {
  traffic::CarState state;
  state.centre = vehicle.box_centre();
  state.heading_rad = vehicle.heading_rad();
  state.speed_mps = vehicle.speed_mps();
  state.acceleration_mps2 = vehicle.acceleration_mps2();
  state.yaw_rate_radps = vehicle.yaw_rate_radps();
  state.length_m = vehicle.parameters().length_m;
  state.width_m = vehicle.parameters().width_m;
  state.lane = place.inside ? place.lane : map::kNoLane;
  return state;
}

}  // namespace s4tp::world
