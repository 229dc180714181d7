#pragma once
/// The ways to drive one episode that ./s4tp run offers. \return the program's exit code

#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/commands/command.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::commands {

namespace fs = std::filesystem;

struct RunOptions {
  CommonOptions common;
  std::string scenario = "left_turn";
  std::string planner = "s4tp";
  std::string guard = "on";
  [[nodiscard]] bool guarded() const { return guard == "on"; }
  std::string perception = "ideal";
  std::string bus;
  bool realtime = false;
  bool no_ecu = false;
  std::string input;
  std::string target;
  fs::path image;
  int patience_s = 1;
  std::string key;
  bool machine = false;
  fs::path weights;
  fs::path log;
  bool explain = false;
  bool live = false;
  std::string telemetry = telemetry::kDefaultName;
  fs::path record;
  double record_size_mb = 256.0;
  int record_keep = 0;
};

/// In this process.
[[nodiscard]] int run_one(RunOptions run);
/// With the ECU at the other end of a real bus.
[[nodiscard]] int run_on_bus(RunOptions run);
/// With the ECU's image on an emulated board.
[[nodiscard]] int run_on_target(RunOptions run);
/// On the bus of the virtual machine. \param arguments  what was given, without --vm
[[noreturn]] void run_on_machine(const RunOptions& run, std::vector<std::string> arguments);

}  // namespace s4tp::commands
