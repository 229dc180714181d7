#pragma once
/// One episode with the ECU's image on an emulated board: what `run --target` does.

#include <filesystem>
#include <ostream>
#include <string>

#include "sim_host/processes/world_process.hpp"

namespace s4tp::processes {

struct TargetOptions {
  std::string target = "m7";      ///< board_targets()
  std::filesystem::path image;    ///< empty: ecu_lockstep of the target's build
  WorldProcessOptions world;      ///< without its bus
  std::filesystem::path weights;  ///< image in the board's flash bank; empty: it carries its own
  std::string telemetry;          ///< shared memory a BoardTwin writes records to; empty: none
  std::filesystem::path out;      ///< folder of run.json, cost_TARGET.json and the console's text
};

/// PROC-044 As drive_on_bus(), then the table of what planning cost. A board that stops says why: its last
/// words are printed, and the exit code is 1. \throws std::runtime_error when there is no image or no QEMU,
/// with what to do
[[nodiscard]] int drive_on_target(const scenario::Scenario& scenario, const TargetOptions& options,
                                  std::ostream& out);

}  // namespace s4tp::processes
