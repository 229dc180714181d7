#include "sim_host/world/judge/journey.hpp"

#include <algorithm>
#include <map>

#include "sim_host/world/map/lane_of.hpp"

namespace s4tp::judge {
namespace {

constexpr std::size_t kChainMax = 4;  // lanes passed in 0.1 s: seams between edges are 1 m long
constexpr double kAhead_m = 100.0;

/// Lanes from `from` to `to` going forward, both included; empty: not within reach.
std::vector<map::LaneId> chain(const map::Network& network, map::LaneId from, map::LaneId to,
                               std::size_t most) {
  if (from == to) {
    return {from};
  }
  if (most <= 1) {
    return {};
  }
  for (const map::LaneId next : map::lane_of(network, from).successors) {
    std::vector<map::LaneId> rest = chain(network, next, to, most - 1);
    if (!rest.empty()) {
      rest.insert(rest.begin(), from);
      return rest;
    }
  }
  return {};
}

/// Appends a point, and what lanes the car has come to since the last one.
void go_on(const map::Network& network, Journey& journey, map::Vec2 centre_before, JourneyPoint now) {
  const JourneyPoint before = journey.points.back();
  const std::vector<map::LaneId> lanes = chain(network, before.lane, now.lane, kChainMax);
  if (lanes.empty()) {  // a change of lane
    const double from_m = map::lane_of(network, now.lane).centre.project(centre_before).s_m;
    now.odometer_m = before.odometer_m + now.s_m - from_m;
    journey.stretches.push_back({now.lane, now.odometer_m - now.s_m, before.odometer_m, now.odometer_m});
  } else {
    double start_m = before.odometer_m - before.s_m;
    for (std::size_t i = 0; i + 1 < lanes.size(); ++i) {
      start_m += map::lane_of(network, lanes[i]).centre.length_m();
      journey.stretches.push_back({lanes[i + 1], start_m, before.odometer_m, 0.0});
    }
    now.odometer_m = start_m + now.s_m;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      journey.stretches[journey.stretches.size() - 1 - i].until_m = now.odometer_m;
    }
  }
  journey.points.push_back(now);
}

}  // namespace

double Journey::time_at(double odometer_m) const {
  const auto there = std::find_if(points.begin(), points.end(),
                                  [&](const JourneyPoint& point) { return point.odometer_m >= odometer_m; });
  if (there == points.end()) {
    return std::numeric_limits<double>::infinity();
  }
  if (there == points.begin()) {
    return there->time_s;
  }
  const JourneyPoint& before = *(there - 1);
  return before.time_s + (there->time_s - before.time_s) * (odometer_m - before.odometer_m) /
                             (there->odometer_m - before.odometer_m);
}

std::optional<double> Journey::odometer_at(map::LaneId lane, double s_m) const {
  for (const Stretch& stretch : stretches) {
    const double odometer_m = stretch.start_m + s_m;
    if (stretch.lane == lane && stretch.from_m < odometer_m && odometer_m <= stretch.until_m) {
      return odometer_m;
    }
  }
  return std::nullopt;
}

std::optional<double> Journey::time_at(map::LaneId lane, double s_m) const {
  const std::optional<double> odometer_m = odometer_at(lane, s_m);
  if (!odometer_m || *odometer_m > points.back().odometer_m) {
    return std::nullopt;
  }
  return time_at(*odometer_m);
}

const JourneyPoint& Journey::at(double time_s) const {
  const auto after =
      std::upper_bound(points.begin(), points.end(), time_s + 1e-6,
                       [](double time, const JourneyPoint& point) { return time < point.time_s; });
  return after == points.begin() ? points.front() : *(after - 1);
}

bool Journey::seen_at(double time_s) const {
  return time_s > points.front().time_s - 1e-6 && time_s < points.back().time_s + traffic::kSnapshotPeriod_s;
}

std::vector<Journey> journeys_of(const map::Network& network, std::span<const traffic::Snapshot> snapshots,
                                 bool with_ego) {
  struct Last {
    std::size_t journey = 0;
    map::Vec2 centre;
  };
  std::vector<Journey> journeys;
  std::map<int, Last> last;
  const auto see = [&](double time_s, const traffic::CarState& car) {
    if (car.lane == map::kNoLane) {
      return;
    }
    const double s_m = map::lane_of(network, car.lane).centre.project(car.centre).s_m;
    const JourneyPoint now{time_s, car.lane, s_m, 0.0, car.speed_mps, car.acceleration_mps2};
    const auto [entry, fresh] = last.try_emplace(car.id, Last{journeys.size(), car.centre});
    if (fresh) {
      journeys.push_back({car.id, car.length_m, car.width_m, {now}, {{car.lane, -s_m, 0.0, 0.0}}});
    } else {
      go_on(network, journeys[entry->second.journey], entry->second.centre, now);
      entry->second.centre = car.centre;
    }
  };
  for (const traffic::Snapshot& snapshot : snapshots) {
    if (with_ego) {
      see(snapshot.time_s, snapshot.ego);
    }
    for (const traffic::CarState& car : snapshot.others) {
      see(snapshot.time_s, car);
    }
  }
  return journeys;
}

void extend(const map::Network& network, const map::RouteGuide* guide, Journey& journey) {
  Stretch* last = &journey.stretches.back();
  const double end_m = journey.points.back().odometer_m + kAhead_m;
  while (true) {
    const map::Lane& lane = map::lane_of(network, last->lane);
    last->until_m = end_m;
    const double next_start_m = last->start_m + lane.centre.length_m();
    map::LaneId next = lane.successors.size() == 1 ? lane.successors.front() : map::kNoLane;
    if (guide != nullptr && guide->advice(last->lane).next != map::kNoLane) {
      next = guide->advice(last->lane).next;
    }
    if (next == map::kNoLane || next_start_m >= end_m) {
      return;
    }
    journey.stretches.push_back({next, next_start_m, last->from_m, end_m});
    last = &journey.stretches.back();
  }
}

}  // namespace s4tp::judge
