#include "sim_host/metrics/traffic_figures.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

namespace s4tp::metrics {
namespace {

constexpr double kShortPet_s = 1.0;
constexpr std::array kManoeuvres{Manoeuvre::kLeftTurn, Manoeuvre::kStraight, Manoeuvre::kRightTurn,
                                 Manoeuvre::kMerge};

double share_below(const std::vector<double>& values, double limit) {
  const auto below = std::count_if(values.begin(), values.end(), [&](double v) { return v < limit; });
  return values.empty() ? 0.0 : static_cast<double>(below) / static_cast<double>(values.size());
}

double per_hour(double count, double seconds) {
  return seconds > 0.0 ? 3600.0 * count / seconds : 0.0;
}

template <class Map>
auto of(const Map& map, Manoeuvre manoeuvre) {
  const auto found = map.find(manoeuvre);
  return found != map.end() ? found->second : typename Map::mapped_type{};
}

nlohmann::ordered_json json_of(const std::vector<double>& values) {
  const Distribution d = distribution_of(values);
  return {{"count", d.count}, {"mean", d.mean}, {"p05", d.p05}, {"p25", d.p25},
          {"p50", d.p50},     {"p75", d.p75},   {"p95", d.p95}};
}

std::string number(double value, int digits = 2) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string quantiles(const std::vector<double>& values) {
  if (values.empty()) {
    return "-";
  }
  const Distribution d = distribution_of(values);
  return number(d.p05) + " / " + number(d.p25) + " / **" + number(d.p50) + "** / " + number(d.p75) + " / " +
         number(d.p95) + " (" + std::to_string(d.count) + ")";
}

std::string critical(const std::vector<GapChoice>& choices) {
  const CriticalGap gap = critical_gap(choices);
  return gap.mean_s > 0.0 ? "**" + number(gap.mean_s) + "** +- " + number(gap.deviation_s) + " (" +
                                std::to_string(gap.drivers) + ")"
                          : "- (" + std::to_string(gap.drivers) + ")";
}

struct Row {
  std::string title;
  std::function<std::string(const TrafficRun&)> value;
};

std::vector<Row> rows() {
  std::vector<Row> all{
      {"episodes; vehicles; vehicle-hours",
       [](const TrafficRun& r) {
         return std::to_string(r.episodes) + "; " + std::to_string(r.samples.vehicles) + "; " +
                number(r.samples.vehicle_s / 3600.0);
       }},
      {"throughput, vehicles an hour",
       [](const TrafficRun& r) { return number(per_hour(r.samples.finished, r.samples.observed_s), 0); }},
      {"**own collisions** (per 1000 vehicle-hours)",
       [](const TrafficRun& r) {
         return std::to_string(r.samples.collisions) + " (" +
                number(1000.0 * per_hour(r.samples.collisions, r.samples.vehicle_s), 0) + ")";
       }},
      {"speed, m/s", [](const TrafficRun& r) { return quantiles(r.samples.speeds_mps); }},
      {"headway, s", [](const TrafficRun& r) { return quantiles(r.samples.headways_s); }},
      {"time gap while following, s",
       [](const TrafficRun& r) { return quantiles(r.samples.following_gaps_s); }},
      {"post-encroachment time, s",
       [](const TrafficRun& r) { return quantiles(r.samples.post_encroachment_s); }},
      {"of it below 1 s, %",
       [](const TrafficRun& r) {
         return r.samples.post_encroachment_s.empty()
                    ? std::string("-")
                    : number(100.0 * share_below(r.samples.post_encroachment_s, kShortPet_s), 1);
       }},
      {"lane changes a vehicle-hour",
       [](const TrafficRun& r) { return number(per_hour(r.samples.changes, r.samples.vehicle_s), 1); }},
      {"time gap to the new follower, s",
       [](const TrafficRun& r) { return quantiles(r.samples.change_lags_s); }},
      {"time gap to the new leader, s",
       [](const TrafficRun& r) { return quantiles(r.samples.change_leads_s); }},
      {"gaps accepted, s", [](const TrafficRun& r) { return quantiles(r.samples.accepted_s); }},
      {"gaps rejected, s", [](const TrafficRun& r) { return quantiles(r.samples.rejected_s); }}};
  for (const Manoeuvre manoeuvre : kManoeuvres) {
    std::string name = manoeuvre_name(manoeuvre);
    std::replace(name.begin(), name.end(), '_', ' ');
    all.push_back({"critical gap, " + name + ", s",
                   [manoeuvre](const TrafficRun& r) { return critical(of(r.samples.choices, manoeuvre)); }});
    all.push_back({"wait at the line, " + name + ", s",
                   [manoeuvre](const TrafficRun& r) { return quantiles(of(r.samples.waits_s, manoeuvre)); }});
  }
  all.push_back({"waiting at a line for more than 60 s at the end",
                 [](const TrafficRun& r) { return std::to_string(r.samples.still_waiting); }});
  return all;
}

}  // namespace

nlohmann::ordered_json traffic_json(const std::vector<TrafficRun>& runs) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const TrafficRun& run : runs) {
    const TrafficSamples& s = run.samples;
    nlohmann::ordered_json manoeuvres;
    for (const Manoeuvre manoeuvre : kManoeuvres) {
      const CriticalGap gap = critical_gap(of(s.choices, manoeuvre));
      manoeuvres[manoeuvre_name(manoeuvre)] = {{"critical_gap_s", gap.mean_s},
                                               {"critical_gap_deviation_s", gap.deviation_s},
                                               {"drivers", gap.drivers},
                                               {"inconsistent", gap.inconsistent},
                                               {"wait_s", json_of(of(s.waits_s, manoeuvre))}};
    }
    all.push_back({{"scenario", run.scenario},
                   {"flavour", run.flavour},
                   {"traffic", run.engine},
                   {"episodes", run.episodes},
                   {"vehicles", s.vehicles},
                   {"vehicle_hours", s.vehicle_s / 3600.0},
                   {"throughput_per_h", per_hour(s.finished, s.observed_s)},
                   {"collisions", s.collisions},
                   {"collisions_per_1000_vehicle_h", 1000.0 * per_hour(s.collisions, s.vehicle_s)},
                   {"lane_changes_per_vehicle_h", per_hour(s.changes, s.vehicle_s)},
                   {"speed_mps", json_of(s.speeds_mps)},
                   {"headway_s", json_of(s.headways_s)},
                   {"following_gap_s", json_of(s.following_gaps_s)},
                   {"post_encroachment_s", json_of(s.post_encroachment_s)},
                   {"post_encroachment_below_1_s", share_below(s.post_encroachment_s, kShortPet_s)},
                   {"lane_change_lag_s", json_of(s.change_lags_s)},
                   {"lane_change_lead_s", json_of(s.change_leads_s)},
                   {"gap_accepted_s", json_of(s.accepted_s)},
                   {"gap_rejected_s", json_of(s.rejected_s)},
                   {"manoeuvres", manoeuvres},
                   {"still_waiting", s.still_waiting}});
  }
  return {{"traffic", all}};
}

void write_traffic_tables(std::ostream& out, const std::vector<TrafficRun>& runs) {
  const auto same = [](const TrafficRun& a, const TrafficRun& b) {
    return a.scenario == b.scenario && a.flavour == b.flavour;
  };
  for (std::size_t first = 0; first < runs.size(); ++first) {
    std::vector<const TrafficRun*> columns;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (same(runs[i], runs[first])) {
        if (i < first) {
          break;  // its table has been written
        }
        columns.push_back(&runs[i]);
      }
    }
    if (columns.empty()) {
      continue;
    }
    out << "\n### " << runs[first].scenario << ", " << runs[first].flavour << "\n\n| |";
    for (const TrafficRun* run : columns) {
      out << ' ' << run->engine << " |";
    }
    out << "\n|---|";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      out << "---|";
    }
    out << '\n';
    for (const Row& row : rows()) {
      std::string line;
      bool any = false;
      for (const TrafficRun* run : columns) {
        const std::string value = row.value(*run);
        any = any || (value != "-" && value != "- (0)");
        line += ' ' + value + " |";
      }
      if (any) {
        out << "| " << row.title << " |" << line << '\n';
      }
    }
  }
}

}  // namespace s4tp::metrics
