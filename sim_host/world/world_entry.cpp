#include "sim_host/world/world_entry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim_host/world/engine_factory.hpp"
#include "sim_host/world/nodes/vehicle.hpp"
#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/traffic/start_zone.hpp"

namespace s4tp::world {
namespace {

using traffic::CarState;

constexpr double kUndisturbed_s = 1.0;  // after entry: a touch within it is the draw's fault
constexpr int kRedrawsMax = 100;

std::unique_ptr<traffic::TrafficEngine> traffic_until(const scenario::Scenario& scenario,
                                                      const WorldOptions& options, std::uint64_t seed,
                                                      double traffic_time_s, traffic::DrivenBy driven_by) {
  std::unique_ptr<traffic::TrafficEngine> fresh =
      make_engine(scenario, {options.engine, seed, options.seed, driven_by});
  const long ticks = std::lround(traffic_time_s / traffic::kTick_s);
  for (long i = 0; i < ticks; ++i) {
    fresh->step(nullptr);
  }
  return fresh;
}

/// Nothing of it depends on the ego, so it is driven before it is shown: who is taken out of the start zone
/// at entry has never been there, or the ECU would still believe in it.
std::vector<std::vector<CarState>> run_pre_roll(const scenario::Scenario& scenario, double pre_roll_s,
                                                traffic::TrafficEngine& traffic) {
  std::vector<std::vector<CarState>> pre_roll;
  const int entry_tick = static_cast<int>(std::lround(pre_roll_s / traffic::kTick_s));
  for (int tick = 1; tick <= entry_tick; ++tick) {
    if (scenario.mission.entry_time_s + (tick - entry_tick) * traffic::kTick_s > 0.5 * traffic::kTick_s) {
      traffic.step(nullptr);
    }
    pre_roll.push_back(traffic.cars());
  }
  const std::vector<CarState> before = traffic.cars();
  traffic::free_start_zone(scenario, nodes::VehicleParameters{}.length_m, traffic);
  const std::vector<CarState> after = traffic.cars();
  const auto among = [](const std::vector<CarState>& cars, int id) {
    return std::any_of(cars.begin(), cars.end(), [&](const CarState& car) { return car.id == id; });
  };
  for (std::vector<CarState>& shown : pre_roll) {
    std::erase_if(shown, [&](const CarState& car) { return among(before, car.id) && !among(after, car.id); });
  }
  return pre_roll;
}

bool touched_at_entry(const scenario::Scenario& scenario, const WorldOptions& options,
                      const traffic::Locator& locator, std::uint64_t seed) {
  const std::unique_ptr<traffic::TrafficEngine> trial =
      traffic_until(scenario, options, seed, scenario.mission.entry_time_s, traffic::DrivenBy::kUs);
  traffic::free_start_zone(scenario, nodes::VehicleParameters{}.length_m, *trial);
  const int ticks = static_cast<int>(std::lround(kUndisturbed_s / traffic::kTick_s));
  map::LaneId before = scenario.mission.start_lane;
  for (int i = 0; i <= ticks; ++i) {
    const CarState self = ego_at_entry(scenario, i * traffic::kTick_s);
    if (i > 0) {
      const traffic::LanePlace at = locator.locate(self.centre, self.heading_rad, before);
      before = at.lane;
      const traffic::EgoSeen seen{self, locator.actor(self, at)};
      trial->step(&seen);
    }
    for (const CarState& car : trial->cars()) {
      if (traffic::overlap(traffic::box_of(self), traffic::box_of(car))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

CarState ego_at_entry(const scenario::Scenario& scenario, double time_s) {
  const scenario::Mission& mission = scenario.mission;
  const map::PolylinePose pose =
      scenario.network.lanes[static_cast<std::size_t>(mission.start_lane)].centre.at(
          mission.start_s_m + mission.start_speed_mps * time_s);
  CarState state;
  state.centre = pose.point;
  state.heading_rad = pose.heading_rad;
  state.speed_mps = mission.start_speed_mps;
  state.length_m = nodes::VehicleParameters{}.length_m;
  state.width_m = nodes::VehicleParameters{}.width_m;
  state.lane = mission.start_lane;
  return state;
}

EnteredTraffic draw_entry(const scenario::Scenario& scenario, const WorldOptions& options,
                          const traffic::Locator& locator) {
  EnteredTraffic entered;
  std::uint64_t seed = options.seed;
  while (entered.redrawn < kRedrawsMax && touched_at_entry(scenario, options, locator, seed)) {
    seed = traffic::next_seed(seed);
    ++entered.redrawn;
  }
  entered.traffic =
      traffic_until(scenario, options, seed, scenario.mission.entry_time_s - options.pre_roll_s,
                    options.ego_by_traffic ? traffic::DrivenBy::kEngine : traffic::DrivenBy::kUs);
  entered.pre_roll = run_pre_roll(scenario, options.pre_roll_s, *entered.traffic);
  return entered;
}

}  // namespace s4tp::world
