#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/campaign/compare.hpp"
#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/families.hpp"
#include "sim_host/campaign/family_table.hpp"
#include "sim_host/campaign/progress.hpp"
#include "sim_host/campaign/record_limits.hpp"
#include "sim_host/campaign/records.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/campaign/table.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/scenario/whole_file.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::commands {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kFailuresShown = 30;
constexpr std::uintmax_t kResultBytes = 256U << 20U;  // hundreds of times the main table's

struct EvalOptions {
  campaign::CampaignPlan plan;
  std::vector<std::string> guards{"on"};
  CommonOptions common;
  std::string roads;
  const CLI::Option* scenarios_named = nullptr;
  int jobs = 0;
  std::string shard = "1/1";
  fs::path json;
};

struct MergeOptions {
  std::vector<fs::path> parts;
  fs::path json;
};

struct CompareOptions {
  fs::path first;
  fs::path second;
  std::string planner;
  std::string against;
  fs::path json;
};

campaign::Shard shard_of(const std::string& text) {
  campaign::Shard shard;
  char end = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &end) != 2 || shard.index < 1 ||
      shard.index > shard.count) {
    throw std::invalid_argument("--shard " + text + ": accepted is i/n with i from 1 to n, such as 3/8");
  }
  return shard;
}

/// Table, comparison, failures and JSON: what one run and merged parts have in common.
void report(const ordered_json& header, const std::vector<campaign::EpisodeRow>& rows, const fs::path& json) {
  const std::vector<campaign::CellResult> cells = campaign::collect(rows, header);
  if (campaign::has_families(cells)) {
    campaign::print_families(std::cout, cells);
  } else {
    campaign::print_table(std::cout, cells);
    campaign::print_paired(std::cout, cells);
  }

  const auto command = [&](const campaign::Cell& cell, std::uint64_t seed) {
    return campaign::replay_command(header, cell, seed);
  };
  std::ostringstream failures;
  const std::size_t count = campaign::print_failures(failures, cells, kFailuresShown, command);
  std::cout << '\n'
            << count << " failures" << (count > 0 ? "; each is driven again by its command:\n" : "\n");
  std::cout << failures.str();
  if (count > kFailuresShown) {
    const fs::path all = fs::path(json).replace_extension(".failures.txt");
    std::ofstream stream(all);
    (void)campaign::print_failures(stream, cells, count, command);
    if (!stream.flush()) throw std::runtime_error(all.string() + ": cannot be written");
    std::cout << "and " << count - kFailuresShown << " more: " << all.string() << '\n';
  }
  campaign::write_json(json, campaign::results_json(header, cells));
  std::cout << "\nnumbers: " << json.string() << '\n';
}

