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
      make_engine(scenario, {options.engine, seed, options.seed, driven_by, options.ego_on_any_lane});
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

/// Where a car's rear axle goes, and how it points there.
struct RearAxle {
  map::Vec2 point;
  double heading_rad;
};

/// Along the line's mean over kSmooth_m to either side: at a vertex nobody turns at once, and where this leads is where the
/// car points.
RearAxle rear_axle_along(const map::Polyline& line, double s_m) {
  constexpr double kSmooth_m = 4.0;
  constexpr int kSamples = 33;
  RearAxle axle{};
  for (int i = 0; i < kSamples; ++i) {
    const map::Vec2 point = line.at(s_m + kSmooth_m * (2.0 * i / (kSamples - 1) - 1.0)).point;
    const double weight = i == 0 || i == kSamples - 1 ? 0.5 : 1.0;
    axle.point.x += weight * point.x / (kSamples - 1);
    axle.point.y += weight * point.y / (kSamples - 1);
  }
  const map::Vec2 rear = line.at(s_m - kSmooth_m).point;
  const map::Vec2 front = line.at(s_m + kSmooth_m).point;
  axle.heading_rad = std::atan2(front.y - rear.y, front.x - rear.x);
  return axle;
}

}  // namespace

CarState ego_at_entry(const scenario::Scenario& scenario, double time_s) {
  const scenario::Mission& mission = scenario.mission;
  const map::Polyline& line = scenario.network.lanes[static_cast<std::size_t>(mission.start_lane)].centre;
  constexpr nodes::VehicleParameters kVehicle;
  constexpr double kToCentre_m = 0.5 * kVehicle.length_m - kVehicle.rear_overhang_m;
  const double s_m = mission.start_s_m + mission.start_speed_mps * time_s - kToCentre_m;
  const RearAxle axle = rear_axle_along(line, s_m);
  const RearAxle before = rear_axle_along(line, s_m - mission.start_speed_mps * traffic::kTick_s);
  CarState state;
  state.centre = {axle.point.x + kToCentre_m * std::cos(axle.heading_rad),
                  axle.point.y + kToCentre_m * std::sin(axle.heading_rad)};
  state.heading_rad = axle.heading_rad;
  state.yaw_rate_radps = map::wrap_angle(axle.heading_rad - before.heading_rad) / traffic::kTick_s;
  state.speed_mps = mission.start_speed_mps;
  state.length_m = kVehicle.length_m;
  state.width_m = kVehicle.width_m;
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
