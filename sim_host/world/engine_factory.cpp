#include "sim_host/world/engine_factory.hpp"

#include <stdexcept>

#include "sim_host/sumo/sumo_traffic.hpp"
#include "sim_host/world/adversary/adversary.hpp"
#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::world {

std::unique_ptr<TrafficEngine> make_engine(const Scenario& scenario, const EngineOptions& options) {
  if (options.engine == Engine::kSumo) {
    return std::make_unique<SumoTraffic>(scenario, options);
  }
  if (options.ego == DrivenBy::kEngine) {
    throw std::invalid_argument("the built-in traffic drives no ego; SUMO does (--traffic sumo)");
  }
  if (options.engine == Engine::kAdversary) {
    return std::make_unique<AdversaryTraffic>(scenario, options.episode, options.seed);
  }
  return std::make_unique<Traffic>(scenario, options.episode, options.seed);
}

}  // namespace s4tp::world
