#include "sim_host/campaign/table.hpp"

#include <algorithm>

#include "sim_host/campaign/compare.hpp"
#include "sim_host/world/scenario/format.hpp"

namespace s4tp::campaign {
namespace {

using scenario::format;

using Cells = std::vector<const CellResult*>;

/// Cells that differ in planner and scenario only.
std::string group_of(const Cell& cell) {
  return cell.flavour + " flavour, " + cell.traffic + " traffic, " + cell.perception + " perception, " +
         (cell.guarded ? "guarded" : "bare");
}

template <class Key>
std::vector<std::string> distinct(const Cells& cells, const Key& key) {
  std::vector<std::string> values;
  for (const CellResult* const cell : cells) {
    const std::string value = key(*cell);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

Cells with_episodes(const std::vector<CellResult>& cells) {
  Cells some;
  for (const CellResult& cell : cells) {
    if (!cell.episodes.empty()) some.push_back(&cell);
  }
  return some;
}

template <class Predicate>
Cells those(const Cells& cells, const Predicate& predicate) {
  Cells some;
  std::copy_if(cells.begin(), cells.end(), std::back_inserter(some),
               [&](const CellResult* cell) { return predicate(*cell); });
  return some;
}

std::string planner_of(const CellResult& cell) {
  return cell.cell.planner;
}
std::string scenario_of(const CellResult& cell) {
  return cell.cell.scenario;
}

void print_paper(std::ostream& out, const Cells& group) {
  const std::vector<std::string> scenarios = distinct(group, scenario_of);
  out << format("%-20s", "planner");
  for (const std::string& scenario : scenarios) out << format(" %24.24s", scenario.c_str());
  out << format("%8s\n", "all %");
  for (const std::string& planner : distinct(group, planner_of)) {
    out << format("%-20.20s", planner.c_str());
    int goals = 0;
    int episodes = 0;
    for (const std::string& scenario : scenarios) {
      const Cells one = those(group, [&](const CellResult& cell) {
        return cell.cell.planner == planner && cell.cell.scenario == scenario;
      });
      if (one.empty()) {
        out << format(" %24s", "-");
        continue;
      }
      const metrics::Summary& s = one.front()->summary;
      goals += s.success.count;
      episodes += s.episodes;
      out << format(
          " %24s",
          format("%.1f / %.1f / %.3g", 100.0 * s.comp1_success, s.comp1_time, s.comp1_humanness).c_str());
    }
    out << format("%8.2f\n", 100.0 * goals / std::max(episodes, 1));
  }
}

void print_details(std::ostream& out, const Cells& group) {
  out << format("%-20s%-24s%9s%17s%12s%14s%5s%5s%10s%9s%9s%9s%8s%8s%9s%7s%7s%9s\n", "planner", "scenario",
                "goal", "95 % interval", "in time", "hits (ours)", "off", "late", "to goal s", "TTC p05",
                "near m.", "|jerk|", "brake", "RSS %", "PET<1.5%", "imp>2%", "imp>3%", "pressed%");
  for (const CellResult* const cell : group) {
    const metrics::Summary& s = cell->summary;
    out << format(
        "%-20.19s%-24.23s%9s%17s%12s%14s%5d%5d%10.1f%9.2f%9.2f%9.2f%8.1f%8.1f%9.1f%7.1f%7.1f%9.1f\n",
        cell->cell.planner.c_str(), cell->cell.scenario.c_str(),
        format("%d/%d", s.success.count, s.episodes).c_str(),
        format("%.1f..%.1f %%", 100.0 * s.success.interval.low, 100.0 * s.success.interval.high).c_str(),
        format("%d in %.0f s", s.in_time.count, s.in_time_s).c_str(),
        format("%d (%d)", s.collision.count, s.at_fault.count).c_str(), s.off_road.count,
        s.time_out.count + s.dead_ecu.count, s.seconds_to_goal, s.min_ttc_s_p05, s.near_misses,
        s.mean_abs_jerk_mps3, s.hardest_braking_mps2, 100.0 * s.rss_violation_share,
        100.0 * s.close_encroachment.share, 100.0 * s.imposed_over_2.share, 100.0 * s.imposed_over_3.share,
        100.0 * s.pressed.share);
  }
}

}  // namespace

void print_table(std::ostream& out, const std::vector<CellResult>& cells) {
  const Cells all = with_episodes(cells);
  for (const std::string& name : distinct(all, [](const CellResult& cell) { return group_of(cell.cell); })) {
    const Cells group = those(all, [&](const CellResult& cell) { return group_of(cell.cell) == name; });
    out << "\n== " << name << "\nsuccess % / time [0.1 s steps + m] / humanness, as the competition counts\n";
    print_paper(out, group);
    out << '\n';
    print_details(out, group);
  }
}

void print_paired(std::ostream& out, const std::vector<CellResult>& cells) {
  const Cells all = with_episodes(cells);
  const std::vector<std::string> planners = distinct(all, planner_of);
  if (planners.size() < 2) return;
  std::vector<Outcomes> outcomes;
  for (const CellResult* const cell : all) outcomes.push_back(outcomes_of(*cell));
  for (std::size_t i = 1; i < planners.size(); ++i) {
    out << '\n';
    print_comparison(out, pair_up(outcomes, planners[0], outcomes, planners[i]), planners[0], planners[i]);
  }
}

std::size_t print_failures(std::ostream& out, const std::vector<CellResult>& cells, std::size_t limit,
                           const std::function<std::string(const Cell&, std::uint64_t)>& command) {
  std::size_t count = 0;
  for (const CellResult& cell : cells) {
    for (const metrics::EpisodeMetrics& episode : cell.episodes) {
      if (episode.ending == traffic::Ending::kGoal || ++count > limit) continue;
      const char* const whose = episode.collisions_at_fault > 0 ? " (ours)" : "";
      out << format("%7.2f s  %-26s  ", episode.duration_s, (episode.cause + whose).c_str())
          << command(cell.cell, episode.seed) << '\n';
    }
  }
  return count;
}

}  // namespace s4tp::campaign