int run_eval(EvalOptions& options) {
  const std::atomic<bool>& stop = processes::stop_on_signals();
  campaign::CampaignPlan& plan = options.plan;
  plan.guards.clear();
  for (const std::string& guard : options.guards) plan.guards.push_back(guard == "on");
  plan.first_seed = options.common.seed;
  plan.parameters = options.common.parameters();
  const campaign::Shard shard = shard_of(options.shard);
  if (!options.roads.empty()) {
    if (shard.count > 1 && !fs::is_directory(options.roads)) {
      throw std::invalid_argument(
          "--roads N:K with --shard: draw them once, with ./s4tp roads, and name their folder");
    }
    if (options.scenarios_named->count() == 0) plan.scenarios.clear();
    for (const std::string& folder :
         road_folders(options.roads, options.common.scenario_root, options.common.out / "roads")) {
      plan.scenarios.push_back(folder);
    }
  }
  const campaign::Campaign campaign = campaign::load_campaign(plan, options.common.scenario_root);
  const ordered_json header = campaign::header_of(campaign, shard, options.common.parameters_file);

  const fs::path& out = options.common.out;
  fs::create_directories(out);
  const fs::path file = out / (shard.count == 1 ? "episodes.jsonl"
                                                : "part-" + std::to_string(shard.index) + "-of-" +
                                                      std::to_string(shard.count) + ".jsonl");
  campaign::EpisodeRecord record(file, header);
  std::vector<campaign::EpisodeRow> rows = record.found();
  std::set<std::pair<campaign::Cell, std::uint64_t>> known;
  for (const campaign::EpisodeRow& row : rows) known.emplace(row.cell, row.metrics.seed);
  std::vector<campaign::Job> jobs = campaign::jobs_of(campaign, shard);
  const std::size_t total = jobs.size();
  std::erase_if(jobs, [&](const campaign::Job& job) {
    return known.contains({campaign.cells[job.cell].cell, job.seed});
  });
  if (!rows.empty()) std::cerr << "going on: " << rows.size() << " of " << total << " episodes are done\n";

  campaign::CampaignOptions run;
  run.threads = options.jobs;
  run.stop = &stop;
  campaign::ConsoleProgress progress(total, total - jobs.size());
  double driven_s = 0.0;
  std::vector<std::string> driven_again;
  run.on_episode = [&](const campaign::CampaignCell&, const campaign::EpisodeRow& row,
                       const campaign::EpisodeResult& result) {
    record.append(row);
    if (!result.first_ended.empty())
      driven_again.push_back(words(row.cell) + ", seed " + std::to_string(row.metrics.seed) + ": " +
                             result.first_ended);
    driven_s += result.recording.snapshots.back().time_s - result.recording.snapshots.front().time_s;
    progress.done(words(row.cell) + ", seed " + std::to_string(row.metrics.seed) + ": " +
                  metrics::ending_name(row.metrics.ending));
  };
  std::vector<std::string> not_driven;
  run.on_failure = [&](const std::string& why) { not_driven.push_back(why); };
  const std::vector<campaign::EpisodeRow> fresh = run_campaign(campaign, jobs, run);
  progress.end();
  rows.insert(rows.end(), fresh.begin(), fresh.end());
  if (rows.size() + not_driven.size() < total) {
    std::cerr << "stopped; " << rows.size() << " of " << total << " episodes are done and kept in "
              << file.string() << ". The same command goes on.\n";
    return kInterrupted;
  }
  if (rows.empty() && !not_driven.empty())
    throw std::runtime_error("no episode could be driven: " + not_driven.front());
  if (shard.count == 1) {
    report(header, rows, options.json.empty() ? out / "results.json" : options.json);
  } else {
    std::cout << "part " << options.shard << ": " << rows.size() << " episodes in " << file.string()
              << "\njoin the parts: ./s4tp eval merge " << (out / "part-*.jsonl").string()
              << " --json FILE\n";
  }
  if (!fresh.empty()) {
    const double wall_s = progress.elapsed_s();
    std::cout << fresh.size() << " episodes driven in " << campaign::rough_time(wall_s) << ": "
              << static_cast<int>(driven_s / wall_s) << " times real time\n";
  }
  std::cout << "as a page, with replays of failures: ./s4tp eval report " << out.string() << '\n';
  if (!driven_again.empty())
    std::cerr << driven_again.size() << " of " << total
              << " episodes were ended by SUMO and driven again with its ego on any lane near it:\n";
  for (const std::string& why : driven_again) std::cerr << "  " << why << '\n';
  if (not_driven.empty()) return kDone;
  std::cerr << not_driven.size() << " of " << total
            << " episodes could not be driven and are in no number; the same command tries them again:\n";
  for (const std::string& why : not_driven) std::cerr << "  " << why << '\n';
  return kNotGoodEnough;
}

int merge(const MergeOptions& options) {
  ordered_json header;
  std::vector<campaign::EpisodeRow> rows;
  for (const fs::path& file : options.parts) {
    campaign::Part part = campaign::read_part(file);
    if (part.header.is_null()) throw std::runtime_error(file.string() + ": holds nothing");
    if (header.is_null()) header = part.header;
    const std::string differs = campaign::difference(part.header, header, "shard");
    if (!differs.empty()) {
      throw std::runtime_error(file.string() + " and " + options.parts.front().string() +
                               " are not of the same campaign (" + differs + ')');
    }
    rows.insert(rows.end(), part.rows.begin(), part.rows.end());
  }
  report(header, rows, options.json);
  std::size_t done = 0;
  for (const campaign::CellResult& cell : campaign::collect(rows, header)) done += cell.episodes.size();
  const std::size_t planned = campaign::planned_episodes(header);
  std::cout << done << " of " << planned << " episodes done\n";
  return done == planned ? kDone : kNotGoodEnough;
}

