#include "sim_host/world/traffic_engine.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim_host/world/sumo/sumo_traffic.hpp"
#include "sim_host/world/traffic.hpp"

namespace s4tp::world {

const std::vector<std::string>& engine_names() {
  static const std::vector<std::string> names{"builtin", "sumo"};  // in the order of Engine
  return names;
}

Engine engine_of(const std::string& name) {
  const auto found = std::find(engine_names().begin(), engine_names().end(), name);
  if (found == engine_names().end()) {
    throw std::invalid_argument("traffic \"" + name + "\": there are builtin and sumo");
  }
  return static_cast<Engine>(found - engine_names().begin());
}

std::unique_ptr<TrafficEngine> make_engine(const Scenario& scenario, const EngineOptions& options) {
  if (options.engine == Engine::kSumo) {
    return std::make_unique<SumoTraffic>(scenario, options);
  }
  if (options.ego == DrivenBy::kEngine) {
    throw std::invalid_argument("the built-in traffic drives no ego; SUMO does (--traffic sumo)");
  }
  return std::make_unique<Traffic>(scenario, options.episode, options.seed);
}

}  // namespace s4tp::world
