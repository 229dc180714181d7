#pragma once
/// Shipped scenarios with SUMO's traffic.

#include <algorithm>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/sumo/sumo_traffic.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::sumo {

namespace fs = std::filesystem;

inline scenario::Scenario shipped(const std::string& name) {
  return scenario::load_scenario(fs::path(S4TP_SOURCE_DIR) / "sim_host/scenarios" / name);
}

inline traffic::EngineOptions without_ego(std::uint64_t seed) {
  traffic::EngineOptions options;
  options.engine = scenario::Engine::kSumo;
  options.seed = options.episode = seed;
  options.ego = traffic::DrivenBy::kNobody;
  return options;
}

inline void advance(traffic::TrafficEngine& traffic, double until_s, const traffic::EgoSeen* ego = nullptr) {
  while (traffic.time_s() < until_s - 1e-6) traffic.step(ego);
}

inline std::string what_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

inline bool same(const std::vector<traffic::CarState>& a, const std::vector<traffic::CarState>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const traffic::CarState& x, const traffic::CarState& y) {
                      return x.id == y.id && x.centre.x == y.centre.x && x.centre.y == y.centre.y &&
                             x.speed_mps == y.speed_mps && x.heading_rad == y.heading_rad && x.lane == y.lane;
                    });
}

}  // namespace s4tp::sumo
