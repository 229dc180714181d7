#include "sim_host/world/judge/reasons.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace s4tp::judge {
namespace {

constexpr double kAhead_m = 15.0;  // bumper to bumper and to the line: closer is a reason
constexpr double kBeside_m = 2.0;  // of the own straight way
constexpr double kLately_s = 3.0;  // a breach of the law is answered so long
constexpr double kZoneAhead_m = 30.0;

bool somebody_ahead(const traffic::Snapshot& now) {
  const double c = std::cos(now.ego.heading_rad);
  const double s = std::sin(now.ego.heading_rad);
  return std::any_of(now.others.begin(), now.others.end(), [&](const traffic::CarState& car) {
    const double dx = car.centre.x - now.ego.centre.x;
    const double dy = car.centre.y - now.ego.centre.y;
    const double ahead = c * dx + s * dy;
    return ahead > 0.0 && ahead - 0.5 * (car.length_m + now.ego.length_m) < kAhead_m &&
           std::abs(c * dy - s * dx) < kBeside_m;
  });
}

bool gives_way(const ZoneGroup& group) {
  return std::any_of(group.zones.begin(), group.zones.end(),
                     [](const ZoneOnWay& zone) { return zone.meeting.rule != map::Rule::kFirstHasPriority; });
}

/// Somebody entered a zone ahead against the ego's priority without licence, lately.
bool priority_broken(const Law& law, const Evidence& evidence, const Journey& ego, const ZoneGroup& ahead,
                     double time_s) {
  for (const ZoneOnWay& zone : ahead.zones) {
    if (zone.meeting.rule != map::Rule::kFirstHasPriority) {
      continue;
    }
    for (const Journey& other : evidence.journeys()) {
      if (other.id == ego.id) {
        continue;
      }
      for (const ZoneGroup& group : evidence.groups_of(other)) {
        const double entered_s = other.time_at(group.entry_m);
        const auto at = std::find_if(group.zones.begin(), group.zones.end(), [&](const ZoneOnWay& theirs) {
          return theirs.lane == zone.meeting.other && theirs.meeting.other == zone.lane;
        });
        if (at != group.zones.end() && entered_s <= time_s && entered_s >= time_s - kLately_s &&
            ego.seen_at(entered_s) && other.seen_at(entered_s) &&
            !evidence.entered_by_licence(law, other, group, *at, ego, entered_s)) {
          return true;
        }
      }
    }
  }
  return false;
}

bool cut_off(const Law& law, const Evidence& evidence, const Journey& ego, double time_s) {
  return std::any_of(evidence.journeys().begin(), evidence.journeys().end(), [&](const Journey& other) {
    if (other.id == ego.id || !other.seen_at(time_s)) {
      return false;
    }
    const double since_s = ahead_since_s(other, ego, time_s);
    return since_s >= time_s - kLately_s && since_s <= time_s && ego.seen_at(since_s) &&
           !left_gap(law, other, ego, since_s);
  });
}

}  // namespace

double ahead_since_s(const Journey& front, const Journey& rear, double time_s) {
  double since_s = std::numeric_limits<double>::infinity();
  for (auto point = front.points.rbegin(); point != front.points.rend(); ++point) {
    if (point->time_s > time_s + 1e-6) {
      continue;
    }
    const std::optional<double> place_m = rear.odometer_at(point->lane, point->s_m);
    if (!place_m || (rear.seen_at(point->time_s) && *place_m < rear.at(point->time_s).odometer_m)) {
      return since_s;
    }
    since_s = point->time_s;
  }
  return -std::numeric_limits<double>::infinity();
}

bool left_gap(const Law& law, const Journey& front, const Journey& rear, double time_s) {
  const JourneyPoint& ahead = front.at(time_s);
  const JourneyPoint& behind = rear.at(time_s);
  const std::optional<double> place_m = rear.odometer_at(ahead.lane, ahead.s_m);
  return place_m && *place_m - behind.odometer_m - 0.5 * (front.length_m + rear.length_m) >=
                        rss_gap_m(law.rss, behind.speed_mps, ahead.speed_mps);
}

std::optional<Reason> reason_to_stand(const Law& law, const Evidence& evidence, const map::RouteGuide& guide,
                                      double time_s) {
  const Journey* ego = evidence.journey_of(0);
  if (ego == nullptr || !ego->seen_at(time_s)) {
    return std::nullopt;
  }
  const auto now =
      std::find_if(evidence.snapshots().rbegin(), evidence.snapshots().rend(),
                   [&](const traffic::Snapshot& snapshot) { return snapshot.time_s <= time_s + 1e-6; });
  if (now != evidence.snapshots().rend() && somebody_ahead(*now)) {
    return Reason::kQueue;
  }
  const JourneyPoint& here = ego->at(time_s);
  const double nose_m = here.odometer_m + 0.5 * ego->length_m;
  double group_entry_m = std::numeric_limits<double>::infinity();
  for (const ZoneGroup& group : evidence.groups_of(*ego)) {
    if (group.entry_m < here.odometer_m) {
      continue;
    }
    group_entry_m = std::min(group_entry_m, group.entry_m);
    if (group.entry_m - here.odometer_m < kAhead_m && gives_way(group)) {
      return Reason::kGivesWay;
    }
    if (group.entry_m - here.odometer_m < kZoneAhead_m &&
        priority_broken(law, evidence, *ego, group, time_s)) {
      return Reason::kLawBroken;
    }
  }
  const map::RouteGuide::Advice& advice = guide.advice(here.lane);
  const double lane_ends_m = here.odometer_m - here.s_m + advice.remaining_m;
  if (advice.changes_needed != 0 && std::min(lane_ends_m, group_entry_m) - nose_m < kAhead_m) {
    return Reason::kLaneChange;
  }
  if (cut_off(law, evidence, *ego, time_s)) {
    return Reason::kLawBroken;
  }
  return std::nullopt;
}

}  // namespace s4tp::judge
