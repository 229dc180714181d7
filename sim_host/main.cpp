// The host tool: every ./s4tp command that drives the virtual world.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/commands/command.hpp"
#include "sim_host/commands/slips.hpp"

namespace {

int run(CLI::App& tool, int argc, char** argv) {
  using namespace s4tp::commands;
  const std::vector<Command> commands{
      add_demo(tool),    add_eval(tool),     add_run(tool),       add_record(tool), add_replay(tool),
      add_traffic(tool), add_coupling(tool), add_faults(tool),    add_risk(tool),   add_roads(tool),
      add_train(tool),   add_predict(tool),  add_telemetry(tool), add_view(tool)};
  std::vector<std::string> arguments = with_lists_joined({argv + 1, argv + argc});
  if (arguments.empty()) {
    std::cout << first_steps();
    return kDone;
  }
  if (const std::string wrong = wrong_command(tool, arguments.front()); !wrong.empty()) {
    throw std::runtime_error(wrong);
  }
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  tool.parse(std::move(arguments));
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return kWrongUse;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace s4tp::commands;
  CLI::App tool{"s4tp: drives a virtual vehicle over CAN frames", "s4tp"};
  tool.require_subcommand(1);
  tool.set_version_flag("--version", "s4tp " S4TP_VERSION, "the version, and nothing else");
  try {
    return run(tool, argc, argv);
  } catch (const CLI::ExtrasError&) {
    std::cerr << "s4tp: " << wrong_arguments(tool) << '\n';
    return kWrongUse;
  } catch (const CLI::ParseError& error) {
    return tool.exit(error) == 0 ? kDone : kWrongUse;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << "s4tp: " << error.path1().string() << ": " << error.code().message()
              << "; results need a folder that can be written: --out FOLDER names one\n";
    return kWrongUse;
  } catch (const std::exception& error) {
    std::cerr << "s4tp: " << error.what() << '\n';
    return kWrongUse;
  }
}
