#include "sim_host/metrics/road_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim_host/world/map/lane_of.hpp"

namespace s4tp::metrics {
namespace {

using map::kNoLane;
using map::Lane;
using map::LaneId;

constexpr double kDetectorLane_m = 20.0;
constexpr double kFollowing_s = 3.0;
constexpr double kSameSpeed_mps = 1.0;
constexpr double kMoving_mps = 3.0;

/// The next car on the same lane ahead and behind a place.
struct Beside {
  const traffic::CarState* car = nullptr;
  double s_m = 0.0;
};
struct Neighbours {
  Beside ahead;
  Beside behind;
};

Neighbours neighbours(const map::Network& network, const traffic::Snapshot& snapshot, LaneId lane, double s_m,
                      int self) {
  Neighbours found;
  for (const traffic::CarState& car : snapshot.others) {
    if (car.lane != lane || car.id == self) {
      continue;
    }
    const double there_m = lane_of(network, lane).centre.project(car.centre).s_m;
    if (there_m >= s_m && (found.ahead.car == nullptr || there_m < found.ahead.s_m)) {
      found.ahead = {&car, there_m};
    } else if (there_m < s_m && (found.behind.car == nullptr || there_m > found.behind.s_m)) {
      found.behind = {&car, there_m};
    }
  }
  return found;
}

double gap_s(const Beside& behind, const Beside& ahead) {
  const double gap_m = ahead.s_m - behind.s_m - 0.5 * (behind.car->length_m + ahead.car->length_m);
  return gap_m / std::max(behind.car->speed_mps, 0.1);
}

const traffic::CarState* find(const traffic::Snapshot& snapshot, int id) {
  const auto car = std::find_if(snapshot.others.begin(), snapshot.others.end(),
                                [&](const traffic::CarState& c) { return c.id == id; });
  return car != snapshot.others.end() ? &*car : nullptr;
}

/// Where a lane ends, a gap beside is rejected when the one who closes it goes past.
GapChoice merge_choice(const map::Network& network, std::span<const traffic::Snapshot> snapshots,
                       std::size_t changed, int self, LaneId from, LaneId to, TrafficSamples& samples) {
  GapChoice choice;
  const auto beside = [&](std::size_t i) -> std::optional<Neighbours> {
    const traffic::CarState* car = find(snapshots[i], self);
    if (car == nullptr || (i < changed && car->lane != from)) {
      return std::nullopt;
    }
    return neighbours(network, snapshots[i], to, lane_of(network, to).centre.project(car->centre).s_m, self);
  };
  const std::optional<Neighbours> taken = beside(changed);
  if (taken && taken->ahead.car != nullptr && taken->behind.car != nullptr) {
    choice.accepted_s = gap_s(taken->behind, taken->ahead);
    samples.accepted_s.push_back(choice.accepted_s);
  }
  std::optional<Neighbours> later = taken;
  for (std::size_t i = changed; i-- > 0 && later;) {
    const std::optional<Neighbours> now = beside(i);
    if (now && now->behind.car != nullptr && now->ahead.car != nullptr && later->ahead.car != nullptr &&
        later->ahead.car->id == now->behind.car->id) {
      const double rejected_s = gap_s(now->behind, now->ahead);
      samples.rejected_s.push_back(rejected_s);
      choice.largest_rejected_s = std::max(choice.largest_rejected_s, rejected_s);
    }
    later = now;
  }
  return choice;
}

}  // namespace

void add_headways(const map::Network& network, const std::vector<judge::Journey>& tracks,
                  TrafficSamples& samples) {
  for (std::size_t id = 0; id < network.lanes.size(); ++id) {
    const Lane& lane = network.lanes[id];
    if (lane.in_junction || lane.centre.length_m() < kDetectorLane_m) {
      continue;
    }
    std::vector<double> passages;
    for (const judge::Journey& track : tracks) {
      const double place_m = 0.5 * lane.centre.length_m() - 0.5 * track.length_m;
      if (const auto time_s = track.time_at(static_cast<LaneId>(id), place_m)) {
        passages.push_back(*time_s);
      }
    }
    std::sort(passages.begin(), passages.end());
    for (std::size_t i = 1; i < passages.size(); ++i) {
      samples.headways_s.push_back(passages[i] - passages[i - 1]);
    }
  }
}

void add_following(const map::Network& network, const traffic::Snapshot& snapshot, TrafficSamples& samples) {
  for (const traffic::CarState& car : snapshot.others) {
    if (car.lane == kNoLane || car.speed_mps <= kMoving_mps) {
      continue;
    }
    const double s_m = lane_of(network, car.lane).centre.project(car.centre).s_m;
    const Beside ahead = neighbours(network, snapshot, car.lane, s_m, car.id).ahead;
    if (ahead.car == nullptr || std::abs(ahead.car->speed_mps - car.speed_mps) > kSameSpeed_mps) {
      continue;
    }
    const double gap_s = (ahead.s_m - s_m - 0.5 * (car.length_m + ahead.car->length_m)) / car.speed_mps;
    if (gap_s < kFollowing_s) {
      samples.following_gaps_s.push_back(gap_s);
    }
  }
}

void add_lane_changes(const map::Network& network, std::span<const traffic::Snapshot> snapshots,
                      TrafficSamples& samples) {
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    for (const traffic::CarState& car : snapshots[i].others) {
      const traffic::CarState* before = find(snapshots[i - 1], car.id);
      if (before == nullptr || before->lane == kNoLane || car.lane == kNoLane || before->lane == car.lane) {
        continue;
      }
      const Lane& from = lane_of(network, before->lane);
      if (car.lane != from.left && car.lane != from.right) {
        continue;
      }
      ++samples.changes;
      const double s_m = lane_of(network, car.lane).centre.project(car.centre).s_m;
      const Neighbours beside = neighbours(network, snapshots[i], car.lane, s_m, car.id);
      if (beside.behind.car != nullptr) {
        samples.change_lags_s.push_back(gap_s(beside.behind, {&car, s_m}));
      }
      if (beside.ahead.car != nullptr) {
        samples.change_leads_s.push_back(gap_s({&car, s_m}, beside.ahead));
      }
      if (from.successors.empty() && !lane_of(network, car.lane).successors.empty()) {  // its lane ends
        samples.choices[Manoeuvre::kMerge].push_back(
            merge_choice(network, snapshots, i, car.id, before->lane, car.lane, samples));
      }
    }
  }
}

}  // namespace s4tp::metrics
