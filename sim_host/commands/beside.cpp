// Commands that are programs of their own, as only they need certain libraries.
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/commands/command.hpp"

namespace s4tp::commands {
namespace {

/// Every word behind the command's name is the program's, --help too. --help of all lists it where it is.
Command add_program(CLI::App& tool, const std::string& name, const std::string& description,
                    const std::string& program, const std::string& package) {
  CLI::App* command = tool.add_subcommand(name, description)->prefix_command();
  command->set_help_flag();
  const std::string path = processes::own_program(program);
  const bool there = std::filesystem::exists(path);
  if (!there) command->group("");
  return {
      command, [=]() -> int {
        if (!there)
          throw std::runtime_error(path + " is not there: it is built where " + package + " is installed");
        std::vector<std::string> words{path};
        const std::vector<std::string> rest = command->remaining();
        words.insert(words.end(), rest.begin(), rest.end());
        processes::become(std::move(words));
      }};
}

}  // namespace

Command add_telemetry(CLI::App& tool) {
  return add_program(tool, "telemetry", "a running ECU as DDS topics that ROS 2 and RViz2 read",
                     "s4tp-telemetry", "Debian's cyclonedds-dev");
}

Command add_view(CLI::App& tool) {
  return add_program(tool, "view", "a running ECU as a page in the browser", "s4tp-view",
                     "Debian's libwebsockets-dev");
}

}  // namespace s4tp::commands
