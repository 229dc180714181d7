#include <iostream>

#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/world/traffic_engine.hpp"

namespace s4tp::commands {

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--seed,--first-seed", seed, "first seed (default 0)");
  command.add_option("--parameters", parameters_file, "TOML file of planner parameters (docs/parameters.md)");
  command.add_option("--out", out, "folder for pictures, JSON and report");
  command.add_option("--flavour", flavour,
                     "of the scenario: smarts (default: as written), social, or another it has");
  command.add_option("--scenarios-folder", scenario_root, "where shipped scenarios lie");
}

void CommonOptions::add_traffic_to(CLI::App& command) {
  command.add_option("--traffic", traffic, "who simulates it: builtin (default) or sumo (Debian's sumo)")
      ->check(CLI::IsMember(world::engine_names()));
}

Parameters CommonOptions::parameters() const {
  return parameters_file.empty() ? Parameters{} : campaign::load_parameters(parameters_file);
}

world::Scenario CommonOptions::find_scenario(const std::string& name) const {
  world::Scenario scenario = world::load_scenario(world::scenario_path(scenario_root, name), flavour);
  for (const std::string& note : scenario.notes) std::cerr << "note: " << note << '\n';
  return scenario;
}

}  // namespace s4tp::commands
