#include "sim_host/metrics/encounters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim_host/world/judge/reasons.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::metrics {
namespace {

using judge::Evidence;
using judge::Journey;
using judge::JourneyPoint;
using judge::Law;
using judge::ZoneGroup;
using judge::ZoneOnWay;
using map::Lane;
using map::Rule;
using traffic::CarState;
using traffic::Snapshot;

constexpr double kZonePad_m =
    3.0;  // a car beside its lane's centre comes over a zone a little earlier and later
constexpr double kSight_m = 100.0;
constexpr double kMoving_mps = 3.0;
constexpr double kCutInGrace_s = 1.0;
constexpr double kReacts_s = 2.0;
constexpr double kGentle_mps2 = 2.0;
constexpr double kReachesIn_m = 0.3;  // of a box in a lane before those on it see it there

/// What is looked at.
struct EgoDrive {
  const Law& law;
  const Evidence& evidence;
  const Journey& ego;
  std::vector<ZoneGroup> groups;  ///< on its way
  double from_s;
};

/// Somebody ahead in somebody's way.
struct Ahead {
  const Journey* car = nullptr;
  double gap_m = kSight_m;
};

/// Places of a car on lanes: its own, and those beside it that its box reaches into.
std::vector<std::pair<map::LaneId, double>> places_of(const Evidence& evidence, const CarState& car) {
  std::vector<std::pair<map::LaneId, double>> places;
  if (car.lane == map::kNoLane) {
    return places;
  }
  const Lane& lane = evidence.road().lane(car.lane);
  places.emplace_back(car.lane, lane.centre.project(car.centre).s_m);
  for (const map::LaneId beside : {lane.left, lane.right}) {
    if (beside != map::kNoLane) {
      const Lane& other = evidence.road().lane(beside);
      const map::PolylineProjection at = other.centre.project(car.centre);
      if (std::abs(at.d_m) < 0.5 * (other.width_m + car.width_m) - kReachesIn_m) {
        places.emplace_back(beside, at.s_m);
      }
    }
  }
  return places;
}

/// The next one ahead on the way of `self`.
std::optional<Ahead> next_ahead(const Evidence& evidence, const Snapshot& now, const Journey& self) {
  const double here_m = self.at(now.time_s).odometer_m;
  std::optional<Ahead> nearest;
  const auto consider = [&](const CarState& car) {
    if (car.id == self.id) {
      return;
    }
    for (const auto& [lane, s_m] : places_of(evidence, car)) {
      const std::optional<double> place_m = self.odometer_at(lane, s_m);
      if (!place_m || *place_m <= here_m) {
        continue;
      }
      const double gap_m = *place_m - here_m - 0.5 * (self.length_m + car.length_m);
      if (gap_m < (nearest ? nearest->gap_m : kSight_m)) {
        nearest = Ahead{evidence.journey_of(car.id), gap_m};
      }
    }
  };
  consider(now.ego);
  for (const CarState& car : now.others) {
    consider(car);
  }
  return nearest;
}

/// One car's states while it is at a zone.
std::vector<std::pair<double, const CarState*>> while_between(const Evidence& evidence, const Journey& car,
                                                              double from_m, double until_m, double from_s) {
  std::vector<std::pair<double, const CarState*>> states;
  for (const JourneyPoint& point : car.points) {
    if (point.time_s >= from_s && point.odometer_m >= from_m && point.odometer_m <= until_m) {
      states.emplace_back(point.time_s, &evidence.state_of(car.id, point.time_s));
    }
  }
  return states;
}

double post_encroachment_s(const EgoDrive& drive, const ZoneOnWay& zone, const Journey& other) {
  const Evidence& evidence = drive.evidence;
  const std::optional<double> exit_m = evidence.other_exit_m(zone, other);
  if (!exit_m) {
    return kApart_s;
  }
  const double entry_m = evidence.other_entry_m(zone, other).value_or(0.0);
  const auto ours =
      while_between(evidence, drive.ego, zone.entry_m - kZonePad_m, zone.exit_m + kZonePad_m, drive.from_s);
  const auto theirs =
      while_between(evidence, other, entry_m - kZonePad_m, *exit_m + kZonePad_m, drive.from_s);
  double least_s = kApart_s;
  for (const auto& [our_s, our_state] : ours) {
    for (const auto& [their_s, their_state] : theirs) {
      const double apart_s = std::abs(our_s - their_s);
      if (apart_s < least_s && overlap(box_of(*our_state), box_of(*their_state))) {
        least_s = apart_s;
      }
    }
  }
  return least_s;
}

bool touches(const EgoDrive& drive, int other) {
  const std::vector<Snapshot>& snapshots = drive.evidence.snapshots();
  return std::any_of(snapshots.begin(), snapshots.end(), [&](const Snapshot& now) {
    return now.time_s >= drive.from_s &&
           std::any_of(now.others.begin(), now.others.end(), [&](const CarState& car) {
             return car.id == other && overlap(box_of(now.ego), box_of(car));
           });
  });
}

void meet_at_zones(const EgoDrive& drive, Encounters& result) {
  for (const Journey& other : drive.evidence.journeys()) {
    if (other.id == drive.ego.id) {
      continue;
    }
    double least_s = kApart_s;
    for (const ZoneGroup& group : drive.groups) {
      for (const ZoneOnWay& zone : group.zones) {
        least_s = std::min(least_s, post_encroachment_s(drive, zone, other));
      }
    }
    result.min_post_encroachment_s = std::min(result.min_post_encroachment_s, least_s);
    if (least_s < kNearMiss_s - 1e-6 && !touches(drive, other.id)) {
      ++result.near_misses;
    }
  }
  result.min_time_gap_s = std::min(result.min_time_gap_s, result.min_post_encroachment_s);
}

double time_gap_s(double gap_m, const JourneyPoint& rear) {
  return rear.speed_mps >= kMoving_mps ? std::max(0.0, gap_m) / rear.speed_mps : kApart_s;
}

/// Whether a car this far from something it must not meet has begun to react.
bool reacts(double way_m, double speed_mps, double speed_there_mps) {
  const double slower = speed_mps * speed_mps - speed_there_mps * speed_there_mps;
  return way_m < kReacts_s * speed_mps + std::max(0.0, slower) / (2.0 * kGentle_mps2);
}

/// The ego is on a zone of the other one's way, or in the group before it, and need not be given way there.
bool blocks(const EgoDrive& drive, const Journey& other, double time_s) {
  const double ego_m = drive.ego.at(time_s).odometer_m;
  const JourneyPoint& there = other.at(time_s);
  for (const ZoneGroup& group : drive.groups) {
    if (ego_m < group.entry_m || ego_m > group.exit_m) {
      continue;
    }
    for (const ZoneOnWay& zone : group.zones) {
      const std::optional<double> entry_m = drive.evidence.other_entry_m(zone, other);
      if (zone.meeting.rule != Rule::kFirstHasPriority && ego_m < zone.exit_m && entry_m &&
          there.odometer_m < *entry_m && reacts(*entry_m - there.odometer_m, there.speed_mps, 0.0)) {
        return true;
      }
    }
  }
  return false;
}

void impose_braking(const EgoDrive& drive, const Snapshot& now, Encounters& result) {
  for (const CarState& car : now.others) {
    const double braking_mps2 = -car.acceleration_mps2;
    const Journey* other = drive.evidence.journey_of(car.id);
    if (braking_mps2 <= result.imposed_braking_mps2 || other == nullptr || !other->seen_at(now.time_s)) {
      continue;
    }
    const std::optional<Ahead> ahead = next_ahead(drive.evidence, now, *other);
    const bool ego_ahead = ahead && ahead->car == &drive.ego;
    const bool follows = ego_ahead && reacts(ahead->gap_m, car.speed_mps, now.ego.speed_mps);
    const bool follows_another =
        ahead && !ego_ahead && reacts(ahead->gap_m, car.speed_mps, ahead->car->at(now.time_s).speed_mps);
    if (follows || (!follows_another && blocks(drive, *other, now.time_s))) {
      result.imposed_braking_mps2 = braking_mps2;
    }
  }
}

/// The least time gap of those behind the ego on ways that lead to where it is.
double followed_s(const EgoDrive& drive, const JourneyPoint& here) {
  double least_s = kApart_s;
  for (const Journey& other : drive.evidence.journeys()) {
    if (other.id == drive.ego.id || !other.seen_at(here.time_s)) {
      continue;
    }
    const std::optional<double> place_m = other.odometer_at(here.lane, here.s_m);
    const JourneyPoint& behind = other.at(here.time_s);
    if (place_m && *place_m > behind.odometer_m) {
      const double gap_m = *place_m - behind.odometer_m - 0.5 * (drive.ego.length_m + other.length_m);
      least_s = std::min(least_s, time_gap_s(gap_m, behind));
    }
  }
  return least_s;
}

}  // namespace

