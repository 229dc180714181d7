#include "sim_host/commands/drive.hpp"

#include <iostream>

#include "sim_host/campaign/results.hpp"
#include "sim_host/view/episode_picture.hpp"
#include "sim_host/view/report.hpp"

namespace s4tp::commands {

std::vector<campaign::EpisodeRow> drive(const DriveOptions& drive) {
  const CommonOptions& common = drive.common;
  std::vector<world::Scenario> scenarios;
  for (const std::string& name : drive.scenarios) scenarios.push_back(common.find_scenario(name));
  std::filesystem::create_directories(common.out);

  campaign::CampaignOptions options;
  options.planners = drive.planners;
  options.engine = world::engine_of(common.traffic);
  options.episodes = drive.episodes;
  options.first_seed = common.seed;
  options.parameters = common.parameters();
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
                       common.out / view::picture_name(scenario.name, planner, recording.seed));
  };
  std::cerr << "seeds " << common.seed << " to "
            << common.seed + static_cast<std::uint64_t>(drive.episodes) - 1 << '\n';
  std::vector<campaign::EpisodeRow> rows = campaign::run_campaign(scenarios, options);

  campaign::print_table(std::cout, campaign::summarize(rows));
  campaign::write_json(common.out / "results.json", rows, options);
  view::write_report(common.out, rows);
  std::cout << "\nreport: " << (common.out / "index.html").string()
            << "\nnumbers: " << (common.out / "results.json").string() << '\n';
  return rows;
}

}  // namespace s4tp::commands
