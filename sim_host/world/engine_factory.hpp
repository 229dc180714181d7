#pragma once
/// Starts the traffic that a drive asks for.

#include <memory>

#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::world {

/// \param scenario  must outlive the engine  \throws std::runtime_error when the engine cannot be started
[[nodiscard]] std::unique_ptr<traffic::TrafficEngine> make_engine(const scenario::Scenario& scenario,
                                                                  const traffic::EngineOptions& options);

}  // namespace s4tp::world
