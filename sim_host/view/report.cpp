#include "sim_host/view/report.hpp"

#include <algorithm>

#include "sim_host/view/charts.hpp"
#include "sim_host/view/html.hpp"
#include "sim_host/view/result_tables.hpp"

namespace s4tp::view {
namespace {

using campaign::Cell;
using campaign::ReportedCell;
using metrics::EpisodeMetrics;
using Reported = std::vector<const ReportedCell*>;

/// What is compared with each other stands together.
std::string group_of(const Cell& cell) {
  return cell.flavour + " flavour, " + (cell.traffic == "builtin" ? "built-in" : "SUMO's") + " traffic, " +
         cell.perception + " perception";
}

const char* const kReadMe =
    R"(<p>Every number comes from the recorded state of the world, none from a planner's opinion.
An episode succeeds when our car reaches its goal before the time limit, touches nobody, whoever's fault, and stays on the road; in
time are those goals that it reaches as soon as the scenario asks for. Intervals
are 95 % Wilson score intervals of a rate. Guarded: with the guard behind the planner, and the last fail-safe where nothing passes;
bare: without. Collisions, off road and time-out are counted apart; a collision is ours by a fixed table that asks no planner.
TTC: smallest time to collision when both kept speed and turn, 10 s at most; p05: the 5th percentile of the episodes.
RSS: rho 0.5 s, 2, 5 and 8 m/s².</p>
)";

std::string seeds_of(const nlohmann::ordered_json& header) {
  const auto first = header.at("first_seed").get<std::uint64_t>();
  const auto count = header.at("episodes").get<std::uint64_t>();
  return std::to_string(first) + " to " + std::to_string(first + count - 1);
}

std::string fact(const std::string& value, const std::string& name) {
  return "<div><b>" + escaped(value) + "</b>" + escaped(name) + "</div>";
}

std::string facts(const Report& report) {
  std::size_t failures = 0;
  for (const ReportedCell& cell : report.records.cells) {
    failures += cell.result.episodes.size() - static_cast<std::size_t>(cell.result.summary.success.count);
  }
  std::string html =
      "<div class=\"figures\">" +
      fact(format("%zu of %zu done", report.records.done(), report.records.planned()), "episodes") +
      fact(std::to_string(report.records.cells.size()), "cells: planner, guard, scenario, traffic") +
      fact(std::to_string(failures), "failures") +
      fact(std::to_string(report.replays.size()), "of them with a replay here") + "</div>\n";
  for (const auto& header : report.records.headers) {
    std::string planners;
    for (const std::string planner : header.at("planners"))
      planners += (planners.empty() ? "" : ", ") + planner;
    html += "<p class=\"soft\">" + escaped(planners) + ": seeds " + seeds_of(header) +
            " in every cell; parameters " + format("%08x", header.at("parameters_crc").get<unsigned>()) +
            ", program <code>" + escaped(header.at("build")) + "</code></p>\n";
  }
  for (const std::string& note : report.notes) html += "<p class=\"bad\">" + escaped(note) + "</p>\n";
  return html;
}

std::string section(const std::string& name, const Reported& group) {
  Cells driven;
  for (const ReportedCell* const cell : group) {
    if (!cell->result.episodes.empty()) driven.push_back(&cell->result);
  }
  std::string html = "<section>\n<h2>" + escaped(name) + "</h2>\n";
  const std::string families = family_tables(driven);
  if (!families.empty()) {
    html += "<h3>By family of roads</h3>\n" + families +
            "<p><small>Roads of a family differ in their number only. Intervals: Wilson's with the episodes "
            "divided "
            "by the design effect of roads, and one more road counted that fails every second episode. Loses "
            "at most: "
            "upper end of the 95 % interval of the loss of goals.</small></p>\n";
  } else if (!driven.empty()) {
    html += "<figure class=\"wide\">" + outcome_chart(driven) +
            "</figure>\n<p><small>Left: share that reaches the goal, with its 95 % Wilson interval. Boxes: "
            "the middle half "
            "of the episodes, stroke: the median, line: 5 to 95 %. Full: guarded, hollow: bare. s4tp in "
            "orange. Point at a "
            "line for its numbers.</small></p>\n<h3>As the competition counts</h3>\n" +
            competition_table(driven) +
            "<p><small>success % / time [steps of 0.1 s, and m left to the goal] / humanness; less is better "
            "in the last "
            "two</small></p>\n";
  }
  html += "<h3>Outcomes</h3>\n" + outcome_table(group);
  const std::string paired = families.empty() ? paired_table(driven) : std::string();
  if (!paired.empty()) {
    html += "<h3>Beside the others on the same episodes</h3>\n" + paired +
            "<p><small>better: McNemar's exact test, two-sided, p &lt; 0.05; no worse: the failure rate is "
            "less than 1 "
            "% higher, by the upper end of its 95 % interval (Tango)</small></p>\n";
  }
  return html + "</section>\n";
}

std::string option_list(const char* data, const char* name, const std::vector<std::string>& values) {
  std::string html =
      std::string("<label>") + name + " <select data-filter=\"" + data + "\"><option value=\"\">all</option>";
  for (const std::string& value : values) html += "<option>" + escaped(value) + "</option>";
  return html + "</select></label>\n";
}

void note_value(std::vector<std::string>& values, const std::string& value) {
  if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}

std::string command_of(const campaign::Records& records, const Cell& cell, std::uint64_t seed) {
  for (const auto& header : records.headers) {
    const auto first = header.at("first_seed").get<std::uint64_t>();
    const auto& cells = header.at("cells");
    if (seed >= first && seed - first < header.at("episodes").get<std::uint64_t>() &&
        std::any_of(cells.begin(), cells.end(), [&](const auto& one) { return one.at(0) == cell.planner; })) {
      return campaign::replay_command(header, cell, seed);
    }
  }
  return campaign::replay_command(records.headers.front(), cell, seed);
}

std::string failure_row(const Report& report, const Cell& cell, const EpisodeMetrics& m) {
  std::string replay = "<code>" + escaped(command_of(report.records, cell, m.seed)) + "</code>";
  const auto found = report.replays.find({cell, m.seed});
  if (found != report.replays.end()) {
    const std::string link = (report.replay_folder / found->second.name).generic_string();
    replay = "<a href=\"" + escaped(link) + "\">replay</a> " +
             (found->second.changed.empty() ? "<span class=\"good\">✓ to the same frame</span> "
                                            : "<span class=\"bad\">✗ another drive now</span> ") +
             replay;
  }
  const std::string ending = metrics::ending_name(m.ending);
  return "<tr data-scenario=\"" + escaped(cell.scenario) + "\" data-planner=\"" + escaped(cell.planner) +
         "\" data-guard=\"" + guard_words(cell) + "\" data-ending=\"" + escaped(ending) + "\" data-seed=\"" +
         std::to_string(m.seed) + "\"><td>" + escaped(cell.scenario) + "</td><td class=\"left\">" +
         escaped(cell.planner) + ", " + guard_words(cell) + "</td><td class=\"left\">" +
         escaped(cell.flavour) + ", " + escaped(cell.traffic) + "</td><td>" + std::to_string(m.seed) +
         "</td><td class=\"left\">" + escaped(m.ending == traffic::Ending::kCollision ? m.cause : ending) +
         (m.collisions_at_fault > 0 ? " <b class=\"bad\">ours</b>" : "") +
         (m.collided_standing ? " (we stood)" : "") + "</td><td>" + format("%.2f", m.duration_s) +
         "</td><td class=\"left\">" + replay + "</td></tr>\n";
}

std::string failures(const Report& report) {
  std::vector<std::string> scenarios;
  std::vector<std::string> planners;
  std::vector<std::string> endings;
  std::string body;
  std::size_t count = 0;
  std::size_t same = 0;
  for (const auto& [key, file] : report.replays) same += file.changed.empty() ? 1 : 0;
  for (const ReportedCell& cell : report.records.cells) {
    for (const EpisodeMetrics& episode : cell.result.episodes) {
      if (episode.ending == traffic::Ending::kGoal) continue;
      ++count;
      note_value(scenarios, cell.result.cell.scenario);
      note_value(planners, cell.result.cell.planner);
      note_value(endings, metrics::ending_name(episode.ending));
      body += failure_row(report, cell.result.cell, episode);
    }
  }
  if (count == 0) return "<h2>Failures</h2>\n<p>None.</p>\n";
  const std::size_t replays = report.replays.size();
  return "<section>\n<h2>Failures</h2>\n<p id=\"replays\">" +
         format(
             "%zu failures; %zu have a replay here, driven again from their seeds, %zu of which came out to "
             "the same frame "
             "and the last bit of every number recorded. %zu are left to their command.",
             count, replays, same, count - replays) +
         "</p>\n<p class=\"controls\">" + option_list("scenario", "scenario", scenarios) +
         option_list("planner", "planner", planners) + option_list("guard", "guard", {"guarded", "bare"}) +
         option_list("ending", "ended", endings) + "<span id=\"shown\" class=\"soft\"></span></p>\n" +
         "<div class=\"wide\"><table id=\"failures\"><thead><tr><th>scenario</th><th "
         "class=\"left\">planner</th><th "
         "class=\"left\">flavour, traffic</th><th>seed</th><th class=\"left\">how it ended</th><th>after, "
         "s</th><th "
         "class=\"left\">see it</th></tr></thead><tbody>\n" +
         body + "</tbody></table></div>\n</section>\n";
}

std::string gallery(const Report& report, const std::filesystem::path& folder) {
  std::string html;
  for (const ReportedCell& cell : report.records.cells) {
    std::string pictures;
    for (const EpisodeMetrics& episode : cell.result.episodes) {
      const Cell& who = cell.result.cell;
      const std::string picture = picture_name(who.scenario, who.planner, episode.seed);
      if (!std::filesystem::exists(folder / picture)) continue;
      const bool good = episode.ending == traffic::Ending::kGoal;
      pictures += "<figure><a href=\"" + picture + "\"><img loading=\"lazy\" alt=\"\" src=\"" + picture +
                  "\"></a><figcaption>seed " + std::to_string(episode.seed) + ": <span class=\"" +
                  (good ? "good" : "bad") + "\">" + metrics::ending_name(episode.ending) + "</span>" +
                  format(" after %.1f s", episode.duration_s) + "</figcaption></figure>\n";
    }
    if (!pictures.empty()) {
      html += "<h3>" + escaped(campaign::words(cell.result.cell)) + "</h3>\n<div class=\"gallery\">\n" +
              pictures + "</div>\n";
    }
  }
  return html.empty() ? html
                      : "<section>\n<h2>Every episode at its tensest moment</h2>\n<p>Orange the plan, blue "
                        "the predictions, "
                        "red haze the driving risk field.</p>\n" +
                            html + "</section>\n";
}

}  // namespace

std::string picture_name(const std::string& scenario, const std::string& planner, std::uint64_t seed) {
  return scenario + "_" + planner + "_" + std::to_string(seed) + ".svg";
}

void write_report(const Report& report, const std::filesystem::path& folder) {
  Page page;
  page.title = "s4tp: how it drove";
  page.body = "<h1>s4tp: how it drove</h1>\n" + facts(report) + kReadMe;
  std::vector<std::string> groups;
  for (const ReportedCell& cell : report.records.cells) note_value(groups, group_of(cell.result.cell));
  for (const std::string& name : groups) {
    Reported group;
    for (const ReportedCell& cell : report.records.cells) {
      if (group_of(cell.result.cell) == name) group.push_back(&cell);
    }
    page.body += section(name, group);
  }
  page.body += failures(report) + gallery(report, folder);
  page.scripts = {kReportJs};
  write_page(page, folder / "index.html");
}

}  // namespace s4tp::view
