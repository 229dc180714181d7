#include <fstream>
#include <iostream>
#include <thread>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/faults/fault_campaign.hpp"
#include "sim_host/metrics/metrics.hpp"
#include "sim_host/world/scenario/whole_file.hpp"

namespace s4tp::commands {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kScriptBytes = 1 << 20;

struct FaultsOptions {
  CommonOptions common;
  faults::CampaignOptions campaign;
  std::vector<std::string> scenarios{"cruise", "cut_in", "left_turn", "merge", "overtake"};
  std::string script;
};

faults::Scenarios load(const FaultsOptions& options) {
  faults::Scenarios scenarios;
  for (const std::string& name : options.scenarios) {
    scenario::Scenario scenario = options.common.find_scenario(name);
    scenarios.insert_or_assign(scenario.name, std::move(scenario));
  }
  return scenarios;
}

int judge_one(const faults::Scenarios& scenarios, const faults::FaultScript& script) {
  std::cout << faults::to_text(script);
  if (!scenarios.contains(script.scenario)) {
    throw std::runtime_error("scenario " + script.scenario + ": name it with --scenarios");
  }
  faults::RunOptions run;
  run.story = &std::cout;
  const faults::RunResult result = faults::run_script(scenarios, script, run);
  const faults::Verdict& verdict = result.verdict;
  std::cout << "outcome: " << faults::outcome_name(verdict.outcome)
            << ", world: " << metrics::ending_name(result.ending) << '\n';
  if (verdict.breach == faults::Breach::kNone) return kDone;
  std::cout << "FAILED at tick " << verdict.tick << ", " << faults::breach_name(verdict.breach) << ": "
            << verdict.what << '\n';
  return kNotGoodEnough;
}

int judge_many(const FaultsOptions& options, const faults::Scenarios& scenarios) {
  faults::CampaignOptions campaign = options.campaign;
  std::cerr << "seeds " << campaign.first_seed << " to "
            << campaign.first_seed + static_cast<std::uint64_t>(campaign.scripts) - 1 << '\n';
  campaign::ConsoleProgress progress(static_cast<std::size_t>(campaign.scripts));
  campaign.on_progress = [&](int, int failed) { progress.done(std::to_string(failed) + " failed"); };
  const auto runner = [&](const faults::FaultScript& script) {
    return faults::run_script(scenarios, script);
  };
  const faults::CampaignResult result = faults::run_campaign(scenarios, runner, campaign);
  progress.end();

  faults::print_table(std::cout, result);
  fs::create_directories(options.common.out);
  const fs::path numbers = options.common.out / "faults.json";
  faults::write_json(numbers, result);
  std::cout << "\nnumbers: " << numbers.string() << '\n';
  const auto first = result.first_failed();
  if (!first) return kDone;
  const faults::Verdict& verdict = result.results[*first].verdict;
  const fs::path script = options.common.out / "failing_script.txt";
  std::ofstream(script) << faults::to_text(*result.minimized);
  std::cout << "\nFAILED: " << result.failed() << " scripts. The first, seed " << result.scripts[*first].seed
            << ", " << faults::breach_name(verdict.breach) << ": " << verdict.what
            << "\ncut down to (./s4tp faults --script " << script.string() << "):\n"
            << faults::to_text(*result.minimized);
  return kNotGoodEnough;
}

}  // namespace

Command add_faults(CLI::App& tool) {
  CLI::App* app =
      tool.add_subcommand("faults", "random faults on the bus; nothing may silence or crash the ECU");
  const auto options = std::make_shared<FaultsOptions>();
  options->common.out = fs::path("out") / "faults";
  options->campaign.isolation.jobs = static_cast<int>(std::thread::hardware_concurrency());
  app->add_option("--scripts", options->campaign.scripts, "how many (default 10000)")->check(kEpisodes);
  app->add_option("--first-seed", options->campaign.first_seed, "of the scripts (default 10000)")
      ->check(kSeed);
  app->add_option("--jobs", options->campaign.isolation.jobs, "processes at a time (default: one per core)")
      ->check(CLI::PositiveNumber);
  app->add_option("--scenarios", options->scenarios, "shipped names or folders")->delimiter(',');
  options->common.out_named =
      app->add_option("--out", options->common.out, "folder for JSON and the failing script");
  app->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  CLI::Option* const seed =
      app->add_option("--seed", options->common.seed, "only this one, with its story")->check(kSeed);
  CLI::Option* const script = app->add_option("--script", options->script, "only the one in this file");
  seed->excludes(script);
  return {app, [options, seed, script] {
            const faults::Scenarios scenarios = load(*options);
            if (script->count() > 0) {
              const std::string text = scenario::whole_file(options->script, kScriptBytes);
              return judge_one(scenarios, faults::parse_script(text, options->script));
            }
            if (seed->count() == 0) {
              const OwnFolder folder = options->common.choose_out();
              return judge_many(*options, scenarios);
            }
            std::vector<std::string> names;
            for (const auto& [name, scenario] : scenarios) names.push_back(name);
            return judge_one(scenarios, faults::make_script(options->common.seed, names));
          }};
}

}  // namespace s4tp::commands
