#include "sim_host/campaign/results.hpp"

#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/families.hpp"

namespace s4tp::campaign {
namespace {

using nlohmann::ordered_json;

ordered_json pair_of(const metrics::Interval& interval) {
  return {interval.low, interval.high};
}

ordered_json failures_of(const CellResult& result) {
  ordered_json failures = ordered_json::array();
  for (const metrics::EpisodeMetrics& episode : result.episodes) {
    if (episode.ending == traffic::Ending::kGoal) continue;
    failures.push_back({{"seed", episode.seed},
                        {"cause", episode.cause},
                        {"time_s", episode.duration_s},
                        {"ending", metrics::ending_name(episode.ending)},
                        {"at_fault", episode.collisions_at_fault > 0},
                        {"standing", episode.collided_standing}});
  }
  return failures;
}

ordered_json run_json(const CellResult& result) {
  const Cell& cell = result.cell;
  const metrics::Summary& s = result.summary;
  ordered_json run{
      {"planner", cell.planner},
      {"scenario", cell.scenario},
      {"flavour", cell.flavour},
      {"traffic", cell.traffic},
      {"guarded", cell.guarded},
      {"perception", cell.perception},
      {"episodes", s.episodes},
      {"success_rate", s.success.share},
      {"wilson_low", s.success.interval.low},
      {"wilson_high", s.success.interval.high},
      {"in_time_s", s.in_time_s},
      {"in_time_rate", s.in_time.share},
      {"collision_rate", s.collision.share},
      {"at_fault_collision_rate", s.at_fault.share},
      {"off_road_rate", s.off_road.share},
      {"timeout_rate", s.time_out.share},
      {"seconds_to_goal_mean", s.success.count > 0 ? ordered_json(s.seconds_to_goal) : nullptr},
      {"min_ttc_s_p05", s.min_ttc_s_p05},
      {"comp1", {{"success", s.comp1_success}, {"time", s.comp1_time}, {"humanness", s.comp1_humanness}}}};
  run["collision_wilson"] = pair_of(s.collision.interval);
  run["at_fault_collision_wilson"] = pair_of(s.at_fault.interval);
  run["off_road_wilson"] = pair_of(s.off_road.interval);
  run["timeout_wilson"] = pair_of(s.time_out.interval);
  run["dead_ecu_rate"] = s.dead_ecu.share;
  run["competition_box_collision_rate"] = s.competition_box_collision.share;
  run["hit_standing_rate"] = s.hit_standing.share;
  run["collision_causes"] = s.causes;
  run["redrawn"] = s.redrawn;
  run["mean_speed_mps"] = s.mean_speed_mps;
  run["progress_share"] = s.progress_share;
  run["mean_abs_jerk_mps3"] = s.mean_abs_jerk_mps3;
  run["rms_acceleration_mps2"] = s.rms_acceleration_mps2;
  run["hardest_braking_mps2"] = s.hardest_braking_mps2;
  run["max_lateral_mps2"] = s.max_lateral_mps2;
  run["min_gap_m"] = s.min_gap_m;
  run["min_ttc_s_median"] = s.min_ttc_s_median;
  run["near_misses"] = s.near_misses;
  run["close_encroachment_rate"] = s.close_encroachment.share;
  run["close_encroachment_wilson"] = pair_of(s.close_encroachment.interval);
  run["imposed_braking_mps2"] = s.imposed_braking_mps2;
  run["imposed_over_2_rate"] = s.imposed_over_2.share;
  run["imposed_over_2_wilson"] = pair_of(s.imposed_over_2.interval);
  run["imposed_over_3_rate"] = s.imposed_over_3.share;
  run["imposed_over_3_wilson"] = pair_of(s.imposed_over_3.interval);
  run["pressed_rate"] = s.pressed.share;
  run["rss_violation_share"] = s.rss_violation_share;
  run["rss_violations"] = s.rss_violations;
  run["failures"] = failures_of(result);
  return run;
}

}  // namespace

ordered_json results_json(const ordered_json& header, const std::vector<CellResult>& cells) {
  std::size_t done = 0;
  ordered_json runs = ordered_json::array();
  for (const CellResult& cell : cells) {
    done += cell.episodes.size();
    if (!cell.episodes.empty()) runs.push_back(run_json(cell));
  }
  ordered_json document{{"first_seed", header.at("first_seed")},
                        {"episodes_per_run", header.at("episodes")},
                        {"episodes_done", done},
                        {"episodes_planned", planned_episodes(header)},
                        {"parameters_crc", header.at("parameters_crc")},
                        {"wire_version", header.at("wire_version")},
                        {"scenarios", header.at("scenarios")},
                        {"runs", runs}};
  if (has_families(cells)) {
    document["families"] = families_json(by_family(cells));
    document["family_pairs"] = family_pairs_json(pair_families(cells));
  }
  return document;
}

ordered_json results_json(const EpisodeRow& row) {
  return {{"runs", ordered_json::array({run_json(collect({row}).front())})}, {"episode", to_json(row)}};
}

void write_json(const std::filesystem::path& file, const ordered_json& document) {
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  std::ofstream stream(file);
  stream << document.dump(1) << '\n';
  if (!stream.flush()) throw std::runtime_error(file.string() + ": cannot write the results");
}

void print_episode(std::ostream& out, const EpisodeRow& row, const traffic::Recording& recording) {
  const metrics::EpisodeMetrics& m = row.metrics;
  std::ostringstream figures;  // as many digits as are read
  figures << std::fixed << std::setprecision(2) << m.duration_s << " s, smallest gap " << m.min_gap_m
          << " m, smallest time to collision " << m.min_time_to_collision_s << " s, mean |jerk| "
          << m.mean_abs_jerk_mps3 << " m/s^3\n";
  out << words(row.cell) << ", seed " << m.seed << ": " << metrics::ending_name(m.ending) << " after "
      << figures.str();
  for (const traffic::Collision& collision : recording.collisions) {
    out << "  at " << collision.time_s << " s: " << traffic::cause_words(collision.fault, collision.cause)
        << ", vehicle " << collision.other << '\n';
  }
}

}  // namespace s4tp::campaign
