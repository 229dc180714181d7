#include "firmware/ecu/gate_limits.hpp"

namespace s4tp::ecu {
namespace {

constexpr float kHarderMps2 = 1.0F;       // braking beyond a plan's: all the tyres give on a dry road
constexpr float kFasterRadps = 0.1F;      // steering faster than a plan: corrections come on top
constexpr float kMoreLateralMps2 = 1.5F;  // the same across

}  // namespace

gate::Limits gate_limits(const Parameters& parameters) {
  gate::Limits limits;
  limits.acceleration_max_mps2 = parameters.vehicle.acceleration_max_mps2;
  limits.braking_max_mps2 = parameters.vehicle.braking_max_mps2 + kHarderMps2;
  limits.steering_max_rad = parameters.vehicle.steering_max_rad;
  limits.steering_rate_max_radps = parameters.vehicle.steering_rate_max_radps + kFasterRadps;
  limits.lateral_acceleration_max_mps2 = parameters.comfort.lateral_max_mps2 + kMoreLateralMps2;
  limits.wheelbase_m = parameters.vehicle.wheelbase_m;
  return limits;
}

}  // namespace s4tp::ecu
