#include "sim_host/campaign/results.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "algo/core/versions.hpp"

namespace s4tp::campaign {
namespace {

using nlohmann::json;

json to_json(const metrics::Summary& sum) {
  return {{"episodes", sum.episodes},
          {"goals", sum.goals},
          {"success_wilson_95", {sum.success.low, sum.success.high}},
          {"with_collision", sum.with_collision},
          {"with_own_fault", sum.with_own_fault},
          {"with_competition_box_collision", sum.with_competition_box_collision},
          {"off_road", sum.off_road},
          {"time_out", sum.time_out},
          {"dead_ecu", sum.dead_ecu},
          {"seconds_to_goal", sum.seconds_to_goal},
          {"mean_abs_jerk_mps3", sum.mean_abs_jerk_mps3},
          {"min_gap_m", sum.min_gap_m},
          {"median_min_ttc_s", sum.median_min_ttc_s},
          {"rss_violation_share", sum.rss_violation_share},
          {"comp1_time", sum.comp1_time},
          {"comp1_humanness", sum.comp1_humanness}};
}

json to_json(const EpisodeRow& row) {
  const metrics::EpisodeMetrics& m = row.metrics;
  return {{"scenario", row.scenario},
          {"planner", row.planner},
          {"seed", m.seed},
          {"ending", metrics::ending_name(m.ending)},
          {"redrawn", m.redrawn},
          {"collisions_at_fault", m.collisions_at_fault},
          {"collisions_other_fault", m.collisions_other_fault},
          {"collisions_competition_box", m.collisions_competition_box},
          {"duration_s", m.duration_s},
          {"mean_abs_jerk_mps3", m.mean_abs_jerk_mps3},
          {"hardest_braking_mps2", m.hardest_braking_mps2},
          {"min_gap_m", m.min_gap_m},
          {"mean_gap_m", m.mean_gap_m},
          {"min_time_to_collision_s", m.min_time_to_collision_s},
          {"rss_violation_share", m.rss_violation_share},
          {"comp1",
           {{"success", m.comp1.success},
            {"steps", m.comp1.steps},
            {"goal_distance_m", m.comp1.goal_distance_m},
            {"jerk_linear", m.comp1.jerk_linear},
            {"jerk_angular", m.comp1.jerk_angular},
            {"lane_centre_offset", m.comp1.lane_centre_offset},
            {"obstacle", m.comp1.obstacle}}}};
}

}  // namespace

std::vector<ResultCell> summarize(const std::vector<EpisodeRow>& rows) {
  std::vector<ResultCell> cells;
  std::vector<std::vector<metrics::EpisodeMetrics>> episodes;
  for (const EpisodeRow& row : rows) {
    auto cell = std::find_if(cells.begin(), cells.end(), [&](const ResultCell& one) {
      return one.planner == row.planner && one.scenario == row.scenario;
    });
    if (cell == cells.end()) {
      cells.push_back({row.planner, row.scenario, {}});
      episodes.emplace_back();
      cell = std::prev(cells.end());
    }
    episodes[static_cast<std::size_t>(cell - cells.begin())].push_back(row.metrics);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].summary = metrics::summarize(episodes[i]);
  return cells;
}

void print_table(std::ostream& out, const std::vector<ResultCell>& cells) {
  out << "planner         scenario       goal      95 % interval  coll. (ours)  off road  time-out   to goal"
         "   |jerk|   comp1 time  humanness\n";
  std::string planner;
  for (const ResultCell& cell : cells) {
    const metrics::Summary& s = cell.summary;
    if (!planner.empty() && planner != cell.planner) out << '\n';
    planner = cell.planner;
    char line[200];
    std::snprintf(
        line, sizeof line,
        "%-15s %-12s %3d/%-3d   %5.1f..%5.1f %%   %3d  (%d)      %3d       %3d     %6.1f s  %5.2f m/s3"
        "  %7.1f  %9.2f\n",
        cell.planner.c_str(), cell.scenario.c_str(), s.goals, s.episodes, 100.0 * s.success.low,
        100.0 * s.success.high, s.with_collision, s.with_own_fault, s.off_road, s.time_out + s.dead_ecu,
        s.seconds_to_goal, s.mean_abs_jerk_mps3, s.comp1_time, s.comp1_humanness);
    out << line;
  }
}

void print_episode(std::ostream& out, const EpisodeRow& row, const world::Recording& recording) {
  const metrics::EpisodeMetrics& m = row.metrics;
  out << row.scenario << " seed " << m.seed << ", " << row.planner << ": " << metrics::ending_name(m.ending)
      << " after " << m.duration_s << " s, smallest gap " << m.min_gap_m << " m, mean |jerk| "
      << m.mean_abs_jerk_mps3 << " m/s^3\n";
  for (const world::Collision& collision : recording.collisions) {
    out << "  at " << collision.time_s << " s: " << collision.cause << " vehicle " << collision.other << '\n';
  }
}

void write_json(const std::filesystem::path& file, const std::vector<EpisodeRow>& rows,
                const CampaignOptions& options, const json* more) {
  json document{{"first_seed", options.first_seed},
                {"episodes_per_cell", options.episodes},
                {"parameters_crc", parameters_crc(options.parameters)},
                {"wire_version", kWireVersion},
                {"cells", json::array()},
                {"episodes", json::array()}};
  for (const ResultCell& cell : summarize(rows)) {
    json entry = to_json(cell.summary);
    entry["planner"] = cell.planner;
    entry["scenario"] = cell.scenario;
    document["cells"].push_back(entry);
  }
  for (const EpisodeRow& row : rows) document["episodes"].push_back(to_json(row));
  if (more != nullptr) document.update(*more);
  std::ofstream stream(file);
  stream << document.dump(1) << '\n';
  if (!stream) throw std::runtime_error(file.string() + ": cannot write the results");
}

}  // namespace s4tp::campaign
