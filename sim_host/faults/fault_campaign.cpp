#include "sim_host/faults/fault_campaign.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim_host/faults/minimizer.hpp"
#include "sim_host/metrics/metrics.hpp"

namespace s4tp::faults {
namespace {

using nlohmann::json;

/// One line of the table.
struct Count {
  int scripts = 0;
  std::array<int, kOutcomes> outcomes{};
  int failed = 0;
  int own_collisions = 0;
  int off_road = 0;

  void add(const RunResult& result) {
    ++scripts;
    if (result.verdict.breach == Breach::kNone) {
      ++outcomes.at(static_cast<std::size_t>(result.verdict.outcome));
    } else {
      ++failed;
    }
    own_collisions += result.own_fault ? 1 : 0;
    off_road += result.ending == traffic::Ending::kOffRoad ? 1 : 0;
  }
};

struct Row {
  std::string name;
  Count count;
};

bool has(const FaultScript& script, FaultKind kind) {
  return std::any_of(script.faults.begin(), script.faults.end(),
                     [kind](const Fault& fault) { return fault.kind == kind; });
}

std::vector<Row> count(const CampaignResult& campaign) {
  std::vector<Row> rows;
  for (int i = 0; i < kFaultKinds; ++i) rows.push_back({traits(static_cast<FaultKind>(i)).name, {}});
  rows.push_back({"no sender lies", {}});
  rows.push_back({"all", {}});
  for (std::size_t i = 0; i < campaign.scripts.size(); ++i) {
    const FaultScript& script = campaign.scripts[i];
    const RunResult& result = campaign.results[i];
    for (int k = 0; k < kFaultKinds; ++k) {
      if (has(script, static_cast<FaultKind>(k))) rows[static_cast<std::size_t>(k)].count.add(result);
    }
    if (honest(script)) rows[kFaultKinds].count.add(result);
    rows.back().count.add(result);
  }
  return rows;
}

}  // namespace

int CampaignResult::failed() const {
  return static_cast<int>(std::count_if(results.begin(), results.end(), [](const RunResult& result) {
    return result.verdict.breach != Breach::kNone;
  }));
}

std::optional<std::size_t> CampaignResult::first_failed() const {
  const auto found = std::find_if(results.begin(), results.end(), [](const RunResult& result) {
    return result.verdict.breach != Breach::kNone;
  });
  if (found == results.end()) return std::nullopt;
  return static_cast<std::size_t>(found - results.begin());
}

CampaignResult run_campaign(const Scenarios& scenarios, const Runner& runner,
                            const CampaignOptions& options) {
  std::vector<std::string> names;
  for (const auto& [name, scenario] : scenarios) names.push_back(name);
  CampaignResult campaign;
  for (int i = 0; i < options.scripts; ++i) {
    campaign.scripts.push_back(make_script(options.first_seed + static_cast<std::uint64_t>(i), names));
  }
  campaign.results.resize(campaign.scripts.size());
  int done = 0;
  int failed = 0;
  run_isolated(campaign.scripts, runner, options.isolation, [&](std::size_t index, const RunResult& result) {
    campaign.results[index] = result;
    ++done;
    failed += result.verdict.breach != Breach::kNone ? 1 : 0;
    if (options.on_progress) options.on_progress(done, failed);
    return true;
  });
  if (const auto first = campaign.first_failed()) {
    const Breach breach = campaign.results[*first].verdict.breach;
    const auto fails = [&](const FaultScript& script) {
      bool same = false;
      run_isolated({script}, runner, options.isolation, [&](std::size_t, const RunResult& result) {
        same = result.verdict.breach == breach;
        return true;
      });
      return same;
    };
    campaign.minimized = minimize(campaign.scripts[*first], fails, options.trials);
  }
  return campaign;
}

void print_table(std::ostream& out, const CampaignResult& campaign) {
  out << "with            scripts    drive  degraded  stopping  stopped  handed over  cut off   FAILED   "
         "our collisions  off road\n";
  for (const Row& row : count(campaign)) {
    const Count& c = row.count;
    char line[160];
    std::snprintf(line, sizeof line, "%-15s %7d  %7d  %8d  %8d  %7d  %11d  %7d  %7d   %14d  %8d\n",
                  row.name.c_str(), c.scripts, c.outcomes[0], c.outcomes[1], c.outcomes[2], c.outcomes[3],
                  c.outcomes[4], c.outcomes[5], c.failed, c.own_collisions, c.off_road);
    out << line;
  }
}

void write_json(const std::filesystem::path& file, const CampaignResult& campaign) {
  json document{{"table", json::array()}, {"scripts", json::array()}};
  for (const Row& row : count(campaign)) {
    json entry{{"with", row.name},
               {"scripts", row.count.scripts},
               {"failed", row.count.failed},
               {"own_collisions", row.count.own_collisions},
               {"off_road", row.count.off_road}};
    for (int i = 0; i < kOutcomes; ++i) {
      entry[outcome_name(static_cast<Outcome>(i))] = row.count.outcomes.at(static_cast<std::size_t>(i));
    }
    document["table"].push_back(entry);
  }
  for (std::size_t i = 0; i < campaign.scripts.size(); ++i) {
    const RunResult& result = campaign.results[i];
    document["scripts"].push_back({{"seed", campaign.scripts[i].seed},
                                   {"scenario", campaign.scripts[i].scenario},
                                   {"outcome", outcome_name(result.verdict.outcome)},
                                   {"breach", breach_name(result.verdict.breach)},
                                   {"what", result.verdict.what},
                                   {"tick", result.verdict.tick},
                                   {"world", metrics::ending_name(result.ending)},
                                   {"own_fault", result.own_fault}});
  }
  if (campaign.minimized) document["minimized"] = to_text(*campaign.minimized);
  std::ofstream stream(file);
  stream << document.dump(1) << '\n';
  if (!stream) throw std::runtime_error(file.string() + ": cannot write the results");
}

}  // namespace s4tp::faults
