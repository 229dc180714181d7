#include "sim_host/campaign/compare.hpp"

#include <cstdio>
#include <set>
#include <stdexcept>

#include "sim_host/campaign/record_limits.hpp"

namespace s4tp::campaign {
namespace {

void count(const Outcomes& first, const Outcomes& second, metrics::Paired& paired) {
  for (const auto& [seed, failed] : first.failed) {
    const auto other = second.failed.find(seed);
    if (other == second.failed.end()) continue;
    ++paired.pairs;
    if (failed && !other->second) ++paired.only_first_fails;
    if (!failed && other->second) ++paired.only_second_fails;
  }
}

}  // namespace

const char* verdict(const metrics::Paired& paired) {
  const metrics::Paired swapped{paired.pairs, paired.only_second_fails, paired.only_first_fails};
  if (metrics::first_is_better(paired)) return "better";
  if (metrics::first_is_better(swapped)) return "worse";
  return metrics::first_is_no_worse(paired) ? "no worse" : "open";
}

Outcomes outcomes_of(const CellResult& cell) {
  Outcomes outcomes{cell.cell, {}};
  for (const metrics::EpisodeMetrics& episode : cell.episodes) {
    outcomes.failed[episode.seed] = episode.ending != traffic::Ending::kGoal;
  }
  return outcomes;
}

std::vector<Outcomes> outcomes_of(const nlohmann::ordered_json& document) {
  std::vector<Outcomes> all;
  std::set<Cell> known;
  const std::uint64_t first_seed =
      whole_number(document.at("first_seed"), "first_seed", 0, kSeedMax - kEpisodesMax);
  const std::uint64_t per_run =
      whole_number(document.at("episodes_per_run"), "episodes_per_run", 1, kEpisodesMax);
  for (const auto& run : document.at("runs")) {
    Outcomes outcomes;
    outcomes.cell = {run.at("planner"), run.at("scenario"), run.at("flavour"),
                     run.at("traffic"), run.at("guarded"),  run.at("perception")};
    if (run.at("episodes") != per_run) {
      throw std::runtime_error(words(outcomes.cell) + ": " + run.at("episodes").dump() + " of " +
                               std::to_string(per_run) + " episodes done; only whole runs can be compared");
    }
    if (known.size() * per_run >= kComparedMax) {
      throw std::runtime_error("more than " + std::to_string(kComparedMax) + " episodes");
    }
    if (!known.insert(outcomes.cell).second) {
      throw std::runtime_error(words(outcomes.cell) + " is there twice: its episodes would count double");
    }
    for (std::uint64_t i = 0; i < per_run; ++i) outcomes.failed[first_seed + i] = false;
    for (const auto& failure : run.at("failures")) {
      outcomes.failed[whole_number(failure.at("seed"), "seed of a failure", first_seed,
                                   first_seed + per_run - 1)] = true;
    }
    all.push_back(std::move(outcomes));
  }
  return all;
}

std::vector<ComparedCell> pair_up(const std::vector<Outcomes>& first, const std::string& first_planner,
                                  const std::vector<Outcomes>& second, const std::string& second_planner) {
  struct Group {  // cells that differ in scenario only
    Cell like;
    std::vector<ComparedCell> cells;
    metrics::Paired all;
  };
  std::vector<Group> groups;
  for (const Outcomes& one : first) {
    if (!first_planner.empty() && one.cell.planner != first_planner) continue;
    Cell partner = one.cell;
    if (!second_planner.empty()) partner.planner = second_planner;
    for (const Outcomes& other : second) {
      metrics::Paired paired;
      if (other.cell == partner) count(one, other, paired);
      if (paired.pairs == 0) continue;
      Cell like = one.cell;
      like.scenario = "all scenarios";
      if (groups.empty() || groups.back().like != like) groups.push_back({like, {}, {}});
      Group& group = groups.back();
      group.cells.push_back({one.cell, paired});
      group.all.pairs += paired.pairs;
      group.all.only_first_fails += paired.only_first_fails;
      group.all.only_second_fails += paired.only_second_fails;
    }
  }
  std::vector<ComparedCell> compared;
  for (Group& group : groups) {
    if (group.cells.size() > 1) group.cells.push_back({group.like, group.all});
    compared.insert(compared.end(), group.cells.begin(), group.cells.end());
  }
  return compared;
}

nlohmann::ordered_json comparison_json(const std::vector<ComparedCell>& cells) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& [cell, paired] : cells) {
    list.push_back({{"planner", cell.planner},
                    {"scenario", cell.scenario},
                    {"flavour", cell.flavour},
                    {"traffic", cell.traffic},
                    {"guarded", cell.guarded},
                    {"perception", cell.perception},
                    {"pairs", paired.pairs},
                    {"only_first_fails", paired.only_first_fails},
                    {"only_second_fails", paired.only_second_fails},
                    {"mcnemar_p", metrics::mcnemar_p(paired)},
                    {"difference_upper", metrics::difference_upper(paired)},
                    {"first_is", verdict(paired)}});
  }
  return list;
}

void print_comparison(std::ostream& out, const std::vector<ComparedCell>& cells, const std::string& first,
                      const std::string& second) {
  out << first << " against " << second
      << " on the same episodes (better: McNemar p < 0.05; no worse: failure rates differ by less than 1 "
         "%)\n";
  char line[200];
  std::snprintf(line, sizeof line, "%-56s%7s%16s%16s%11s%13s  %s\n", "", "pairs", "only 1st fails",
                "only 2nd fails", "McNemar p", "upper bound", "1st is");
  out << line;
  for (const ComparedCell& cell : cells) {
    std::snprintf(line, sizeof line, "%-56.55s%7d%16d%16d%11.4f%11.2f %%  %s\n", words(cell.cell).c_str(),
                  cell.paired.pairs, cell.paired.only_first_fails, cell.paired.only_second_fails,
                  metrics::mcnemar_p(cell.paired), 100.0 * metrics::difference_upper(cell.paired),
                  verdict(cell.paired));
    out << line;
  }
}

}  // namespace s4tp::campaign
