#include "sim_host/campaign/campaign.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/campaign/digest.hpp"
#include "sim_host/sumo/sumo_routes.hpp"

namespace s4tp::campaign {
namespace {

/// Of the scenario's tables, and those beside and above it that it may name, its network and its routes.
std::string digest_of(const scenario::Scenario& scenario) {
  std::set<std::filesystem::path> tables;
  for (const std::filesystem::path& folder : {scenario.folder, scenario.folder / ".."}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder)) {
      if (entry.path().extension() == ".toml") tables.insert(entry.path());
    }
  }
  Digest digest;
  for (const std::filesystem::path& table : tables) digest.add_file(table);
  digest.add_file(scenario.network_file);
  for (const std::filesystem::path& routes : scenario.route_files) digest.add_file(routes);
  return digest.hex();
}

bool is_sumo(const std::string& traffic) {
  return scenario::engine_of(traffic) == scenario::Engine::kSumo;
}

/// An episode that ended for a reason of neither driver nor world, and why.
struct NotDriven : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// So many may fail, and so large a share of those driven: more have one cause, and waste the time.
constexpr double kFewFailures = 3.0;
constexpr double kFailureShare = 0.05;

using ByFlavourAndArgument =
    std::map<std::pair<std::string, std::string>, std::shared_ptr<const CampaignScenario>>;

ByFlavourAndArgument load_scenarios(const CampaignPlan& plan, const std::filesystem::path& scenario_root,
                                    bool with_sumo) {
  ByFlavourAndArgument loaded;
  std::map<std::string, std::string> argument_of;  // scenario name -> argument
  for (const std::string& flavour : plan.flavours) {
    for (const std::string& argument : plan.scenarios) {
      auto one = std::make_shared<CampaignScenario>();
      one->argument = argument;
      one->scenario = scenario::load_scenario(scenario::scenario_path(scenario_root, argument), flavour);
      if (with_sumo) sumo::check_names(one->scenario);
      one->digest = digest_of(one->scenario);
      const auto [known, fresh] = argument_of.emplace(one->scenario.name, argument);
      if (!fresh && known->second != argument) {
        throw std::invalid_argument("scenarios " + known->second + " and " + argument + " are both called '" +
                                    one->scenario.name + "': results could not be told apart");
      }
      loaded[{flavour, argument}] = one;
    }
  }
  return loaded;
}

/// A planner's cells in one traffic, guarded or not.
void add_cells(Campaign& campaign, const ByFlavourAndArgument& scenarios, const std::string& planner,
               bool guarded, const std::string& traffic) {
  const CampaignPlan& plan = campaign.plan;
  for (const std::string& flavour : plan.flavours) {
    for (const std::string& argument : plan.scenarios) {
      const auto& scenario = scenarios.at({flavour, argument});
      campaign.cells.push_back(
          {{planner, scenario->scenario.name, flavour, traffic, guarded, plan.perception}, scenario});
    }
  }
}

}  // namespace

Campaign load_campaign(const CampaignPlan& plan, const std::filesystem::path& scenario_root) {
  const bool with_sumo = std::any_of(plan.traffic.begin(), plan.traffic.end(), is_sumo);
  const ByFlavourAndArgument scenarios = load_scenarios(plan, scenario_root, with_sumo);
  Campaign campaign{plan, {}};
  for (const std::string& planner : plan.planners) {
    // SUMO's own driver: in its traffic only, and nothing to guard.
    const bool by_sumo = baselines::find_planner(planner).drives_in_sumo;
    if (by_sumo && !with_sumo) {
      throw std::invalid_argument(planner + " drives in SUMO's traffic only: --traffic sumo");
    }
    for (const bool guarded : by_sumo ? std::vector<bool>{false} : plan.guards) {
      for (const std::string& traffic : plan.traffic) {
        if (!by_sumo || is_sumo(traffic)) add_cells(campaign, scenarios, planner, guarded, traffic);
      }
    }
  }
  std::set<Cell> known;
  for (const CampaignCell& cell : campaign.cells) {
    if (!known.insert(cell.cell).second) {
      throw std::invalid_argument(
          words(cell.cell) + " is asked for twice: its episodes would count twice; name each value once");
    }
  }
  return campaign;
}

std::vector<Job> jobs_of(const Campaign& campaign, const Shard& shard) {
  std::vector<Job> jobs;
  std::size_t number = 0;
  for (std::size_t cell = 0; cell < campaign.cells.size(); ++cell) {
    for (int i = 0; i < campaign.plan.episodes; ++i, ++number) {
      if (number % static_cast<std::size_t>(shard.count) != static_cast<std::size_t>(shard.index - 1))
        continue;
      jobs.push_back({cell, campaign.plan.first_seed + static_cast<std::uint64_t>(i)});
    }
  }
  return jobs;
}

std::vector<EpisodeRow> run_campaign(const Campaign& campaign, const std::vector<Job>& jobs,
                                     const CampaignOptions& options) {
  std::vector<std::optional<EpisodeRow>> rows(jobs.size());
  std::atomic<std::size_t> next{0};
  std::mutex report_mutex;
  std::exception_ptr failure;
  double done = 0.0;
  double failed = 0.0;
  const auto drive = [&](const Job& job) {
    const CampaignCell& cell = campaign.cells[job.cell];
    EpisodeOptions episode;
    episode.seed = job.seed;
    episode.planner = cell.cell.planner;
    episode.guarded = cell.cell.guarded;
    episode.engine = scenario::engine_of(cell.cell.traffic);
    episode.perception = scenario::perception_preset(cell.cell.perception);
    episode.parameters = campaign.plan.parameters;
    episode.trace = options.trace;
    try {
      return run_episode(cell.scenario->scenario, episode);
    } catch (const std::exception& error) {
      throw NotDriven(words(cell.cell) + ", seed " + std::to_string(job.seed) + ": " + error.what());
    }
  };
  const auto give_up = [&] {
    if (!failure) failure = std::current_exception();
    next = jobs.size();
  };
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      if (options.stop != nullptr && *options.stop) return;
      try {
        const EpisodeResult result = drive(jobs[i]);
        const CampaignCell& cell = campaign.cells[jobs[i].cell];
        rows[i] = {cell.cell, metrics::evaluate(result.recording, cell.scenario->scenario)};
        const std::lock_guard lock(report_mutex);
        if (options.on_episode) options.on_episode(cell, *rows[i], result);
        done += 1.0;
      } catch (const NotDriven& error) {
        const std::lock_guard lock(report_mutex);
        if (options.on_failure) options.on_failure(error.what());
        failed += 1.0;
        if (!options.on_failure || failed > kFewFailures + kFailureShare * done) give_up();
      } catch (...) {
        const std::lock_guard lock(report_mutex);
        give_up();
      }
    }
  };
  const int wanted =
      options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < std::max(wanted, 1); ++i) threads.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  std::vector<EpisodeRow> driven;
  for (std::optional<EpisodeRow>& row : rows) {
    if (row) driven.push_back(std::move(*row));
  }
  return driven;
}

}  // namespace s4tp::campaign
