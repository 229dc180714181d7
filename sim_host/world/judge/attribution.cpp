#include "sim_host/world/judge/attribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "sim_host/world/judge/evidence.hpp"
#include "sim_host/world/judge/reasons.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::judge {
namespace {

using traffic::Cause;

constexpr double kStoodFor_s = 1.0;
constexpr double kZonePad_m = 3.0;  // a car beside its lane's centre touches a little before or behind a zone
constexpr double kSlow_mps = 1.0;   // who is slower in a zone was stopped there
constexpr double kQueue_mps = 2.0;  // who is slower beyond a junction leaves no room
constexpr double kOverLine_m = 0.05;
constexpr double kInfinite_s = std::numeric_limits<double>::infinity();
constexpr double kSameWay_rad = 0.25 * std::numbers::pi;  // headings differ by less

struct Party {
  const Journey* journey = nullptr;
  const traffic::CarState* car = nullptr;
  bool ours = false;
};

Verdict blame(const Party& party, Cause cause) {
  return {party.ours ? traffic::Fault::kEgo : traffic::Fault::kOther, cause};
}

/// A zone on both ways, with the group in which the first meets it.
struct SharedZone {
  ZoneGroup group;
  ZoneOnWay zone;
};

/// The zone they touch on, as `self` sees it; one with a rule before one where the first comes.
std::optional<SharedZone> zone_of_touch(const Evidence& evidence, const Party& self, const Party& other,
                                        double time_s) {
  std::optional<SharedZone> found;
  const double self_m = self.journey->at(time_s).odometer_m;
  const double other_m = other.journey->at(time_s).odometer_m;
  for (const ZoneGroup& group : evidence.groups_of(*self.journey)) {
    for (const ZoneOnWay& zone : group.zones) {
      const auto exit_m = evidence.other_exit_m(zone, *other.journey);
      const double entry_m = evidence.other_entry_m(zone, *other.journey).value_or(0.0);
      if (self_m < zone.entry_m - kZonePad_m || self_m > zone.exit_m + kZonePad_m || !exit_m ||
          other_m < entry_m - kZonePad_m || other_m > *exit_m + kZonePad_m) {
        continue;
      }
      if (!found || found->zone.meeting.rule == map::Rule::kFirstCome) {
        found = SharedZone{group, zone};
      }
    }
  }
  return found;
}

/// The same zone on the other one's way.
std::optional<SharedZone> seen_by(const Evidence& evidence, const Party& other, const ZoneOnWay& zone) {
  for (const ZoneGroup& group : evidence.groups_of(*other.journey)) {
    for (const ZoneOnWay& theirs : group.zones) {
      if (theirs.lane == zone.meeting.other && theirs.meeting.other == zone.lane) {
        return SharedZone{group, theirs};
      }
    }
  }
  return std::nullopt;
}

/// Whether a queue beyond the group left no room for the car when it entered.
bool no_room(const Evidence& evidence, const Journey& entering, const ZoneGroup& group, double entered_s) {
  return std::any_of(evidence.journeys().begin(), evidence.journeys().end(), [&](const Journey& ahead) {
    if (ahead.id == entering.id || !ahead.seen_at(entered_s)) {
      return false;
    }
    const JourneyPoint& then = ahead.at(entered_s);
    const std::optional<double> place_m = entering.odometer_at(then.lane, then.s_m);
    return place_m && then.speed_mps<kQueue_mps&& * place_m> group.entry_m &&
           *place_m - 0.5 * (ahead.length_m + entering.length_m) < group.exit_m;
  });
}

/// When the car came into the group, if it has.
double entered_s(const Journey& journey, const ZoneGroup& group, double time_s) {
  return std::min(journey.time_at(group.entry_m), time_s);
}

/// Whether one that has to give way went into the zone by licence of the other, and before it.
bool entered_by_right(const Law& law, const Evidence& evidence, const Journey& yields,
                      const Journey& creditor, const SharedZone& shared, double time_s) {
  const double to_zone_m = evidence.other_entry_m(shared.zone, creditor).value_or(0.0);
  return evidence.entered_by_licence(law, yields, shared.group, shared.zone, creditor,
                                     entered_s(yields, shared.group, time_s)) &&
         creditor.time_at(to_zone_m) >= yields.time_at(shared.zone.entry_m);
}

/// `yields` had to give way.
Verdict by_priority(const Law& law, const Evidence& evidence, const Party& yields, const Party& priority,
                    const SharedZone& shared, double time_s) {
  if (!entered_by_right(law, evidence, *yields.journey, *priority.journey, shared, time_s)) {
    return blame(yields, Cause::kEntered);
  }
  // Nobody drives into anything while it stands.
  if (evidence.stood_s(law, *priority.journey, time_s) > kStoodFor_s) {
    return blame(yields, Cause::kIntoRightful);
  }
  const bool stuck = yields.car->speed_mps < kSlow_mps;
  return stuck && no_room(evidence, *yields.journey, shared.group,
                          entered_s(*yields.journey, shared.group, time_s))
             ? blame(yields, Cause::kNoRoom)
             : blame(priority, Cause::kIntoRightful);
}

std::optional<Verdict> on_a_zone(const Law& law, const Evidence& evidence, const Party& ego,
                                 const Party& other, double time_s) {
  const std::optional<SharedZone> ours = zone_of_touch(evidence, ego, other, time_s);
  if (!ours) {
    return std::nullopt;
  }
  if (ours->zone.meeting.rule == map::Rule::kFirstYields) {
    return by_priority(law, evidence, ego, other, *ours, time_s);
  }
  if (ours->zone.meeting.rule == map::Rule::kFirstHasPriority) {
    const std::optional<SharedZone> theirs = seen_by(evidence, other, ours->zone);
    return theirs ? std::optional(by_priority(law, evidence, other, ego, *theirs, time_s)) : std::nullopt;
  }
  const double theirs_m = evidence.other_entry_m(ours->zone, *other.journey).value_or(0.0);
  const bool we_later = ego.journey->time_at(ours->zone.entry_m) >= other.journey->time_at(theirs_m);
  return blame(we_later ? ego : other, Cause::kEnteredLater);
}

bool over_the_line(const map::Network& network, const traffic::CarState& car) {
  if (car.lane == map::kNoLane) {
    return true;
  }
  const map::Lane& lane = network.lanes[static_cast<std::size_t>(car.lane)];
  const double bend_1pm = std::abs(lane.centre.at(lane.centre.project(car.centre).s_m).curvature_1pm);
  const double swept_m = 0.125 * bend_1pm * car.length_m * car.length_m;
  const auto points = traffic::corners(traffic::box_of(car));
  return std::any_of(points.begin(), points.end(), [&](map::Vec2 corner) {
    return std::abs(lane.centre.project(corner).d_m) > 0.5 * lane.width_m + swept_m + kOverLine_m;
  });
}

/// Whether we have stood for a while, within our line, with a reason, where one may (LAW-004).
bool stands_by_right(const Law& law, const map::Network& network, const Evidence& evidence,
                     const map::RouteGuide& guide, const Party& ego, double time_s) {
  return evidence.stood_s(law, *ego.journey, time_s) > kStoodFor_s - 1e-6 &&
         !over_the_line(network, *ego.car) &&
         may_stand(evidence.groups_of(*ego.journey), ego.journey->at(time_s).odometer_m) &&
         reason_to_stand(law, evidence, guide, time_s);
}

/// When the centre came into the lane it is in, in settle_s: since then the car is one of that lane's, new to the others.
std::optional<double> came_over_s(const Law& law, const map::Network& network, const Journey& journey) {
  std::optional<double> came_s;
  for (std::size_t i = 1; i < journey.points.size(); ++i) {
    const map::Lane& from = network.lanes[static_cast<std::size_t>(journey.points[i - 1].lane)];
    const map::LaneId to = journey.points[i].lane;
    const double time_s = journey.points[i].time_s;
    if (time_s >= journey.points.back().time_s - law.settle_s && (to == from.left || to == from.right)) {
      came_s = time_s;
    }
  }
  return came_s;
}

/// For a car over its line: it comes over later than anybody who has. For one in its lane: before everybody.
double still_to_come_s(const map::Network& network, const traffic::CarState& car) {
  return over_the_line(network, car) ? kInfinite_s : -kInfinite_s;
}

/// Whoever strayed later, by `strayed_s`; where nobody did, the ego.
template <class StrayedAt>
Verdict by_line(const Party& ego, const Party& other, Cause cause, const StrayedAt& strayed_s) {
  return blame(strayed_s(other) > strayed_s(ego) ? other : ego, cause);
}

/// Whether the one in front came ahead where both ways merge, and the one behind has to give way or has let it go: it is
/// bound by that licence, and sets off behind it with the distance it owes.
bool merged_by_right(const Law& law, const Evidence& evidence, const Journey& front, const Journey& rear,
                     double since_s) {
  const map::LaneId from = front.at(since_s - traffic::kSnapshotPeriod_s).lane;
  const std::vector<ZoneGroup> groups = evidence.groups_of(front);
  return std::any_of(groups.begin(), groups.end(), [&](const ZoneGroup& group) {
    return std::any_of(group.zones.begin(), group.zones.end(), [&](const ZoneOnWay& zone) {
      return zone.lane == from && zone.meeting.merging && evidence.other_entry_m(zone, rear).has_value() &&
             (zone.meeting.rule == map::Rule::kFirstHasPriority ||
              (zone.meeting.rule == map::Rule::kFirstYields &&
               entered_by_right(law, evidence, front, rear, {group, zone}, since_s)));
    });
  });
}

Verdict nose_to_tail(const Law& law, const Evidence& evidence, const map::RouteGuide& guide,
                     const Party& front, const Party& rear, double time_s) {
  const double since_s = ahead_since_s(*front.journey, *rear.journey, time_s);
  if (since_s > time_s - law.settle_s && since_s <= time_s && rear.journey->seen_at(since_s) &&
      !left_gap(law, *front.journey, *rear.journey, since_s) &&
      !merged_by_right(law, evidence, *front.journey, *rear.journey, since_s)) {
    return blame(front, Cause::kCutIn);
  }
  if (front.ours && evidence.stood_s(law, *front.journey, time_s) > kStoodFor_s - 1e-6 &&
      !reason_to_stand(law, evidence, guide, time_s)) {
    return blame(front, Cause::kStopped);
  }
  return blame(rear, Cause::kRanInto);
}

}  // namespace

