// The ECU as a process: s4tp_ecu_process --bus vcan0
// Exit codes: 0 driven to the end, 1 nothing heard, 2 wrong use or a bus that cannot be opened.

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/processes/bus_end.hpp"
#include "sim_host/processes/ecu_process.hpp"
#include "sim_host/processes/input_link.hpp"
#include "sim_host/processes/stop_signals.hpp"

namespace {

using namespace s4tp;

/// \param input  the second link; empty: none
processes::EcuEnd run(hal::linux_host::LinuxCan& bus, const std::string& input,
                      const processes::EcuProcessOptions& options) {
  const std::atomic<bool>& stop = processes::stop_on_signals();
  if (input.empty()) return processes::run_ecu(bus, options, std::cout, stop);
  const auto link = std::make_unique<hal::linux_host::NamedBus>();
  processes::open_bus(*link, input, processes::Side::kEcu);
  processes::InputLink both(bus, link->can());
  const processes::EcuEnd end = processes::run_ecu(both, options, std::cout, stop);
  processes::print_counters(std::cout, "ECU's input " + input, link->can().counters());
  return end;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace s4tp;
  processes::EcuProcessOptions options;
  std::string parameters_file;
  CLI::App app{"s4tp ECU on a CAN bus"};
  app.add_option("--bus", options.bus,
                 "can0, vcan0, slcan:tcp:HOST:PORT, slcan:pty:PATH, slcan:tty:PATH@BAUD")
      ->required();
  app.add_option("--planner", options.planner, "the planner on it (default s4tp)")
      ->check(CLI::IsMember(baselines::planner_names()));
  std::string input;
  app.add_option("--input", input, "second link: track lists and the map come from it and not from the bus");
  std::string key;
  app.add_option("--authentic", key,
                 "file with a key of 32 hexadecimal digits, or env:NAME: only what is authentic counts")
      ->excludes("--input");
  std::string guard = "on";
  app.add_option("--guard", guard, "the guard, and its last fail-safe, behind the planner (default on)")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--parameters", parameters_file, "TOML file of planner parameters (docs/parameters.md)");
  std::string weights;
  app.add_option("--weights", weights, "weight image in the ECU's flash bank (default: the build's own)");
  app.add_option("--wait", options.wait_s, "seconds for the first tick (default 60)");
  app.add_option("--silence", options.silence_s, "seconds without a tick that end the drive (default 5)");
  CLI::Option* realtime = app.add_flag("--realtime", options.realtime,
                                       "ticks from a timer of its own, control and planning on threads");
  app.add_option("--telemetry", options.telemetry,
                 "shared memory to write records to, /NAME; s4tp-telemetry and the view read it");
  app.add_option("--report", options.report, "JSON file that says whether it was on time")->needs(realtime);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    options.guarded = guard == "on";
    if (!parameters_file.empty()) options.parameters = campaign::load_parameters(parameters_file);
    if (!weights.empty()) options.weights = campaign::bank_with(weights);
    if (!key.empty()) options.keys = processes::open_keys(key);
    const auto bus = std::make_unique<hal::linux_host::NamedBus>();
    processes::open_bus(*bus, options.bus, processes::Side::kEcu);
    const processes::EcuEnd end = run(bus->can(), input, options);
    if (end != processes::EcuEnd::kNothingHeard) return 0;
    std::cerr << "s4tp_ecu_process: no TICK frame on " << options.bus << " in " << options.wait_s << " s\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "s4tp_ecu_process: " << error.what() << '\n';
    return 2;
  }
}
