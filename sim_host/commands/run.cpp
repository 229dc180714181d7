#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/campaign/bus_log.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/commands/vcan_machine.hpp"
#include "sim_host/processes/drive_on_bus.hpp"
#include "sim_host/processes/drive_on_target.hpp"
#include "sim_host/processes/emulated_board.hpp"
#include "sim_host/processes/own_files.hpp"
#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/recording/recorder.hpp"
#include "sim_host/telemetry/live_drive.hpp"
#include "sim_host/telemetry/records.hpp"
#include "sim_host/view/episode_picture.hpp"
#include "sim_host/view/explanation_table.hpp"
#include "sim_host/view/plan_words.hpp"
#include "sim_host/view/replay.hpp"
#include "sim_host/view/report.hpp"
#include "sim_host/world/scenario/cut.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::commands {
namespace {

namespace fs = std::filesystem;

constexpr double kTick_s = 0.01;

/// Since the ECU takes over.
double cut_start_s(const world::Scenario& scenario) {
  return scenario.cut->start_tick * kTick_s - world::WorldOptions{}.pre_roll_s;
}

std::string format_s(double time_s) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << time_s << " s";
  return text.str();
}

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

/// The drive is this planner's, as the recording notes it; empty: of an ECU that was there already.
std::unique_ptr<recording::Recorder> make_recorder(const RunOptions& run, const world::Scenario& scenario,
                                                   recording::Meeting meeting, const std::string& planner) {
  if (run.record.empty()) return nullptr;
  if (!std::isfinite(run.record_size_mb)) throw std::runtime_error("--record-size-mb: accepted is a number");
  recording::DriveNote note;
  note.scenario = scenario.name;
  note.flavour = run.common.flavour;
  note.seed = run.common.seed;
  note.traffic = run.common.traffic;
  note.perception = run.perception;
  note.planner = planner;
  note.guarded = run.guarded();
  note.parameters = run.common.parameters();
  note.meeting = meeting;
  note.take_over_tick = static_cast<int>(std::lround(world::WorldOptions{}.pre_roll_s / kTick_s));
  const auto bytes = static_cast<std::uint64_t>(run.record_size_mb * 1e6);
  return std::make_unique<recording::Recorder>(run.record, recording::SeriesLimits{bytes, run.record_keep},
                                               std::move(note), scenario);
}

void finish(recording::Recorder& recorder, const RunOptions& run) {
  if (recorder.finish()) std::cout << "recording: " << run.record.string() << '\n';
}

/// The scenario asked for. Of a cut also its seed, its traffic and its perception.
world::Scenario scenario_of(RunOptions& run) {
  world::Scenario scenario = run.common.find_scenario(run.scenario);
  if (scenario.cut) {
    run.common.seed = scenario.cut->seed;
    run.common.traffic = scenario.cut->traffic;
    run.common.flavour = scenario.cut->flavour;
    run.perception = scenario.cut->perception;
    std::cout << "cut: seed " << run.common.seed << "; until " << format_s(cut_start_s(scenario))
              << " the vehicle does what was recorded\n";
  }
  return scenario;
}

