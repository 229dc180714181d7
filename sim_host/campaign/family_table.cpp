#include "sim_host/campaign/family_table.hpp"

#include <cstdio>
#include <string>

#include "sim_host/campaign/families.hpp"

namespace s4tp::campaign {
namespace {

std::string driver_words(const Cell& cell) {
  return cell.planner + (cell.guarded ? ", guarded" : ", bare");
}

std::string world_words(const Cell& cell) {
  return cell.flavour + " flavour, " + cell.traffic + " traffic, " + cell.perception + " perception";
}

void print_results(std::ostream& out, const std::vector<FamilyResult>& families) {
  char line[300];
  std::string shown;
  for (const FamilyResult& family : families) {
    const std::string head = driver_words(family.like) + ", " + world_words(family.like);
    if (head != shown) {
      std::snprintf(line, sizeof line, "%-20s%6s%11s%17s%7s%13s%5s%5s%12s%9s%9s%8s\n", "", "roads", "goal",
                    "95 % by road", "deff", "hits (ours)", "off", "late", "mean s, 80", "near m.", "|jerk|",
                    "RSS %");
      out << "\n== " << head << '\n' << line;
      shown = head;
    }
    const metrics::Summary& s = family.summary;
    const std::string goals = std::to_string(s.success.count) + '/' + std::to_string(s.episodes);
    const std::string hits =
        std::to_string(s.collision.count) + " (" + std::to_string(s.at_fault.count) + ')';
    char interval[40];
    std::snprintf(interval, sizeof interval, "%.1f..%.1f %%", 100.0 * family.interval.low,
                  100.0 * family.interval.high);
    std::snprintf(line, sizeof line, "%-20.19s%6d%11s%17s%7.2f%13s%5d%5d%12.2f%9.2f%9.2f%8.1f\n",
                  family.like.scenario.c_str(), family.roads, goals.c_str(), interval, family.design_effect,
                  hits.c_str(), s.off_road.count, s.time_out.count + s.dead_ecu.count,
                  family.restricted_mean_s, s.near_misses, s.mean_abs_jerk_mps3,
                  100.0 * s.rss_violation_share);
    out << line;
  }
}

void print_pairs(std::ostream& out, const std::vector<FamilyPair>& pairs) {
  char line[300];
  std::string shown;
  for (const FamilyPair& pair : pairs) {
    const std::string head =
        driver_words(pair.first) + " beside " + driver_words(pair.second) + ", " + world_words(pair.first);
    if (head != shown) {
      std::snprintf(line, sizeof line, "%-20s%7s%10s%10s%11s%20s%15s%22s\n", "", "pairs", "only 1st",
                    "only 2nd", "McNemar p", "1st loses, at most", "ours 1st, 2nd", "mean s, 80: 1st, 2nd");
      out << "\n== " << head << ", on the same episodes: who fails\n" << line;
      shown = head;
    }
    std::snprintf(line, sizeof line, "%-20.19s%7d%10d%10d%11.4f%18.2f %%%9d%6d%13.2f%9.2f\n",
                  pair.first.scenario.c_str(), pair.paired.pairs, pair.paired.only_first_fails,
                  pair.paired.only_second_fails, metrics::mcnemar_p(pair.paired), 100.0 * pair.upper,
                  pair.first_at_fault, pair.second_at_fault, pair.first_restricted_mean_s,
                  pair.second_restricted_mean_s);
    out << line;
  }
}

}  // namespace

void print_families(std::ostream& out, const std::vector<CellResult>& cells) {
  print_results(out, by_family(cells));
  print_pairs(out, pair_families(cells));
  out << "\n95 % by road: Wilson's interval, the episodes divided by deff, the design effect of roads\n"
         "mean s, 80: time to the goal, a failure counting 80 s\n"
         "loses, at most: upper end of the 95 % interval of the loss of goals, clustered by road\n";
}

}  // namespace s4tp::campaign
