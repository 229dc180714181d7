#include "sim_host/world/engine_factory.hpp"

#include <stdexcept>

#include "sim_host/sumo/sumo_traffic.hpp"
#include "sim_host/world/adversary/adversary.hpp"
#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::world {

std::unique_ptr<traffic::TrafficEngine> make_engine(const scenario::Scenario& scenario,
                                                    const traffic::EngineOptions& options) {
  if (options.engine == scenario::Engine::kSumo) {
    sumo::EgoCoupling coupling;
    coupling.on_route = !options.ego_on_any_lane;
    return std::make_unique<sumo::Traffic>(scenario, options, coupling);
  }
  if (options.ego == traffic::DrivenBy::kEngine) {
    throw std::invalid_argument("the built-in traffic drives no ego; SUMO does (--traffic sumo)");
  }
  if (options.engine == scenario::Engine::kAdversary) {
    return std::make_unique<adversary::Traffic>(scenario, options.episode, options.seed);
  }
  return std::make_unique<traffic::Traffic>(scenario, options.episode, options.seed);
}

}  // namespace s4tp::world
