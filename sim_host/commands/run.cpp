#include <memory>
#include <stdexcept>

#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/commands/run_drives.hpp"
#include "sim_host/commands/vcan_machine.hpp"
#include "sim_host/processes/emulated_board.hpp"
#include "sim_host/world/scenario/perception_preset.hpp"

namespace s4tp::commands {

Command add_run(CLI::App& tool) {
  CLI::App* run = tool.add_subcommand("run", "one episode");
  const auto options = std::make_shared<RunOptions>();
  options->common.out = fs::path("out") / "run";
  options->common.seed = kFirstDriveSeed;
  options->common.add_to(*run);
  options->common.add_traffic_to(*run);
  run->add_option("--scenario", options->scenario, "shipped name, folder or .toml file (default left_turn)");
  CLI::Option* const planner = run->add_option("--planner", options->planner, "who drives (default s4tp)")
                                   ->check(CLI::IsMember(baselines::planner_names()));
  CLI::Option* const guard =
      run->add_option("--guard", options->guard,
                      "the guard, and its last fail-safe, behind the planner (default on)")
          ->check(CLI::IsMember({"on", "off"}));
  run->add_option("--perception", options->perception,
                  "ideal (default), or real: noise, latency, dropouts, occlusion")
      ->check(CLI::IsMember(scenario::perception_names()));
  CLI::Option* const explain = run->add_flag("--explain", options->explain,
                                             "say in words, and in numbers, why the car does what it does");
  run->add_option("--log", options->log, "write every frame on the bus here, in candump's format");
  CLI::Option* const record = run->add_option(
      "--record", options->record, "record the drive here: ./s4tp replay plays it again (docs/recording.md)");
  run->add_option("--record-size-mb", options->record_size_mb,
                  "size at which the next file FILE.1, FILE.2, ... begins (default 256)")
      ->check(CLI::Range(0.001, 1e6))
      ->needs(record);
  run->add_option("--record-keep", options->record_keep,
                  "keep so many files, the newest (default 0: all); without the first one no exact replay")
      ->check(CLI::Range(0, 1'000'000))
      ->needs(record);
  run->add_option(
         "--weights", options->weights,
         "weight image in the ECU's flash bank (default: the build's own); a refused one, and why, is told")
      ->check(CLI::ExistingFile)
      ->excludes(record);  // a recording is played again with the build's own
  CLI::Option* const bus =
      run->add_option("--bus", options->bus,
                      "ECU and world as two processes on can0, vcan0, slcan:tcp:HOST:PORT, "
                      "slcan:pty:PATH, slcan:tty:PATH@BAUD (no picture then)");
  bus->excludes(explain);
  CLI::Option* const realtime =
      run->add_flag("--realtime", options->realtime, "on a bus: 10 ms of host time a tick")->needs(bus);
  CLI::Option* const no_ecu =
      run->add_flag("--no-ecu", options->no_ecu, "on a bus: an ECU is there already")->needs(bus);
  CLI::Option* const input =
      run->add_option("--input", options->input,
                      "on a bus: the ECU takes objects and map from this link and not from the bus; "
                      "./s4tp telemetry --input sends there what is told over DDS (docs/telemetry.md)")
          ->needs(bus)
          ->excludes(record, no_ecu);  // what comes over the link is not in the recording
  CLI::Option* const telemetry = run->add_option("--telemetry", options->telemetry,
                                                 "on a bus, on a target, and live: shared memory the ECU "
                                                 "tells what it does through (default /s4tp_ecu)");
  CLI::Option* const live = run->add_flag("--live", options->live,
                                          "not faster than the clock, for ./s4tp view in another terminal");
  live->excludes(realtime);  // which is by the clock
  CLI::Option* const target =
      run->add_option("--target", options->target,
                      "the ECU's image on an emulated board: m7, m55 (no picture then)")
          ->check(CLI::IsMember(processes::board_targets()))
          ->excludes(bus, planner, guard, explain);
  run->add_option("--image", options->image,
                  "of that board (default: build/TARGET/firmware/targets/ecu_lockstep)")
      ->needs(target);
  run->add_option("--patience", options->patience_s,
                  "on a bus: seconds for each of the ECU's answers (default 1)")
      ->check(CLI::Range(1, 600))
      ->needs(bus);
  run->add_option("--authentic", options->key,
                  "on a bus: both ends authenticate what moves the car; file with a key of 32 hexadecimal "
                  "digits, or env:NAME (docs/threat_model.md)")
      ->needs(bus)
      ->excludes(record);  // a recording has the frames as the ECU takes them
  CLI::Option* const machine =
      run->add_flag("--vm", options->machine, "the vcan of a virtual machine, as where the kernel has no CAN")
          ->needs(bus);
  return {run, [=] {
            const OwnFolder folder = options->common.choose_out();
            if (!options->target.empty()) return run_on_target(*options);
            if (telemetry->count() > 0 && bus->count() + live->count() + target->count() == 0)
              throw std::runtime_error("--telemetry: with --bus, --target or --live only");
            if (options->bus.empty()) return run_one(*options);
            if (!needs_machine(options->bus, options->machine)) return run_on_bus(*options);
            if (options->no_ecu) throw std::runtime_error("--no-ecu: there is no other ECU in the machine");
            if (input->count() > 0) throw std::runtime_error("--input: no link leads into the machine");
            run_on_machine(*options, arguments_of(*run, machine));
          }};
}

}  // namespace s4tp::commands
