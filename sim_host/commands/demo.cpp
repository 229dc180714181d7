#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/progress.hpp"
#include "sim_host/campaign/records.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/campaign/table.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/view/episode_picture.hpp"
#include "sim_host/view/failure_replays.hpp"
#include "sim_host/view/report.hpp"

namespace s4tp::commands {
namespace {

/// Fewer than 20 episodes a cell are too few for rates: then only that nobody was hit through our fault, and
/// that the ECU was never silent.
constexpr int kEnough = 20;

bool demand(bool holds, const std::string& what) {
  if (!holds) std::cout << "FALLS SHORT: " << what << '\n';
  return holds;
}

/// The promises of the demo.
bool keeps_promises(const std::vector<campaign::CellResult>& cells) {
  bool good = true;
  int own_fault = 0;
  int episodes = 0;
  for (const auto& [cell, s, rows] : cells) {
    good &= demand(s.dead_ecu.count == 0, "the ECU fell silent in " + cell.scenario);
    if (cell.planner != "s4tp") continue;
    own_fault += s.at_fault.count;
    episodes += s.episodes;
    good &= demand(s.episodes < kEnough || 20 * s.success.count >= 16 * s.episodes,
                   "s4tp reaches fewer than 16 of 20 goals in " + cell.scenario);
  }
  return good & demand(80 * own_fault <= std::max(episodes, 80),
                       "s4tp causes more than one collision in 80 episodes");
}

/// Whether careless drivers lose 30 % of the left turns and 20 % of the merges: of 100 each, for 20 are too
/// few to tell.
bool traffic_is_hard(campaign::CampaignPlan plan, const std::filesystem::path& scenario_root) {
  plan.planners = {"constant_speed", "blind"};
  plan.scenarios = {"left_turn", "merge"};
  plan.guards = {false};
  plan.episodes = 100;
  const campaign::Campaign campaign = campaign::load_campaign(plan, scenario_root);
  campaign::ConsoleProgress progress(campaign.episodes());
  campaign::CampaignOptions options;
  options.on_episode = [&](const campaign::CampaignCell&, const campaign::EpisodeRow& row,
                           const campaign::EpisodeResult&) { progress.done(words(row.cell)); };
  const std::vector<campaign::EpisodeRow> driven = run_campaign(campaign, jobs_of(campaign), options);
  progress.end();
  bool good = true;
  for (const auto& [cell, s, rows] : collect(driven)) {
    const int lost = s.episodes - s.success.count;
    std::cout << cell.planner << " loses " << lost << " of " << s.episodes << ' ' << cell.scenario << "s\n";
    good &= demand(100 * lost >= (cell.scenario == "left_turn" ? 30 : 20) * s.episodes,
                   cell.planner + " loses too few in " + cell.scenario + ": traffic is too tame");
  }
  return good;
}

/// A campaign with a picture of every episode, and the page that shows them.
int demo(const CommonOptions& common, int episodes) {
  campaign::CampaignPlan plan;
  plan.planners = {"s4tp", "constant_speed", "blind"};
  plan.guards = {true, false};
  plan.flavours = {common.flavour};
  plan.episodes = episodes;
  plan.first_seed = common.seed;
  plan.parameters = common.parameters();
  campaign::Campaign campaign = campaign::load_campaign(plan, common.scenario_root);
  // Careless drivers are shown as they are: the guard would stop them.
  std::erase_if(campaign.cells, [](const campaign::CampaignCell& one) {
    return one.cell.guarded != (one.cell.planner == "s4tp");
  });
  std::filesystem::create_directories(common.out);

  campaign::CampaignOptions options;
  options.trace = true;
  campaign::ConsoleProgress progress(campaign.episodes());
  options.on_episode = [&](const campaign::CampaignCell& cell, const campaign::EpisodeRow& row,
                           const campaign::EpisodeResult& result) {
    progress.done(words(row.cell) + ", seed " + std::to_string(row.metrics.seed) + ": " +
                  metrics::ending_name(row.metrics.ending));
    view::draw_episode(
        cell.scenario->scenario, result,
        common.out / view::picture_name(row.cell.scenario, row.cell.planner, row.metrics.seed));
  };
  std::cerr << "seeds " << plan.first_seed << " to "
            << plan.first_seed + static_cast<std::uint64_t>(plan.episodes) - 1 << '\n';
  const std::vector<campaign::EpisodeRow> rows = run_campaign(campaign, jobs_of(campaign), options);
  progress.end();

  const auto header = campaign::header_of(campaign, {}, common.parameters_file);
  const std::vector<campaign::CellResult> cells = collect(rows);
  campaign::print_table(std::cout, cells);
  nlohmann::ordered_json document = campaign::results_json(header, cells);
  document["episodes_planned"] = campaign.episodes();
  campaign::write_json(common.out / "results.json", document);
  const campaign::Records records = campaign::records_of(header, rows);
  view::ReplayOptions replaying;
  replaying.scenario_root = common.scenario_root;
  const view::Replays replays = view::write_failure_replays(records, replaying, common.out / "replays");
  view::write_report({records, replays, "replays", {}}, common.out);
  std::cout << "\nreport: " << (common.out / "index.html").string()
            << "\nnumbers: " << (common.out / "results.json").string() << '\n';
  bool good = keeps_promises(cells);
  if (episodes >= kEnough) good &= traffic_is_hard(plan, common.scenario_root);
  return good ? kDone : kNotGoodEnough;
}

}  // namespace

Command add_demo(CLI::App& tool) {
  CLI::App* app =
      tool.add_subcommand("demo", "left_turn, merge, cruise and overtake: s4tp beside two careless drivers");
  struct Options {
    CommonOptions common;
    int episodes = 20;
  };
  const auto options = std::make_shared<Options>();
  options->common.out = std::filesystem::path("out") / "demo";
  options->common.seed = kFirstDriveSeed;
  options->common.add_to(*app);
  app->add_option("--episodes", options->episodes, "per scenario and planner (default 20)")->check(kEpisodes);
  return {app, [options] {
            const OwnFolder folder = options->common.choose_out();
            return demo(options->common, options->episodes);
          }};
}

}  // namespace s4tp::commands
