#include "sim_host/metrics/traffic_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "sim_host/metrics/vehicle_tracks.hpp"
#include "sim_host/world/box.hpp"

namespace s4tp::metrics {
namespace {

using world::kNoLane;
using world::LaneId;
using world::NetworkLane;
using world::Rule;

constexpr double kDetectorLane_m = 20.0;
constexpr double kFollowing_s = 3.0;
constexpr double kSameSpeed_mps = 1.0;
constexpr double kMoving_mps = 3.0;
constexpr double kPetMax_s = 10.0;
constexpr double kFirstInLine_m = 15.0;
constexpr double kTurn_rad = 0.6;
constexpr double kStep_s = 0.1;
constexpr double kStuck_s = 60.0;

const NetworkLane& lane_of(const world::Network& network, LaneId id) {
  return network.lanes[static_cast<std::size_t>(id)];
}

void headways(const world::Network& network, const std::vector<VehicleTrack>& tracks,
              TrafficSamples& samples) {
  for (std::size_t id = 0; id < network.lanes.size(); ++id) {
    const NetworkLane& lane = network.lanes[id];
    if (lane.in_junction || lane.centre.length_m() < kDetectorLane_m) {
      continue;
    }
    std::vector<double> passages;
    for (const VehicleTrack& track : tracks) {
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

/// The next car on the same lane ahead and behind a place.
struct Beside {
  const world::CarState* car = nullptr;
  double s_m = 0.0;
};
struct Neighbours {
  Beside ahead;
  Beside behind;
};

Neighbours neighbours(const world::Network& network, const world::Snapshot& snapshot, LaneId lane, double s_m,
                      int self) {
  Neighbours found;
  for (const world::CarState& car : snapshot.others) {
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

void following(const world::Network& network, const world::Snapshot& snapshot, TrafficSamples& samples) {
  for (const world::CarState& car : snapshot.others) {
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

void collisions(const world::Snapshot& snapshot, std::set<std::pair<int, int>>& known) {
  const std::vector<world::CarState>& cars = snapshot.others;
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

void post_encroachment(const world::Network& network, const std::vector<VehicleTrack>& tracks,
                       TrafficSamples& samples) {
  struct Stay {
    double in_s = 0.0;
    double out_s = 0.0;
    bool first_lane = false;
  };
  for (const world::NetworkConflict& zone : network.conflicts) {
    std::vector<Stay> stays;
    for (const VehicleTrack& track : tracks) {
      for (const bool first : {true, false}) {
        const LaneId lane = first ? zone.first : zone.second;
        const auto in_s = track.time_at(lane, first ? zone.first_entry_m : zone.second_entry_m);
        const auto out_s = track.time_at(lane, first ? zone.first_exit_m : zone.second_exit_m);
        if (in_s && out_s) {
          stays.push_back({*in_s, *out_s, first});
        }
      }
    }
    std::sort(stays.begin(), stays.end(), [](const Stay& a, const Stay& b) { return a.in_s < b.in_s; });
    for (std::size_t i = 1; i < stays.size(); ++i) {
      const double pet_s = stays[i].in_s - stays[i - 1].out_s;
      if (stays[i].first_lane != stays[i - 1].first_lane && pet_s < kPetMax_s) {
        samples.post_encroachment_s.push_back(pet_s);
      }
    }
  }
}

/// Ground of a junction somebody has to give way on.
struct YieldZone {
  LaneId own = kNoLane;
  double own_entry_m = 0.0;
  LaneId other = kNoLane;
  double other_entry_m = 0.0;
};

/// Of a way through a junction that begins with this lane (some have two, to wait between).
std::vector<YieldZone> yield_zones(const world::Network& network, LaneId first_lane) {
  std::vector<YieldZone> zones;
  LaneId lane = first_lane;
  for (int part = 0; part < 3 && lane != kNoLane && lane_of(network, lane).in_junction; ++part) {
    for (const world::NetworkConflict& c : network.conflicts) {
      if (c.first == lane && c.rule == Rule::kFirstYields) {
        zones.push_back({lane, c.first_entry_m, c.second, c.second_entry_m});
      } else if (c.second == lane && c.rule == Rule::kFirstHasPriority) {
        zones.push_back({lane, c.second_entry_m, c.first, c.first_entry_m});
      }
    }
    const std::vector<LaneId>& next = lane_of(network, lane).successors;
    lane = next.empty() ? kNoLane : next.front();
  }
  return zones;
}

/// By the angle between the lanes before and behind the junction.
Manoeuvre turn_of(const world::Network& network, LaneId inside) {
  const NetworkLane& before = lane_of(network, lane_of(network, inside).predecessors.front());
  LaneId after = inside;
  for (int part = 0; part < 3 && lane_of(network, after).in_junction; ++part) {
    if (lane_of(network, after).successors.empty()) {
      break;
    }
    after = lane_of(network, after).successors.front();
  }
  const double turn_rad = world::wrap_angle(lane_of(network, after).centre.at(0.0).heading_rad -
                                            before.centre.at(before.centre.length_m()).heading_rad);
  return turn_rad > kTurn_rad    ? Manoeuvre::kLeftTurn
         : turn_rad < -kTurn_rad ? Manoeuvre::kRightTurn
                                 : Manoeuvre::kStraight;
}

/// When a driver is first in line near the end of a lane: nobody of the others on it is still before him.
std::optional<double> first_in_line_s(const VehicleTrack& self, LaneId lane, double length_m,
                                      const std::vector<VehicleTrack>& tracks, double entered_s) {
  const double near_m = length_m - kFirstInLine_m - 0.5 * self.length_m;
  const auto near_s = self.time_at(lane, near_m);
  if (!near_s && (self.points.front().lane != lane || self.points.front().s_m < near_m)) {
    return std::nullopt;
  }
  double since_s = near_s.value_or(self.points.front().time_s);
  for (const VehicleTrack& other : tracks) {
    const auto left_s = other.time_at(lane, length_m - 0.5 * other.length_m);
    if (other.id != self.id && left_s && *left_s < entered_s) {
      since_s = std::max(since_s, *left_s);
    }
  }
  return since_s;
}

void add_choice(const std::vector<double>& others_s, double since_s, double taken_s, Manoeuvre manoeuvre,
                TrafficSamples& samples) {
  GapChoice choice;
  double before_s = since_s;
  bool any = false;
  for (const double other_s : others_s) {
    if (other_s <= since_s) {
      continue;
    }
    any = true;
    if (other_s >= taken_s) {
      choice.accepted_s = other_s - before_s;
      samples.accepted_s.push_back(choice.accepted_s);
      break;
    }
    samples.rejected_s.push_back(other_s - before_s);
    choice.largest_rejected_s = std::max(choice.largest_rejected_s, other_s - before_s);
    before_s = other_s;
  }
  if (any) {
    samples.choices[manoeuvre].push_back(choice);
  }
}

/// Others' passages of the ground, referred to the line; none where the recording ends too early to say.
std::optional<std::vector<double>> others_at_line_s(const std::vector<YieldZone>& zones,
                                                    const VehicleTrack& self, double entered_s,
                                                    const std::vector<VehicleTrack>& tracks) {
  std::vector<double> times_s;
  for (const YieldZone& zone : zones) {
    const auto own_s = self.time_at(zone.own, zone.own_entry_m);
    if (!own_s) {
      return std::nullopt;
    }
    for (const VehicleTrack& other : tracks) {
      const auto other_s = other.time_at(zone.other, zone.other_entry_m);
      if (other_s && other.id != self.id) {
        times_s.push_back(*other_s - (*own_s - entered_s));
      }
    }
  }
  std::sort(times_s.begin(), times_s.end());
  return times_s;
}

void junction_gaps(const world::Network& network, const std::vector<VehicleTrack>& tracks,
                   TrafficSamples& samples) {
  for (std::size_t id = 0; id < network.lanes.size(); ++id) {
    const NetworkLane& inside = network.lanes[id];
    if (!inside.in_junction || inside.predecessors.empty() ||
        lane_of(network, inside.predecessors.front()).in_junction) {
      continue;
    }
    const std::vector<YieldZone> zones = yield_zones(network, static_cast<LaneId>(id));
    if (zones.empty()) {
      continue;
    }
    const Manoeuvre manoeuvre = turn_of(network, static_cast<LaneId>(id));
    const LaneId before = inside.predecessors.front();
    const double before_m = lane_of(network, before).centre.length_m();
    for (const VehicleTrack& self : tracks) {
      const auto entered_s = self.time_at(before, before_m - 0.5 * self.length_m);
      if (!entered_s || !self.time_at(static_cast<LaneId>(id), 0.0)) {
        continue;
      }
      const auto since_s = first_in_line_s(self, before, before_m, tracks, *entered_s);
      const auto others_s = others_at_line_s(zones, self, *entered_s, tracks);
      if (since_s) {
        samples.waits_s[manoeuvre].push_back(*entered_s - *since_s);
      }
      if (since_s && others_s) {
        add_choice(*others_s, *since_s, *entered_s, manoeuvre, samples);
      }
    }
  }
}

double gap_s(const Beside& behind, const Beside& ahead) {
  const double gap_m = ahead.s_m - behind.s_m - 0.5 * (behind.car->length_m + ahead.car->length_m);
  return gap_m / std::max(behind.car->speed_mps, 0.1);
}

const world::CarState* find(const world::Snapshot& snapshot, int id) {
  const auto car = std::find_if(snapshot.others.begin(), snapshot.others.end(),
                                [&](const world::CarState& c) { return c.id == id; });
  return car != snapshot.others.end() ? &*car : nullptr;
}

/// Where a lane ends, a gap beside is rejected when the one who closes it goes past.
GapChoice merge_choice(const world::Network& network, std::span<const world::Snapshot> snapshots,
                       std::size_t changed, int self, LaneId from, LaneId to, TrafficSamples& samples) {
  GapChoice choice;
  const auto beside = [&](std::size_t i) -> std::optional<Neighbours> {
    const world::CarState* car = find(snapshots[i], self);
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

void lane_changes(const world::Network& network, std::span<const world::Snapshot> snapshots,
                  TrafficSamples& samples) {
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    for (const world::CarState& car : snapshots[i].others) {
      const world::CarState* before = find(snapshots[i - 1], car.id);
      if (before == nullptr || before->lane == kNoLane || car.lane == kNoLane || before->lane == car.lane) {
        continue;
      }
      const NetworkLane& from = lane_of(network, before->lane);
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
      if (from.successors.empty() && !lane_of(network, car.lane).successors.empty()) {  // his lane ends
        samples.choices[Manoeuvre::kMerge].push_back(
            merge_choice(network, snapshots, i, car.id, before->lane, car.lane, samples));
      }
    }
  }
}

/// Who stands at the end of a lane that leads into a junction when the recording ends, and has for long.
void still_waiting(const world::Network& network, const std::vector<VehicleTrack>& tracks, double last_s,
                   TrafficSamples& samples) {
  for (const VehicleTrack& track : tracks) {
    const TrackPoint& last = track.points.back();
    const NetworkLane& lane = lane_of(network, last.lane);
    const bool at_line = !lane.successors.empty() && lane_of(network, lane.successors.front()).in_junction &&
                         last.s_m > lane.centre.length_m() - kFirstInLine_m - 0.5 * track.length_m;
    const auto moved = std::find_if(track.points.rbegin(), track.points.rend(),
                                    [](const TrackPoint& p) { return p.speed_mps > kMoving_mps; });
    const double since_s = moved == track.points.rend() ? track.points.front().time_s : moved->time_s;
    if (at_line && !lane.in_junction && last.time_s > last_s - 0.5 * kStep_s && last_s - since_s > kStuck_s) {
      ++samples.still_waiting;
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

TrafficSamples observe_traffic(const world::Network& network, std::span<const world::Snapshot> snapshots) {
  TrafficSamples samples;
  if (snapshots.size() < 2) {
    return samples;
  }
  const std::vector<VehicleTrack> tracks = tracks_of(network, snapshots);
  const double last_s = snapshots.back().time_s;
  samples.observed_s = last_s - snapshots.front().time_s;
  samples.vehicles = static_cast<int>(tracks.size());
  for (const VehicleTrack& track : tracks) {
    samples.vehicle_s += track.points.back().time_s - track.points.front().time_s;
    samples.finished += track.points.back().time_s < last_s - 0.5 * kStep_s ? 1 : 0;
  }
  std::set<std::pair<int, int>> touched;
  double next_speed_s = snapshots.front().time_s;
  for (const world::Snapshot& snapshot : snapshots) {
    following(network, snapshot, samples);
    collisions(snapshot, touched);
    if (snapshot.time_s >= next_speed_s - 0.5 * kStep_s) {
      next_speed_s += 1.0;
      for (const world::CarState& car : snapshot.others) {
        samples.speeds_mps.push_back(car.speed_mps);
      }
    }
  }
  samples.collisions = static_cast<int>(touched.size());
  headways(network, tracks, samples);
  post_encroachment(network, tracks, samples);
  junction_gaps(network, tracks, samples);
  lane_changes(network, snapshots, samples);
  still_waiting(network, tracks, last_s, samples);
  return samples;
}

}  // namespace s4tp::metrics