std::vector<campaign::Outcomes> read_outcomes(const fs::path& file) {
  const std::string text = scenario::whole_file(file, kResultBytes);
  try {
    return campaign::outcomes_of(campaign::parse_json(text));
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(file.string() + " is no result of eval: " + error.what());
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

int compare(const CompareOptions& options) {
  const std::vector<campaign::Outcomes> first = read_outcomes(options.first);
  const bool one = options.second.empty();
  const std::vector<campaign::Outcomes> second = one ? first : read_outcomes(options.second);
  if (one && options.against.empty()) {
    throw std::invalid_argument("compare: name a second file, or a second planner with --against");
  }
  const auto cells = campaign::pair_up(first, options.planner, second, options.against);
  if (cells.empty()) {
    throw std::invalid_argument("compare: no cell of one has its like in the other, on the same seeds");
  }
  const auto name = [](const fs::path& file, const std::string& planner) {
    return planner.empty() ? file.string() : planner;
  };
  campaign::print_comparison(std::cout, cells, name(options.first, options.planner),
                             name(one ? options.first : options.second, options.against));
  if (!options.json.empty()) campaign::write_json(options.json, campaign::comparison_json(cells));
  return kDone;
}

}  // namespace

Command add_eval(CLI::App& tool) {
  CLI::App* eval = tool.add_subcommand("eval", "a campaign: every planner in every cell, on the same seeds");
  const auto options = std::make_shared<EvalOptions>();
  campaign::CampaignPlan& plan = options->plan;
  options->common.out = fs::path("out") / "eval";
  eval->add_option("--planner,--planners", plan.planners, "who drives (default s4tp)")
      ->delimiter(',')
      ->check(CLI::IsMember(baselines::planner_names()));
  options->scenarios_named =
      eval->add_option("--scenarios,--scenario", plan.scenarios,
                       "shipped names, folders or .toml files (default left_turn, merge, cruise, overtake)")
          ->delimiter(',');
  eval->add_option("--roads", options->roads,
                   "a folder of scenarios, or N:K, K roads from number N on (s4tp roads); results by family");
  eval->add_option("--flavour,--flavours", plan.flavours, "smarts (default), social, or others they have")
      ->delimiter(',');
  eval->add_option("--traffic", plan.traffic,
                   "who simulates it: builtin (default), sumo, adversary (the worst that the law allows)")
      ->delimiter(',')
      ->check(CLI::IsMember(scenario::engine_names()));
  eval->add_option("--guard", options->guards, "the guard behind the planner: on (default), off")
      ->delimiter(',')
      ->check(CLI::IsMember({"on", "off"}));
  eval->add_option("--perception", plan.perception,
                   "ideal (default), or real: noise, latency, dropouts, occlusion")
      ->check(CLI::IsMember(scenario::perception_names()));
  eval->add_option("--episodes", plan.episodes, "per cell (default 20)")->check(kEpisodes);
  eval->add_option("--first-seed,--seed", options->common.seed, "the others follow (default 0)")
      ->check(kSeed);
  eval->add_option("--parameters", options->common.parameters_file,
                   "TOML file of planner parameters (docs/parameters.md)");
  eval->add_option("--jobs", options->jobs, "episodes at a time (default: one a core)")
      ->check(CLI::PositiveNumber);
  eval->add_option("--shard", options->shard, "i/n: only the ith of n parts; merge joins them");
  eval->add_option("--json", options->json, "the numbers (default: results.json in --out)");
  eval->add_option("--out", options->common.out,
                   "where finished episodes are kept; the same command goes on there (default out/eval)");
  eval->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");

  CLI::App* merging = eval->add_subcommand("merge", "joins the parts of a campaign");
  const auto merge_options = std::make_shared<MergeOptions>();
  merging->add_option("parts", merge_options->parts, "what --shard wrote, finished or not")->required();
  merging->add_option("--json", merge_options->json, "the numbers")->required();

  CLI::App* comparing = eval->add_subcommand("compare", "two results on the same episodes");
  const auto compare_options = std::make_shared<CompareOptions>();
  comparing->add_option("first", compare_options->first, "JSON of a campaign")->required();
  comparing->add_option("second", compare_options->second, "another one (default: the same)");
  comparing->add_option("--planner", compare_options->planner, "whose runs of the first (default: all)");
  comparing->add_option("--against", compare_options->against, "whose of the second (default: the same)");

  comparing->add_option("--json", compare_options->json, "the same numbers");

  const Command reporting = add_eval_report(*eval);
  eval->require_subcommand(0, 1);
  return {eval, [=] {
            if (reporting.app->parsed()) return reporting.run();
            if (merging->parsed()) return merge(*merge_options);
            if (comparing->parsed()) return compare(*compare_options);
            return run_eval(*options);
          }};
}

}  // namespace s4tp::commands
