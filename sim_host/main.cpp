// The host tool: every ./s4tp command that drives the virtual world.
// Exit codes: 0 done, 1 the result is not good enough or an episode failed, 2 wrong use or broken input.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "sim_host/campaign/bus_log.hpp"
#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/driver.hpp"
#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/campaign/reference_drive.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/processes/drive_on_bus.hpp"
#include "sim_host/view/episode_picture.hpp"
#include "sim_host/view/explanation_table.hpp"
#include "sim_host/view/report.hpp"

namespace {

namespace fs = std::filesystem;
using namespace s4tp;

constexpr int kNotGoodEnough = 1;
constexpr int kWrongUse = 2;

const std::vector<std::string> kPaperScenarios{"left_turn", "merge", "cruise", "overtake"};

struct Arguments {
  fs::path scenario_root = S4TP_SCENARIOS;
  std::vector<std::string> scenarios = kPaperScenarios;
  std::string scenario = "left_turn";
  std::vector<std::string> planners{"s4tp"};
  std::string planner = "s4tp";
  std::string parameters_file;
  std::string bus;
  bool realtime = false;
  bool no_ecu = false;
  fs::path out;
  fs::path log;
  int episodes = 20;
  std::uint64_t seed = 0;
};

/// A scenario by the name of a shipped one, or by its folder.
world::Scenario find_scenario(const Arguments& arguments, const std::string& name) {
  const fs::path shipped = arguments.scenario_root / name;
  return world::load_scenario(fs::exists(shipped) ? shipped : fs::path(name));
}

Parameters parameters_of(const Arguments& arguments) {
  return arguments.parameters_file.empty() ? Parameters{}
                                           : campaign::load_parameters(arguments.parameters_file);
}

/// Runs the campaign with progress, table, JSON, a picture of every episode, and the page that shows them.
std::vector<campaign::EpisodeRow> drive(const Arguments& arguments) {
  std::vector<world::Scenario> scenarios;
  for (const std::string& name : arguments.scenarios) scenarios.push_back(find_scenario(arguments, name));
  fs::create_directories(arguments.out);

  campaign::CampaignOptions options;
  options.planners = arguments.planners;
  options.episodes = arguments.episodes;
  options.first_seed = arguments.seed;
  options.parameters = parameters_of(arguments);
  options.trace = true;
  const std::size_t total =
      scenarios.size() * options.planners.size() * static_cast<std::size_t>(options.episodes);
  std::size_t done = 0;
  options.on_episode = [&](const world::Scenario& scenario, const std::string& planner,
                           const campaign::EpisodeResult& result) {
    const world::Recording& recording = result.recording;
    std::cerr << '[' << ++done << '/' << total << "] " << planner << ' ' << scenario.name << " seed "
              << recording.seed << ": " << metrics::ending_name(recording.ending) << '\n';
    view::draw_episode(scenario, result,
                       arguments.out / view::picture_name(scenario.name, planner, recording.seed));
  };
  std::cerr << "seeds " << arguments.seed << " to "
            << arguments.seed + static_cast<std::uint64_t>(arguments.episodes) - 1 << '\n';
  std::vector<campaign::EpisodeRow> rows = campaign::run_campaign(scenarios, options);

  campaign::print_table(std::cout, campaign::summarize(rows));
  campaign::write_json(arguments.out / "results.json", rows, options);
  view::write_report(arguments.out, rows);
  std::cout << "\nreport: " << (arguments.out / "index.html").string()
            << "\nnumbers: " << (arguments.out / "results.json").string() << '\n';
  return rows;
}

/// The promises of the demo. Fewer than 20 episodes a cell are too few for its rates: then only that nobody
/// was hit through our fault, and that the ECU was never silent.
int judge_demo(const std::vector<campaign::EpisodeRow>& rows) {
  constexpr int kEnough = 20;
  bool good = true;
  int own_fault = 0;
  int episodes = 0;
  const auto demand = [&](bool holds, const std::string& what) {
    if (!holds) std::cout << "FALLS SHORT: " << what << '\n';
    good = good && holds;
  };
  for (const campaign::ResultCell& cell : campaign::summarize(rows)) {
    const metrics::Summary& s = cell.summary;
    const int lost = s.episodes - s.goals;
    demand(s.dead_ecu == 0, "the ECU fell silent in " + cell.scenario);
    if (cell.planner == "s4tp") {
      own_fault += s.with_own_fault;
      episodes += s.episodes;
    }
    if (s.episodes < kEnough) continue;
    if (cell.planner == "s4tp") {
      demand(20 * s.goals >= 16 * s.episodes, "s4tp reaches fewer than 16 of 20 goals in " + cell.scenario);
    } else if (cell.scenario == "left_turn") {
      demand(20 * lost >= 6 * s.episodes,
             cell.planner + " loses fewer than 6 of 20 left turns: traffic is too tame");
    } else if (cell.scenario == "merge") {
      demand(20 * lost >= 4 * s.episodes,
             cell.planner + " loses fewer than 4 of 20 merges: traffic is too tame");
    }
  }
  demand(80 * own_fault <= std::max(episodes, 80), "s4tp causes more than one collision in 80 episodes");
  return good ? 0 : kNotGoodEnough;
}

int run_one(const Arguments& arguments) {
  const world::Scenario scenario = find_scenario(arguments, arguments.scenario);
  campaign::EpisodeOptions options;
  options.seed = arguments.seed;
  options.planner = arguments.planner;
  options.parameters = parameters_of(arguments);
  options.trace = true;
  if (!arguments.log.empty()) options.log = arguments.log;
  const campaign::EpisodeResult result = campaign::run_episode(scenario, options);

  fs::create_directories(arguments.out);
  const fs::path picture =
      arguments.out / view::picture_name(scenario.name, arguments.planner, result.recording.seed);
  view::draw_episode(scenario, result, picture);
  const std::vector<campaign::EpisodeRow> rows{
      {scenario.name, arguments.planner, metrics::evaluate(result.recording)}};
  campaign::CampaignOptions one;
  one.episodes = 1;
  one.first_seed = arguments.seed;
  one.parameters = options.parameters;
  campaign::write_json(arguments.out / "run.json", rows, one);

  campaign::print_episode(std::cout, rows.front(), result.recording);
  const fs::path reasons = fs::path(picture).replace_extension(".txt");
  std::ofstream explanations(reasons);
  view::print_explanations(explanations, *result.trace, -result.recording.snapshots.front().time_s);
  std::cout << "picture: " << picture.string() << "\nreasons: " << reasons.string() << '\n';
  if (!arguments.log.empty()) std::cout << "bus log: " << arguments.log.string() << '\n';
  return result.recording.ending == world::Ending::kGoal ? 0 : kNotGoodEnough;
}

/// The same episode, with the ECU at the other end of a real bus.
int run_on_bus(const Arguments& arguments) {
  const bool calls = arguments.bus.starts_with("slcan:tcp:");
  processes::DriveOptions options;
  options.start_ecu = !arguments.no_ecu;
  // With both ends ours, one has to listen.
  options.world.bus = calls && options.start_ecu ? "slcan:listen:" + arguments.bus.substr(10) : arguments.bus;
  if (options.start_ecu && !processes::has_two_ends(options.world.bus)) {
    throw std::runtime_error(arguments.bus + ": the ECU has to be at its other end already; add --no-ecu");
  }
  options.world.seed = arguments.seed;
  options.world.realtime = arguments.realtime;
  if (!arguments.log.empty()) options.world.log = arguments.log;
  options.out = arguments.out;
  if (options.start_ecu) {
    options.planner = arguments.planner;
    options.world.ecu_note = campaign::ecu_note(arguments.planner, parameters_of(arguments));
    options.ecu_arguments = {"--planner", arguments.planner};
    if (!arguments.parameters_file.empty()) {
      options.ecu_arguments.insert(options.ecu_arguments.end(), {"--parameters", arguments.parameters_file});
    }
    if (arguments.realtime) options.ecu_arguments.push_back("--realtime");
  }
  return processes::drive_on_bus(find_scenario(arguments, arguments.scenario), options, std::cout);
}

int record(const Arguments& arguments) {
  const std::uint64_t seed =
      campaign::record_reference_drive(find_scenario(arguments, "left_turn"), arguments.log);
  std::cout << arguments.log.string() << ": left_turn seed " << seed
            << " with a stop, a restart, a lane change, a degraded mode and a missed deadline\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"s4tp: drives a virtual vehicle over CAN frames"};
  app.require_subcommand(1);
  const auto add_common = [&](CLI::App* command) {
    command->add_option("--seed", arguments.seed, "first seed (default 0)");
    command->add_option("--parameters", arguments.parameters_file,
                        "TOML file of planner parameters (docs/parameters.md)");
    command->add_option("--out", arguments.out, "folder for pictures, JSON and report");
    command->add_option("--scenarios-folder", arguments.scenario_root, "where shipped scenarios lie");
  };

  CLI::App* demo = app.add_subcommand("demo", "the four scenarios, s4tp beside two careless drivers");
  add_common(demo);
  demo->add_option("--episodes", arguments.episodes, "per scenario and planner (default 20)")
      ->check(CLI::PositiveNumber);

  CLI::App* eval = app.add_subcommand("eval", "a campaign of your choice");
  add_common(eval);
  eval->add_option("--episodes", arguments.episodes, "per scenario and planner (default 20)")
      ->check(CLI::PositiveNumber);
  eval->add_option("--scenarios", arguments.scenarios, "shipped names or folders")->delimiter(',');
  eval->add_option("--planners", arguments.planners, "s4tp, constant_speed, blind")
      ->delimiter(',')
      ->check(CLI::IsMember(campaign::planner_names()));

  CLI::App* run = app.add_subcommand("run", "one episode");
  add_common(run);
  run->add_option("--scenario", arguments.scenario, "shipped name or folder (default left_turn)");
  run->add_option("--planner", arguments.planner, "s4tp, constant_speed, blind")
      ->check(CLI::IsMember(campaign::planner_names()));
  run->add_option("--log", arguments.log, "write every frame on the bus here, in candump's format");

  CLI::Option* const bus =
      run->add_option("--bus", arguments.bus,
                      "ECU and world as two processes on can0, vcan0, slcan:tcp:HOST:PORT, "
                      "slcan:pty:PATH, slcan:tty:PATH@BAUD (no picture then)");
  run->add_flag("--realtime", arguments.realtime, "on a bus: 10 ms of host time a tick")->needs(bus);
  run->add_flag("--no-ecu", arguments.no_ecu, "on a bus: an ECU is there already")->needs(bus);

  CLI::App* recording = app.add_subcommand("record", "the reference drive that every target must reproduce");
  recording->add_option("--out", arguments.log, "the log to write")->required();
  recording->add_option("--scenarios-folder", arguments.scenario_root, "where shipped scenarios lie");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongUse;
  }
  try {
    if (demo->parsed()) {
      if (arguments.out.empty()) arguments.out = fs::path("out") / "demo";
      arguments.planners = campaign::planner_names();
      return judge_demo(drive(arguments));
    }
    if (eval->parsed()) {
      if (arguments.out.empty()) arguments.out = fs::path("out") / "eval";
      drive(arguments);
      return 0;
    }
    if (run->parsed()) {
      if (arguments.out.empty()) arguments.out = fs::path("out") / "run";
      return arguments.bus.empty() ? run_one(arguments) : run_on_bus(arguments);
    }
    return record(arguments);
  } catch (const std::exception& error) {
    std::cerr << "s4tp: " << error.what() << '\n';
    return kWrongUse;
  }
}
