// The world as a process: s4tp_world_process --bus vcan0 --scenario left_turn --seed 3
// Exit codes: 0 goal reached, 1 not, 2 wrong use, a bus that cannot be opened, or no ECU on it,
// 130 told to stop.

#include <CLI/CLI.hpp>
#include <iostream>

#include "sim_host/processes/drive_on_bus.hpp"
#include "sim_host/processes/own_files.hpp"

int main(int argc, char** argv) {
  using namespace s4tp;
  namespace fs = std::filesystem;
  processes::DriveOptions options;
  fs::path scenario_root;
  fs::path log;
  std::string scenario = "left_turn";
  std::string flavour = "smarts";
  std::string traffic = "builtin";
  int patience_s = 1;
  CLI::App app{"s4tp's virtual world on a CAN bus"};
  app.add_option(
         "--bus", options.world.bus,
         "can0, vcan0, slcan:tcp:HOST:PORT, slcan:listen:HOST:PORT, slcan:pty:PATH, slcan:tty:PATH@BAUD")
      ->required();
  app.add_option("--scenario", scenario, "shipped name, folder or .toml file (default left_turn)");
  app.add_option("--flavour", flavour,
                 "of the scenario: smarts (default: as written), social, or another it has");
  app.add_option("--scenarios-folder", scenario_root, "where shipped scenarios lie");
  app.add_option("--seed", options.world.seed, "of the traffic (default 0)")
      ->check([](const std::string& text) {  // CLI11 alone takes -1 for 2^64 - 1
        return text.find_first_not_of("0123456789") == std::string::npos ? ""
                                                                         : text + ": accepted are digits";
      });
  app.add_option("--traffic", traffic, "who simulates it: builtin (default) or sumo (Debian's sumo)")
      ->check(CLI::IsMember(scenario::engine_names()));
  app.add_option("--wait-ecu", options.world.wait_s,
                 "seconds for a sign of the ECU (default 10; 0: begin at once)");
  app.add_option("--patience", patience_s, "seconds for each of the ECU's answers (default 1)")
      ->check(CLI::Range(1, 600));
  app.add_option("--log", log, "write every frame on the bus here, in candump's format");
  std::string key;
  app.add_option("--authentic", key,
                 "file with a key of 32 hexadecimal digits, or env:NAME: only what is authentic counts");
  app.add_option("--out", options.out, "folder for run.json");
  app.add_flag("--realtime", options.world.realtime, "10 ms of host time a tick, whatever the ECU does");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (!log.empty()) options.world.log = log;
    if (!key.empty()) options.world.keys = processes::open_keys(key);
    options.world.engine = scenario::engine_of(traffic);
    options.world.wait_for_answers(patience_s);
    if (scenario_root.empty()) scenario_root = processes::own_data("scenarios");
    const scenario::Scenario loaded =
        scenario::load_scenario(scenario::scenario_path(scenario_root, scenario), flavour);
    return processes::drive_on_bus(loaded, options, std::cout);
  } catch (const std::exception& error) {
    std::cerr << "s4tp_world_process: " << error.what() << '\n';
    return 2;
  }
}
