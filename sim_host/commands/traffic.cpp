#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/campaign/traffic_watch.hpp"
#include "sim_host/commands/command.hpp"

namespace s4tp::commands {
namespace {

struct TrafficOptions {
  CommonOptions common;
  std::vector<std::string> scenarios{"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"};
  std::vector<std::string> flavours{"smarts", "social"};
  std::vector<std::string> engines{"builtin"};
  std::filesystem::path json;
  std::filesystem::path markdown;
  campaign::WatchOptions watch;
};

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

int run(TrafficOptions& options) {
  std::vector<metrics::TrafficRun> runs;
  const std::size_t kinds = options.flavours.size() * options.scenarios.size() * options.engines.size();
  campaign::ConsoleProgress progress(kinds * static_cast<std::size_t>(options.watch.episodes));
  for (const std::string& flavour : options.flavours) {
    options.common.flavour = flavour;
    for (const std::string& name : options.scenarios) {
      const scenario::Scenario scenario = options.common.find_scenario(name);
      for (const std::string& engine : options.engines) {
        options.watch.engine = scenario::engine_of(engine);
        options.watch.first_seed = options.common.seed;
        options.watch.on_episode = [&](int) { progress.done(name + ", " + flavour + ", " + engine); };
        runs.push_back(campaign::watch_traffic(scenario, options.watch));
      }
    }
  }
  progress.end();
  metrics::write_traffic_tables(std::cout, runs);
  if (!options.json.empty()) write(options.json, metrics::traffic_json(runs).dump(2) + "\n");
  if (!options.markdown.empty()) {
    std::ostringstream text;
    metrics::write_traffic_tables(text, runs);
    write(options.markdown, text.str());
  }
  return kDone;
}

}  // namespace

Command add_traffic(CLI::App& tool) {
  CLI::App* traffic = tool.add_subcommand("traffic", "statistics of the traffic alone, without a planner");
  const auto options = std::make_shared<TrafficOptions>();
  traffic->add_option("--scenarios,--scenario", options->scenarios, "shipped names, folders or .toml files")
      ->delimiter(',');
  traffic->add_option("--flavour", options->flavours, "smarts, social (default: both)")->delimiter(',');
  traffic->add_option("--traffic", options->engines, "builtin (default), sumo, or both")
      ->delimiter(',')
      ->check(CLI::IsMember(scenario::engine_names()));
  traffic->add_option("--episodes", options->watch.episodes, "per scenario, flavour and engine (default 20)")
      ->check(kEpisodes);
  traffic->add_option("--seed,--first-seed", options->common.seed, "first seed (default 0)")->check(kSeed);
  traffic->add_option("--seconds", options->watch.duration_s, "length of an episode (default 120)")
      ->check(CLI::Range(10.0, 3600.0));
  traffic->add_flag("--neutral-driver", options->watch.neutral_driver,
                    "one more driver, on the mission's way from the time of entry on");
  traffic->add_option("--json", options->json, "write the figures here");
  traffic->add_option("--markdown", options->markdown, "write the tables here");
  traffic->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  return {traffic, [options] { return run(*options); }};
}

}  // namespace s4tp::commands
