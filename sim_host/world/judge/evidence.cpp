#include "sim_host/world/judge/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim_host/world/map/lane_of.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::judge {
namespace {

bool within(const map::Lane& lane, map::Vec2 point) {
  return std::abs(lane.centre.project(point).d_m) <= 0.5 * lane.width_m;
}

const traffic::CarState* find(const traffic::Snapshot& snapshot, int id) {
  if (id == 0) {
    return &snapshot.ego;
  }
  const auto car = std::find_if(snapshot.others.begin(), snapshot.others.end(),
                                [&](const traffic::CarState& state) { return state.id == id; });
  return car == snapshot.others.end() ? nullptr : &*car;
}

}  // namespace

map::LaneId lane_under(const map::Network& network, const traffic::CarState& car) {
  if (car.lane == map::kNoLane || within(map::lane_of(network, car.lane), car.centre)) {
    return car.lane;
  }
  for (const map::LaneId beside :
       {map::lane_of(network, car.lane).left, map::lane_of(network, car.lane).right}) {
    if (beside != map::kNoLane && within(map::lane_of(network, beside), car.centre)) {
      return beside;
    }
  }
  return car.lane;
}

Evidence::Evidence(const map::Network& network, std::span<const traffic::Snapshot> snapshots,
                   const map::RouteGuide* ego_guide)
    : road_(network), snapshots_(snapshots.begin(), snapshots.end()) {
  for (traffic::Snapshot& snapshot : snapshots_) {
    snapshot.ego.lane = snapshot.time_s < 0.0 ? map::kNoLane : lane_under(network, snapshot.ego);
    for (traffic::CarState& car : snapshot.others) {
      car.lane = lane_under(network, car);
    }
  }
  journeys_ = journeys_of(network, snapshots_, ego_guide != nullptr);
  for (Journey& journey : journeys_) {
    extend(network, journey.id == 0 ? ego_guide : nullptr, journey);
  }
}

const Journey* Evidence::journey_of(int id) const {
  const auto found = std::find_if(journeys_.begin(), journeys_.end(),
                                  [&](const Journey& journey) { return journey.id == id; });
  return found == journeys_.end() ? nullptr : &*found;
}

std::vector<ZoneGroup> Evidence::groups_of(const Journey& journey) const {
  return zone_groups(road_, journey.stretches, journey.length_m);
}

const traffic::Snapshot& Evidence::snapshot_at(double time_s) const {
  const auto after =
      std::upper_bound(snapshots_.begin(), snapshots_.end(), time_s + 1e-6,
                       [](double time, const traffic::Snapshot& snapshot) { return time < snapshot.time_s; });
  return after == snapshots_.begin() ? snapshots_.front() : *(after - 1);
}

const traffic::CarState& Evidence::state_of(int id, double time_s) const {
  const traffic::CarState* state = find(snapshot_at(time_s), id);
  if (state == nullptr) {
    throw std::logic_error("car " + std::to_string(id) + " was not there");
  }
  return *state;
}

bool Evidence::in_sight(int from, int to, double time_s) const {
  return !traffic::hidden(state_of(from, time_s), state_of(to, time_s), snapshot_at(time_s).others);
}

double Evidence::stood_s(const Law& law, const Journey& journey, double time_s) const {
  double since_s = time_s;
  for (auto point = journey.points.rbegin(); point != journey.points.rend(); ++point) {
    if (point->time_s > time_s + 1e-6) {
      continue;
    }
    if (point->speed_mps >= law.standing_mps) {
      break;
    }
    since_s = point->time_s;
  }
  return time_s - since_s;
}

std::optional<double> Evidence::other_entry_m(const ZoneOnWay& zone, const Journey& other) const {
  return other.odometer_at(zone.meeting.other, zone.meeting.other_entry_m - longer_by_m(other.length_m));
}

std::optional<double> Evidence::other_exit_m(const ZoneOnWay& zone, const Journey& other) const {
  return other.odometer_at(zone.meeting.other, zone.meeting.other_exit_m + longer_by_m(other.length_m));
}

Entry Evidence::entry_of(const Law& law, const Journey& entering, const ZoneGroup& group,
                         const ZoneOnWay& zone, const Journey& other, double time_s) const {
  const JourneyPoint& then = other.at(time_s);
  const double gone_s = entering.time_at(zone.exit_m);
  Entry entry;
  entry.merging = zone.meeting.merging;
  entry.gone_after_s = gone_s - time_s;
  entry.gone_mps = std::isfinite(gone_s) ? entering.at(gone_s).speed_mps : 0.0;
  entry.other_to_zone_m = other_entry_m(zone, other).value_or(0.0) - then.odometer_m;
  entry.other_to_end_m = other_exit_m(zone, other).value_or(0.0) - then.odometer_m;
  entry.other_mps = then.speed_mps;
  entry.other_limit_mps = std::max(map::lane_of(road_.network(), then.lane).speed_limit_mps,
                                   map::lane_of(road_.network(), zone.meeting.other).speed_limit_mps);
  entry.bumpers_m = 0.5 * (entering.length_m + other.length_m);
  entry.in_sight = in_sight(other.id, entering.id, time_s);
  for (auto point = entering.points.rbegin(); point != entering.points.rend(); ++point) {
    if (point->time_s > time_s + 1e-6) {
      continue;
    }
    if (point->odometer_m < group.entry_m - law.shown_within_m || !other.seen_at(point->time_s) ||
        !in_sight(other.id, entering.id, point->time_s)) {
      break;
    }
    entry.shown_s = time_s - point->time_s;
  }
  entry.other_stood_s = stood_s(law, other, time_s);
  entry.both_stood_s = std::min(entry.other_stood_s, stood_s(law, entering, time_s));
  return entry;
}

bool Evidence::entered_by_licence(const Law& law, const Journey& entering, const ZoneGroup& group,
                                  const ZoneOnWay& zone, const Journey& other, double entered_s) const {
  const auto licensed_at = [&](double time_s) {
    return licence_of(law, entry_of(law, entering, group, zone, other, time_s)) != Licence::kNone;
  };
  // Who comes into the world later finds the ground taken.
  const JourneyPoint& first = other.points.front();
  const auto could_stop_when_it_came = [&] {
    return can_stop(law, first.speed_mps, other_entry_m(zone, other).value_or(0.0) - first.odometer_m);
  };
  if (!other.seen_at(entered_s)) {
    return first.time_s > entered_s && could_stop_when_it_came();
  }
  if (licensed_at(entered_s)) {
    return true;
  }
  for (auto point = entering.points.rbegin(); point != entering.points.rend(); ++point) {
    if (point->time_s > entered_s) {
      continue;
    }
    if (can_stop(law, point->speed_mps, group.entry_m - point->odometer_m)) {
      return false;
    }
    if (!other.seen_at(point->time_s)) {
      return could_stop_when_it_came();
    }
    if (licensed_at(point->time_s)) {
      return true;
    }
  }
  return false;
}

}  // namespace s4tp::judge