Verdict attribute(const map::Network& network, const map::RouteGuide& guide,
                  std::span<const traffic::Snapshot> history, int other, const Law& law) {
  const Evidence evidence(network, history, &guide);
  const double time_s = history.back().time_s;
  const Party us{evidence.journey_of(0), &evidence.snapshots().back().ego, true};
  const Party them{evidence.journey_of(other), nullptr, false};
  if (us.journey == nullptr || them.journey == nullptr || !us.journey->seen_at(time_s) ||
      !them.journey->seen_at(time_s)) {
    return {traffic::Fault::kEgo, Cause::kUnclear};
  }
  const Party car{them.journey, &evidence.state_of(other, time_s), false};
  const double came_s = them.journey->points.front().time_s;
  if (came_s > history.front().time_s && came_s > time_s - law.reaction_s) {
    return blame(car, Cause::kAppeared);
  }
  const double turned_rad = std::abs(map::wrap_angle(car.car->heading_rad - us.car->heading_rad));
  const bool across = turned_rad > kSameWay_rad;
  if (across && stands_by_right(law, network, evidence, guide, us, time_s)) {
    return blame(car, Cause::kIntoRightful);
  }
  if (const std::optional<Verdict> verdict = on_a_zone(law, evidence, us, car, time_s)) {
    return *verdict;
  }
  if (turned_rad > std::numbers::pi - kSameWay_rad) {
    return by_line(us, car, Cause::kOncoming,
                   [&](const Party& party) { return still_to_come_s(network, *party.car); });
  }
  if (across) {
    return {traffic::Fault::kEgo, Cause::kUnclear};
  }
  const double dx = car.car->centre.x - us.car->centre.x;
  const double dy = car.car->centre.y - us.car->centre.y;
  const double ahead = std::cos(us.car->heading_rad) * dx + std::sin(us.car->heading_rad) * dy;
  const double left = std::cos(us.car->heading_rad) * dy - std::sin(us.car->heading_rad) * dx;
  const double length_overlap = 0.5 * (us.car->length_m + car.car->length_m) - std::abs(ahead);
  const double width_overlap = 0.5 * (us.car->width_m + car.car->width_m) - std::abs(left);
  if (length_overlap <= width_overlap) {
    return ahead < 0.0 ? nose_to_tail(law, evidence, guide, us, car, time_s)
                       : nose_to_tail(law, evidence, guide, car, us, time_s);
  }
  // D3 is owed to whoever has come over before.
  return by_line(us, car, Cause::kChangedLane, [&](const Party& party) {
    return came_over_s(law, network, *party.journey).value_or(still_to_come_s(network, *party.car));
  });
}

}  // namespace s4tp::judge
