#include "sim_host/commands/run_drives.hpp"

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
#include "sim_host/commands/vcan_machine.hpp"
#include "sim_host/processes/drive_on_bus.hpp"
#include "sim_host/processes/drive_on_target.hpp"
#include "sim_host/processes/own_files.hpp"
#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/recording/recorder.hpp"
#include "sim_host/telemetry/live_drive.hpp"
#include "sim_host/view/episode_picture.hpp"
#include "sim_host/view/explanation_table.hpp"
#include "sim_host/view/plan_words.hpp"
#include "sim_host/view/replay.hpp"
#include "sim_host/view/report.hpp"
#include "sim_host/world/scenario/cut.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::commands {
namespace {

/// Since the ECU takes over.
double cut_start_s(const scenario::Scenario& scenario) {
  return scenario.cut->start_tick * traffic::kTick_s - world::WorldOptions{}.pre_roll_s;
}

std::string format_s(double time_s) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << time_s << " s";
  return text.str();
}

/// The drive is this planner's, as the recording notes it; empty: of an ECU that was there already.
std::unique_ptr<recording::Recorder> make_recorder(const RunOptions& run, const scenario::Scenario& scenario,
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
  note.take_over_tick = static_cast<int>(std::lround(world::WorldOptions{}.pre_roll_s / traffic::kTick_s));
  const auto bytes = static_cast<std::uint64_t>(run.record_size_mb * 1e6);
  return std::make_unique<recording::Recorder>(run.record, recording::SeriesLimits{bytes, run.record_keep},
                                               std::move(note), scenario);
}

void finish(recording::Recorder& recorder, const RunOptions& run) {
  if (recorder.finish()) std::cout << "recording: " << run.record.string() << '\n';
}

/// The scenario asked for. Of a cut also its seed, its traffic and its perception.
scenario::Scenario scenario_of(RunOptions& run) {
  scenario::Scenario scenario = run.common.find_scenario(run.scenario);
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

}  // namespace

int run_one(RunOptions run) try {
  const scenario::Scenario scenario = scenario_of(run);
  campaign::EpisodeOptions options;
  options.seed = run.common.seed;
  options.planner = run.planner;
  options.guarded = run.guarded() && !baselines::find_planner(run.planner).drives_in_sumo;
  options.engine = scenario::engine_of(run.common.traffic);
  options.perception = scenario::perception_preset(run.perception);
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

  if (!result.first_ended.empty())
    std::cout << "driven again with SUMO's ego on any lane near it: " << result.first_ended << '\n';
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
  return result.recording.ending == traffic::Ending::kGoal ? 0 : kNotGoodEnough;
} catch (const telemetry::DriveStopped&) {
  return kInterrupted;
}

int run_on_bus(RunOptions run) {
  const scenario::Scenario scenario = scenario_of(run);
  const bool calls = run.bus.starts_with("slcan:tcp:");
  processes::DriveOptions options;
  const bool starts = !run.no_ecu;
  // With both ends ours, one has to listen.
  options.world.bus = calls && starts ? "slcan:listen:" + run.bus.substr(10) : run.bus;
  if (starts && !processes::has_two_ends(options.world.bus)) {
    throw std::runtime_error(run.bus + ": the ECU has to be at its other end already; add --no-ecu");
  }
  options.world.seed = run.common.seed;
  options.world.engine = scenario::engine_of(run.common.traffic);
  options.world.perception = scenario::perception_preset(run.perception);
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

int run_on_target(RunOptions run) {
  if (!run.common.parameters_file.empty()) {
    throw std::runtime_error("--parameters: an image has its own; --target drives with those");
  }
  const scenario::Scenario scenario = scenario_of(run);
  processes::TargetOptions options;
  options.target = run.target;
  options.image = run.image;
  options.telemetry = run.telemetry;
  options.weights = run.weights;
  options.world.seed = run.common.seed;
  options.world.engine = scenario::engine_of(run.common.traffic);
  options.world.perception = scenario::perception_preset(run.perception);
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

void run_on_machine(const RunOptions& run, std::vector<std::string> arguments) {
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

}  // namespace s4tp::commands
