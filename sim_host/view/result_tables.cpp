#include "sim_host/view/result_tables.hpp"

#include <algorithm>

#include "sim_host/campaign/compare.hpp"
#include "sim_host/campaign/families.hpp"
#include "sim_host/metrics/paired.hpp"
#include "sim_host/view/html.hpp"

namespace s4tp::view {
namespace {

using campaign::Cell;
using campaign::CellResult;
using Words = std::vector<std::string>;

std::string row(const Words& cells, const char* tag = "td") {
  std::string html = "<tr>";
  for (const std::string& cell : cells) html += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  return html + "</tr>\n";
}

std::string table(const std::string& id, const Words& head, const std::string& body) {
  return "<div class=\"wide\"><table" + (id.empty() ? id : " class=\"" + id + "\"") + "><thead>" +
         row(head, "th") + "</thead><tbody>\n" + body + "</tbody></table></div>\n";
}

std::string percent(double share) {
  return format("%.1f", 100.0 * share);
}

/// "5.0 [2.2, 11.2]"
std::string with_interval(const metrics::Rate& rate) {
  return percent(rate.share) + " <small>[" + percent(rate.interval.low) + ", " + percent(rate.interval.high) +
         "]</small>";
}

template <class Key>
Words distinct(const Cells& cells, const Key& key) {
  Words values;
  for (const CellResult* const cell : cells) {
    const std::string value = key(cell->cell);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

std::string driver(const Cell& cell) {
  return escaped(cell.planner) + ", " + guard_words(cell);
}

}  // namespace

std::string guard_words(const Cell& cell) {
  return cell.guarded ? "guarded" : "bare";
}

std::string competition_table(const Cells& cells) {
  const Words scenarios = distinct(cells, [](const Cell& cell) { return cell.scenario; });
  Words head{"driver"};
  for (const std::string& scenario : scenarios) head.push_back(escaped(scenario));
  head.emplace_back("all: success %");
  std::string body;
  for (const std::string& who : distinct(cells, driver)) {
    Words line{who};
    int goals = 0;
    int episodes = 0;
    for (const std::string& scenario : scenarios) {
      const auto one = std::find_if(cells.begin(), cells.end(), [&](const CellResult* cell) {
        return driver(cell->cell) == who && cell->cell.scenario == scenario;
      });
      if (one == cells.end()) {
        line.emplace_back("–");
        continue;
      }
      const metrics::Summary& s = (*one)->summary;
      goals += s.success.count;
      episodes += s.episodes;
      line.push_back(
          format("<b>%.1f</b> / %.1f / %.3g", 100.0 * s.comp1_success, s.comp1_time, s.comp1_humanness));
    }
    line.push_back(format("<b>%.1f</b>", 100.0 * goals / std::max(episodes, 1)));
    body += row(line);
  }
  return table("competition", head, body);
}

std::string outcome_table(const std::vector<const campaign::ReportedCell*>& cells) {
  std::string body;
  for (const campaign::ReportedCell* const cell : cells) {
    const CellResult& result = cell->result;
    const metrics::Summary& s = result.summary;
    Words line{escaped(result.cell.scenario), escaped(result.cell.planner), guard_words(result.cell),
               format("%d of %zu", s.episodes, cell->planned)};
    if (s.episodes > 0) {
      line.insert(line.end(), {"<b>" + percent(s.success.share) + "</b>",
                               percent(s.success.interval.low) + " – " + percent(s.success.interval.high),
                               percent(s.in_time.share) + format(" <small>in %.0f s</small>", s.in_time_s),
                               with_interval(s.collision),
                               with_interval(s.at_fault),
                               with_interval(s.off_road),
                               with_interval(s.time_out),
                               percent(s.dead_ecu.share),
                               s.success.count > 0 ? format("%.2f", s.seconds_to_goal) : "–",
                               format("%.2f", s.min_ttc_s_p05),
                               format("%.2f", s.min_gap_m),
                               format("%.2f", s.near_misses),
                               percent(s.close_encroachment.share),
                               format("%.2f", s.imposed_braking_mps2),
                               percent(s.imposed_over_2.share),
                               percent(s.imposed_over_3.share),
                               percent(s.pressed.share),
                               format("%.2f", s.mean_abs_jerk_mps3),
                               format("%.2f", s.hardest_braking_mps2),
                               percent(s.rss_violation_share),
                               percent(s.comp1_success),
                               format("%.1f", s.comp1_time),
                               format("%.3g", s.comp1_humanness)});
    }
    body += row(line);
  }
  return table("outcomes",
               {"scenario",
                "planner",
                "guard",
                "episodes done",
                "goal<br>%",
                "95 % interval<br>%",
                "in time<br>%",
                "collisions<br>%",
                "through our fault<br>%",
                "off road<br>%",
                "time-out<br>%",
                "silent ECU<br>%",
                "to goal, mean<br>s",
                "min. TTC, p05<br>s",
                "smallest gap<br>m",
                "near misses<br>an episode",
                "PET below 1.5 s<br>%",
                "imposed braking<br>m/s²",
                "over 2 m/s²<br>%",
                "over 3 m/s²<br>%",
                "pressed, below 1.5 s<br>%",
                "mean |jerk|<br>m/s³",
                "hardest braking<br>m/s²",
                "nearer than RSS<br>% of time",
                "competition:<br>success %",
                "time<br>0.1 s + m",
                "human-<br>ness"},
               body);
}

std::string paired_table(const Cells& cells) {
  std::vector<campaign::Outcomes> outcomes;
  for (const CellResult* const cell : cells) outcomes.push_back(campaign::outcomes_of(*cell));
  std::string body;
  for (const std::string& other : distinct(cells, [](const Cell& cell) { return cell.planner; })) {
    if (other == "s4tp") continue;
    for (const auto& [cell, paired] : campaign::pair_up(outcomes, "s4tp", outcomes, other)) {
      body += row({escaped(words(cell)), escaped(other), std::to_string(paired.pairs),
                   std::to_string(paired.only_first_fails), std::to_string(paired.only_second_fails),
                   format("%.4f", metrics::mcnemar_p(paired)),
                   format("%+.2f", 100.0 * metrics::difference_upper(paired)), campaign::verdict(paired)});
    }
  }
  if (body.empty()) return {};
  return table("paired",
               {"s4tp", "beside", "same episodes", "only s4tp fails", "only the other fails", "McNemar p",
                "upper bound<br>of the difference, %", "s4tp is"},
               body);
}

std::string family_tables(const Cells& cells) {
  std::vector<CellResult> results;
  for (const CellResult* const cell : cells) results.push_back(*cell);
  if (!campaign::has_families(results)) return {};
  std::string families;
  for (const campaign::FamilyResult& family : campaign::by_family(results)) {
    const metrics::Summary& s = family.summary;
    families += row({escaped(family.like.scenario), driver(family.like), std::to_string(family.roads),
                     std::to_string(s.episodes), "<b>" + percent(s.success.share) + "</b>",
                     percent(family.interval.low) + " – " + percent(family.interval.high),
                     format("%.2f", family.design_effect), std::to_string(s.collision.count),
                     std::to_string(s.at_fault.count), std::to_string(s.off_road.count),
                     std::to_string(s.time_out.count), format("%.2f", family.restricted_mean_s)});
  }
  std::string pairs;
  for (const campaign::FamilyPair& pair : campaign::pair_families(results)) {
    pairs +=
        row({escaped(pair.first.scenario), driver(pair.first), driver(pair.second),
             std::to_string(pair.paired.pairs), std::to_string(pair.paired.only_first_fails),
             std::to_string(pair.paired.only_second_fails), format("%.4f", metrics::mcnemar_p(pair.paired)),
             format("%+.2f", 100.0 * pair.upper), format("%d, %d", pair.first_at_fault, pair.second_at_fault),
             format("%.2f, %.2f", pair.first_restricted_mean_s, pair.second_restricted_mean_s)});
  }
  std::string tables =
      table("families",
            {"family", "driver", "roads", "episodes", "goal<br>%", "95 %, by road<br>%", "design effect",
             "collisions", "through our fault", "off road", "time-out", "to goal, a failure<br>counts 80 s"},
            families);
  if (!pairs.empty()) {
    tables += table("family_pairs",
                    {"family", "1st", "2nd", "same episodes", "only 1st fails", "only 2nd fails", "McNemar p",
                     "1st loses at most<br>%, by road", "own collisions<br>1st, 2nd",
                     "to goal, a failure<br>counts 80 s"},
                    pairs);
  }
  return tables;
}

}  // namespace s4tp::view
