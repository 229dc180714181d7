#include "sim_host/metrics/traffic_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "sim_host/metrics/junction_statistics.hpp"
#include "sim_host/metrics/road_statistics.hpp"
#include "sim_host/world/judge/journey.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::metrics {
namespace {

void collisions(const traffic::Snapshot& snapshot, std::set<std::pair<int, int>>& known) {
  const std::vector<traffic::CarState>& cars = snapshot.others;
  for (std::size_t a = 0; a < cars.size(); ++a) {
    for (std::size_t b = a + 1; b < cars.size(); ++b) {
      const double reach_m = 0.5 * (cars[a].length_m + cars[b].length_m + cars[a].width_m + cars[b].width_m);
      if (std::hypot(cars[a].centre.x - cars[b].centre.x, cars[a].centre.y - cars[b].centre.y) < reach_m &&
          overlap(box_of(cars[a]), box_of(cars[b]))) {
        known.insert(std::minmax(cars[a].id, cars[b].id));
      }
    }
  }
}

}  // namespace

Distribution distribution_of(std::vector<double> values) {
  Distribution result;
  result.count = values.size();
  if (values.empty()) {
    return result;
  }
  std::sort(values.begin(), values.end());
  for (const double value : values) {
    result.mean += value / static_cast<double>(values.size());
  }
  const auto quantile = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
  };
  result.p05 = quantile(0.05);
  result.p25 = quantile(0.25);
  result.p50 = quantile(0.50);
  result.p75 = quantile(0.75);
  result.p95 = quantile(0.95);
  return result;
}

const char* manoeuvre_name(Manoeuvre manoeuvre) {
  switch (manoeuvre) {
    case Manoeuvre::kLeftTurn:
      return "left_turn";
    case Manoeuvre::kStraight:
      return "straight";
    case Manoeuvre::kRightTurn:
      return "right_turn";
    case Manoeuvre::kMerge:
      break;
  }
  return "merge";
}

void TrafficSamples::add(const TrafficSamples& other) {
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(headways_s, other.headways_s);
  append(following_gaps_s, other.following_gaps_s);
  append(speeds_mps, other.speeds_mps);
  append(rejected_s, other.rejected_s);
  append(accepted_s, other.accepted_s);
  append(change_lags_s, other.change_lags_s);
  append(change_leads_s, other.change_leads_s);
  append(post_encroachment_s, other.post_encroachment_s);
  for (const auto& [manoeuvre, some] : other.choices) {
    append(choices[manoeuvre], some);
  }
  for (const auto& [manoeuvre, some] : other.waits_s) {
    append(waits_s[manoeuvre], some);
  }
  still_waiting += other.still_waiting;
  collisions += other.collisions;
  vehicles += other.vehicles;
  finished += other.finished;
  changes += other.changes;
  observed_s += other.observed_s;
  vehicle_s += other.vehicle_s;
}

TrafficSamples observe_traffic(const map::Network& network, std::span<const traffic::Snapshot> snapshots) {
  TrafficSamples samples;
  if (snapshots.size() < 2) {
    return samples;
  }
  const std::vector<judge::Journey> tracks = judge::journeys_of(network, snapshots);
  const double last_s = snapshots.back().time_s;
  samples.observed_s = last_s - snapshots.front().time_s;
  samples.vehicles = static_cast<int>(tracks.size());
  for (const judge::Journey& track : tracks) {
    samples.vehicle_s += track.points.back().time_s - track.points.front().time_s;
    samples.finished += track.points.back().time_s < last_s - 0.5 * traffic::kSnapshotPeriod_s ? 1 : 0;
  }
  std::set<std::pair<int, int>> touched;
  double next_speed_s = snapshots.front().time_s;
  for (const traffic::Snapshot& snapshot : snapshots) {
    add_following(network, snapshot, samples);
    collisions(snapshot, touched);
    if (snapshot.time_s >= next_speed_s - 0.5 * traffic::kSnapshotPeriod_s) {
      next_speed_s += 1.0;
      for (const traffic::CarState& car : snapshot.others) {
        samples.speeds_mps.push_back(car.speed_mps);
      }
    }
  }
  samples.collisions = static_cast<int>(touched.size());
  add_headways(network, tracks, samples);
  add_junctions(network, tracks, last_s, samples);
  add_lane_changes(network, snapshots, samples);
  return samples;
}

}  // namespace s4tp::metrics
