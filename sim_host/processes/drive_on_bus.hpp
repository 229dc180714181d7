#pragma once
/// One episode with the world in this process and the ECU somewhere on a bus: what `run --bus` and the world
/// process do.

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "sim_host/processes/world_process.hpp"

namespace s4tp::processes {

struct DriveOptions {
  WorldProcessOptions world;
  std::string planner = "the ECU";       ///< for the report
  std::filesystem::path out;             ///< folder of run.json
  std::vector<std::string> ecu_command;  ///< starts the ECU at the other end; empty: it is there
};

/// The bus's other end: whoever listens is called, every other bus has one name.
[[nodiscard]] std::string other_end(const std::string& bus);
/// Whether two processes of one machine can meet on it: not on a line whose other end is a device.
[[nodiscard]] bool has_two_ends(const std::string& bus);

/// Prints the result as `s4tp run` does and writes run.json. \return exit code: 0 goal, 1 none, 2 no ECU came, 130 told
/// to stop by SIGINT or SIGTERM
/// \throws std::runtime_error for a bus that cannot be opened, a log that cannot be written
[[nodiscard]] int drive_on_bus(const scenario::Scenario& scenario, const DriveOptions& options,
                               std::ostream& out);

}  // namespace s4tp::processes
