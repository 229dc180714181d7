#include "sim_host/sumo/coupling_floor.hpp"

#include <algorithm>
#include <cmath>

#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/traffic/start_zone.hpp"

namespace s4tp::sumo {
namespace {

constexpr double kStands_mps = 0.1;

void advance_to_entry(Traffic& traffic, const scenario::Scenario& scenario) {
  const long ticks = std::lround(scenario.mission.entry_time_s / traffic::kTick_s);
  for (long i = 0; i < ticks; ++i) {
    traffic.step(nullptr);
  }
  traffic::free_start_zone(scenario, traffic::CarState{}.length_m, traffic);
}

bool touches(const traffic::CarState& ego, const std::vector<traffic::CarState>& others) {
  return std::any_of(others.begin(), others.end(), [&](const traffic::CarState& car) {
    return traffic::overlap(traffic::box_of(ego), traffic::box_of(car));
  });
}

}  // namespace

Drive sumo_drive(const scenario::Scenario& scenario, std::uint64_t seed, const std::string& driver) {
  traffic::EngineOptions options;
  options.engine = scenario::Engine::kSumo;
  options.seed = options.episode = seed;
  options.ego = traffic::DrivenBy::kEngine;
  EgoCoupling as;
  as.driver = driver;
  Traffic traffic(scenario, options, as);
  advance_to_entry(traffic, scenario);
  const map::Polyline& goal =
      scenario.network.lanes[static_cast<std::size_t>(scenario.mission.goal_lane)].centre;
  Drive drive;
  const long ticks = std::lround(scenario.mission.time_limit_s / traffic::kTick_s);
  for (long i = 0; i < ticks && !drive.arrived; ++i) {
    traffic.step(nullptr);
    drive.ego.push_back(traffic.driven_ego().value());
    drive.others.push_back(traffic.cars());
    const traffic::CarState& ego = drive.ego.back();
    drive.touched = drive.touched || touches(ego, drive.others.back());
    drive.arrived =
        ego.lane == scenario.mission.goal_lane && goal.project(ego.centre).s_m >= scenario.mission.goal_s_m;
  }
  return drive;
}

Replay replay(const scenario::Scenario& scenario, std::uint64_t seed, const Drive& drive,
              const EgoCoupling& coupling) {
  traffic::EngineOptions options;
  options.engine = scenario::Engine::kSumo;
  options.seed = options.episode = seed;
  Traffic traffic(scenario, options, coupling);
  advance_to_entry(traffic, scenario);
  Replay result;
  for (std::size_t i = 0; i + 1 < drive.ego.size() && !result.touched; ++i) {
    const traffic::EgoSeen seen{drive.ego[i], {}};
    if (i > 0) {
      traffic.step(&seen);
    } else {
      traffic::EgoSeen first = seen;  // one tick back
      first.car.centre.x -= traffic::kTick_s * first.car.speed_mps * std::cos(first.car.heading_rad);
      first.car.centre.y -= traffic::kTick_s * first.car.speed_mps * std::sin(first.car.heading_rad);
      traffic.step(&first);
    }
    const std::vector<traffic::CarState> others = traffic.cars();
    if (touches(drive.ego[i], others)) {
      result.touched = true;
      result.stood = drive.ego[i].speed_mps < kStands_mps;
      result.touched_s = static_cast<double>(i + 1) * traffic::kTick_s;
    }
    for (const traffic::CarState& car : others) {
      for (const traffic::CarState& original : drive.others[i]) {
        if (original.id == car.id) {
          result.others_strayed_m =
              std::max(result.others_strayed_m,
                       std::hypot(car.centre.x - original.centre.x, car.centre.y - original.centre.y));
        }
      }
    }
  }
  return result;
}

}  // namespace s4tp::sumo
