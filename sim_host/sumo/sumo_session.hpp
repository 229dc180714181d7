#pragma once
/// A SUMO of our own: started with a scenario, connected to, ready for its first step.

#include <memory>
#include <string>

#include "sim_host/sumo/sumo_process.hpp"
#include "sim_host/sumo/traci_client.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::sumo {

/// A SUMO that has loaded network and routes and waits for its first step.
struct Session {
  std::unique_ptr<Process> process;
  std::unique_ptr<traci::Client> client;
};

/// SUMO-003 \throws std::runtime_error with SUMO's own words when it does not come up
/// \param driver  further attributes of the ego's vehicle type, as XML
[[nodiscard]] Session start_sumo(const scenario::Scenario& scenario, const traffic::EngineOptions& options,
                                 const std::string& driver);

}  // namespace s4tp::sumo