int run_one(RunOptions run) try {
  const world::Scenario scenario = scenario_of(run);
  campaign::EpisodeOptions options;
  options.seed = run.common.seed;
  options.planner = run.planner;
  options.guarded = run.guarded() && !baselines::find_planner(run.planner).drives_in_sumo;
  options.engine = world::engine_of(run.common.traffic);
  options.perception = world::perception_preset(run.perception);
  options.parameters = run.common.parameters();
  options.trace = true;
  std::unique_ptr<hal::sim::MemoryFlashBank> bank;
  if (!run.weights.empty()) bank = campaign::bank_with(run.weights);
  options.weights = bank.get();
  if (!run.log.empty()) options.log = run.log;
  std::optional<telemetry::LiveDrive> live;  // a signal must not leave its memory behind
  if (run.live)
    options.onlooker =
        &live.emplace(run.telemetry, run.planner, options.parameters, &processes::stop_on_signals());
  if (!run.record.empty() && baselines::find_planner(run.planner).drives_in_sumo) {
    throw std::runtime_error("--record: " + run.planner + " runs on no ECU, so there is nothing to replay");
  }
  const auto recorder = make_recorder(run, scenario, recording::Meeting::kInProcess, run.planner);
  if (recorder) options.record = recording::sink(*recorder);
  const campaign::EpisodeResult result = campaign::run_episode(scenario, options);

  if (const std::string words = campaign::refused_weights_words(result.weights); !words.empty())
    std::cout << words << '\n';
  fs::create_directories(run.common.out);
  const fs::path picture =
      run.common.out / view::picture_name(scenario.name, run.planner, result.recording.seed);
  view::draw_episode(scenario, result, picture);
  const campaign::EpisodeRow row{
      {run.planner, scenario.name, run.common.flavour, run.common.traffic, options.guarded, run.perception},
      metrics::evaluate(result.recording, scenario)};
  campaign::write_json(run.common.out / "run.json", campaign::results_json(row));

  const fs::path replay = run.common.out / "replay.html";
  view::write_replay(
      {scenario,
       result,
       row,
       campaign::replay_command(row.cell, run.scenario, run.common.parameters_file, row.metrics.seed),
       {}},
      replay);

  campaign::print_episode(std::cout, row, result.recording);
  const fs::path reasons = fs::path(picture).replace_extension(".txt");
  std::ofstream explanations(reasons);
  const double pre_roll_s = -result.recording.snapshots.front().time_s;
  view::print_explanations(explanations, *result.trace, pre_roll_s);
  if (run.explain) view::print_reason_spans(std::cout, *result.trace, pre_roll_s);
  std::cout << "picture: " << picture.string() << "\nreplay: " << replay.string()
            << "\nreasons: " << reasons.string() << '\n';
  if (!run.log.empty()) std::cout << "bus log: " << run.log.string() << '\n';
  if (recorder) finish(*recorder, run);
  return result.recording.ending == world::Ending::kGoal ? 0 : kNotGoodEnough;
} catch (const telemetry::DriveStopped&) {
  return kInterrupted;
}

/// The same episode, with the ECU at the other end of a real bus.
int run_on_bus(RunOptions run) {
  const world::Scenario scenario = scenario_of(run);
  const bool calls = run.bus.starts_with("slcan:tcp:");
  processes::DriveOptions options;
  const bool starts = !run.no_ecu;
  // With both ends ours, one has to listen.
  options.world.bus = calls && starts ? "slcan:listen:" + run.bus.substr(10) : run.bus;
  if (starts && !processes::has_two_ends(options.world.bus)) {
    throw std::runtime_error(run.bus + ": the ECU has to be at its other end already; add --no-ecu");
  }
  options.world.seed = run.common.seed;
  options.world.engine = world::engine_of(run.common.traffic);
  options.world.perception = world::perception_preset(run.perception);
  options.world.realtime = run.realtime;
  options.world.paced = run.live;
  options.world.wait_for_answers(run.patience_s);
  if (!run.log.empty()) options.world.log = run.log;
  if (!run.key.empty()) options.world.keys = processes::open_keys(run.key);
  options.out = run.common.out;
  if (starts) {
    options.planner = run.planner;
    options.world.ecu_note = campaign::ecu_note(run.planner, run.guarded(), run.common.parameters());
    std::vector<std::string>& ecu = options.ecu_command;
    ecu = {processes::own_program("s4tp_ecu_process"), "--bus", processes::other_end(options.world.bus)};
    ecu.insert(ecu.end(), {"--planner", run.planner, "--guard", run.guard});
    if (!run.common.parameters_file.empty()) {
      ecu.insert(ecu.end(), {"--parameters", run.common.parameters_file});
    }
    if (!run.weights.empty()) ecu.insert(ecu.end(), {"--weights", fs::absolute(run.weights).string()});
    if (run.realtime) ecu.push_back("--realtime");
    if (!run.input.empty()) ecu.insert(ecu.end(), {"--input", run.input});
    if (!run.key.empty()) ecu.insert(ecu.end(), {"--authentic", run.key});
    ecu.insert(ecu.end(), {"--telemetry", run.telemetry});
  }
  const auto meeting = run.realtime ? recording::Meeting::kRealTime : recording::Meeting::kLockStep;
  const auto recorder = make_recorder(run, scenario, meeting, starts ? run.planner : "");
  if (recorder) options.world.record = recording::sink(*recorder);
  const int code = processes::drive_on_bus(scenario, options, std::cout);
  if (recorder) finish(*recorder, run);
  return code;
}

