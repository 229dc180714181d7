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

namespace s4tp::world {

namespace fs = std::filesystem;

inline Scenario shipped(const std::string& name) {
  return load_scenario(fs::path(S4TP_SOURCE_DIR) / "sim_host/scenarios" / name);
}

inline EngineOptions without_ego(std::uint64_t seed) {
  EngineOptions options;
  options.engine = Engine::kSumo;
  options.seed = options.episode = seed;
  options.ego = DrivenBy::kNobody;
  return options;
}

inline void advance(TrafficEngine& traffic, double until_s, const EgoSeen* ego = nullptr) {
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

inline bool same(const std::vector<CarState>& a, const std::vector<CarState>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const CarState& x, const CarState& y) {
    return x.id == y.id && x.centre.x == y.centre.x && x.centre.y == y.centre.y &&
           x.speed_mps == y.speed_mps && x.heading_rad == y.heading_rad && x.lane == y.lane;
  });
}

}  // namespace s4tp::world
