// The host tool: every ./s4tp command that drives the virtual world.

#include <CLI/CLI.hpp>
#include <iostream>
#include <vector>

#include "sim_host/commands/command.hpp"

int main(int argc, char** argv) {
  using namespace s4tp::commands;
  CLI::App tool{"s4tp: drives a virtual vehicle over CAN frames"};
  tool.require_subcommand(1);
  const std::vector<Command> commands{add_demo(tool),   add_eval(tool),    add_run(tool),
                                      add_record(tool), add_traffic(tool), add_coupling(tool),
                                      add_faults(tool), add_risk(tool),    add_roads(tool),
                                      add_train(tool),  add_predict(tool)};
  try {
    tool.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return tool.exit(error) == 0 ? kDone : kWrongUse;
  }
  try {
    for (const Command& command : commands) {
      if (command.app->parsed()) return command.run();
    }
  } catch (const std::exception& error) {
    std::cerr << "s4tp: " << error.what() << '\n';
  }
  return kWrongUse;
}