/// The same episode, with the ECU's image on an emulated board.
int run_on_target(RunOptions run) {
  if (!run.common.parameters_file.empty()) {
    throw std::runtime_error("--parameters: an image has its own; --target drives with those");
  }
  const world::Scenario scenario = scenario_of(run);
  processes::TargetOptions options;
  options.target = run.target;
  options.image = run.image;
  options.telemetry = run.telemetry;
  options.weights = run.weights;
  options.world.seed = run.common.seed;
  options.world.engine = world::engine_of(run.common.traffic);
  options.world.perception = world::perception_preset(run.perception);
  options.world.ecu_note = campaign::ecu_note("s4tp", true, Parameters{});
  options.world.paced = run.live;
  if (!run.log.empty()) options.world.log = run.log;
  options.out = run.common.out;
  const auto recorder = make_recorder(run, scenario, recording::Meeting::kLockStep, "s4tp");
  if (recorder) options.world.record = recording::sink(*recorder);
  const int code = processes::drive_on_target(scenario, options, std::cout);
  if (recorder) finish(*recorder, run);
  return code;
}

/// The same in the virtual machine. \param arguments  what was given, without --vm
[[noreturn]] void run_on_machine(const RunOptions& run, std::vector<std::string> arguments) {
  fs::create_directories(run.common.out);
  if (run.common.out_named->count() == 0) arguments.push_back("--out=" + run.common.out.string());
  fs::path log = run.log;
  if (run.realtime && !run.telemetry.empty()) {
    std::cout
        << "./s4tp view does not show this drive: in real time nobody knows what the ECU heard in a tick"
        << std::endl;
  } else if (!run.telemetry.empty()) {
    if (log.empty()) arguments.push_back("--log=" + (log = run.common.out / "bus.log").string());
    show_machine(log, run.telemetry,
                 {run.bus + " of the virtual machine", run.planner, run.guarded(), run.common.parameters()});
  }
  std::vector<fs::path> written{run.common.out};
  for (const fs::path& file : {log, run.record}) {
    if (!file.empty()) written.push_back(fs::absolute(file).parent_path());
  }
  run_in_machine(run.bus, arguments, written);
}

}  // namespace

Command add_run(CLI::App& tool) {
  CLI::App* run = tool.add_subcommand("run", "one episode");
  const auto options = std::make_shared<RunOptions>();
  options->common.out = fs::path("out") / "run";
  options->common.add_to(*run);
  options->common.add_traffic_to(*run);
  run->add_option("--scenario", options->scenario, "shipped name, folder or .toml file (default left_turn)");
  CLI::Option* const planner = run->add_option("--planner", options->planner, "who drives (default s4tp)")
                                   ->check(CLI::IsMember(baselines::planner_names()));
  CLI::Option* const guard = run->add_option("--guard", options->guard,
                                             "check, RSS and minimum-risk manoeuvre behind him (default on)")
                                 ->check(CLI::IsMember({"on", "off"}));
  run->add_option("--perception", options->perception,
                  "ideal (default), or real: noise, latency, dropouts, occlusion")
      ->check(CLI::IsMember(world::perception_names()));
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
            options->common.choose_out();
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