Encounters encounters_of(const Law& law, const Evidence& evidence, double from_s) {
  Encounters result;
  const Journey* ego = evidence.journey_of(0);
  if (ego == nullptr) {
    return result;
  }
  const EgoDrive drive{law, evidence, *ego, evidence.groups_of(*ego), from_s};
  meet_at_zones(drive, result);
  double gap_sum_m = 0.0;
  int leaders = 0;
  int steps = 0;
  int violating = 0;
  bool violated = false;
  for (const Snapshot& now : evidence.snapshots()) {
    if (now.time_s < from_s) {
      continue;
    }
    ++steps;
    bool violates = false;
    if (now.ego.lane != map::kNoLane) {
      const JourneyPoint& here = ego->at(now.time_s);
      if (const std::optional<Ahead> leader = next_ahead(evidence, now, *ego)) {
        gap_sum_m += leader->gap_m;
        ++leaders;
        const double ahead_s = now.time_s - ahead_since_s(*leader->car, *ego, now.time_s);
        const double owed_m = rss_gap_m(law.rss, here.speed_mps, leader->car->at(now.time_s).speed_mps);
        violates = leader->gap_m < owed_m && ahead_s > kCutInGrace_s;
        if (ahead_s < law.settle_s) {
          result.min_time_gap_s = std::min(result.min_time_gap_s, time_gap_s(leader->gap_m, here));
        }
      }
      result.min_time_gap_s = std::min(result.min_time_gap_s, followed_s(drive, here));
      impose_braking(drive, now, result);
    }
    violating += violates ? 1 : 0;
    result.rss_violations += violates && !violated ? 1 : 0;
    violated = violates;
  }
  result.mean_gap_m = leaders > 0 ? gap_sum_m / leaders : 0.0;
  result.rss_violation_share = steps > 0 ? static_cast<double>(violating) / steps : 0.0;
  return result;
}

}  // namespace s4tp::metrics
