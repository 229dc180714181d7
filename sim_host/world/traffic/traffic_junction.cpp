#include "sim_host/world/traffic/traffic_junction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace s4tp::world {
namespace {

constexpr double kLook_m = 60.0;      // junctions further away are not thought about
constexpr double kOther_mps2 = 1.5;   // how quickly one expects others to come
constexpr double kOwnShareIn = 1.0;   // of the own acceleration, when judging how soon one is there
constexpr double kOwnShareOut = 0.6;  // and how late one is gone
constexpr double kOwnTopShare = 0.9;  // of the speed wanted, the same
constexpr double kBehindOther = 1.6;  // reaction times between another's leaving and the own entering
constexpr double kOrder_s = 0.2;      // "at the same time"
constexpr double kStanding_mps = 0.3;
constexpr double kPatience_s = 5.0;  // then somebody who stands is more and more taken to let us go
constexpr double kLineRoom_m = 0.3;
constexpr double kDeadlock_s = 2.0;       // until somebody takes heart
constexpr double kCourteous = 0.5;        // from here on drivers let somebody go who has waited
constexpr double kCourtesyAfter_s = 5.0;  // he has waited
constexpr double kCourtesyLasts_s = 5.0;  // then they go themselves
constexpr double kCourtesy_mps2 = 2.0;    // braking they take upon themselves for it

/// When somebody is on the ground shared, as others expect it.
struct Occupation {
  bool coming = false;
  bool inside_junction = false;
  double from_s = 0.0;
  double until_s = 0.0;
};

Occupation occupation_of(const TrafficView& view, const Actor& actor, const Meeting& meeting) {
  Occupation occupation;
  if (actor.queues) {
    return occupation;  // he cannot come before the one ahead of him has gone
  }
  for (const WayPart& part : actor.way) {
    if (part.lane != meeting.other) {
      continue;
    }
    const double in_m = part.start_m + meeting.other_entry_m;
    const double out_m = part.start_m + meeting.other_exit_m;
    if (out_m <= 0.0) {
      break;
    }
    const double limit_mps = view.road().lane(part.lane).speed_limit_mps;
    occupation.coming = true;
    // Who stands inside the junction, but short of the ground shared, waits there: nobody waits for him.
    const bool under_way = view.road().lane(actor.lane).in_junction && actor.speed_mps > kStanding_mps;
    occupation.inside_junction = under_way || in_m <= 0.0;
    occupation.from_s =
        time_to_cover_s(in_m, actor.speed_mps, kOther_mps2, std::max(limit_mps, actor.speed_mps));
    occupation.until_s = time_to_cover_s(out_m, std::min(actor.speed_mps, limit_mps), 0.0, limit_mps);
    break;
  }
  return occupation;
}

struct OwnTimes {
  double in_s = 0.0;
  double out_s = 0.0;
};

OwnTimes own_times(const Approach& approach, double in_m, double out_m) {
  const double acceleration = approach.driver->acceleration_mps2;
  double top_mps = approach.wanted_mps;
  if (approach.leader.actor != nullptr && approach.leader.gap_m < 15.0) {
    top_mps = std::min(top_mps, approach.leader.actor->speed_mps + 1.0);
  }
  const double speed = approach.self->speed_mps;
  const double slow_top_mps = kOwnTopShare * top_mps;
  return {time_to_cover_s(in_m, speed, kOwnShareIn * acceleration, top_mps),
          time_to_cover_s(out_m, std::min(speed, slow_top_mps), kOwnShareOut * acceleration, slow_top_mps)};
}

bool gap_accepted(const Approach& approach, Rule rule, const OwnTimes& own, const Actor& other,
                  Occupation theirs) {
  if (rule == Rule::kFirstCome && other.speed_mps < kStanding_mps && !theirs.inside_junction) {
    theirs.from_s += 0.5 * std::max(0.0, approach.waited_s - kPatience_s);
  }
  const double margin_s = accepted_margin_s(*approach.driver, approach.waited_s);
  return own.out_s + margin_s < theirs.from_s ||
         own.in_s > theirs.until_s + kBehindOther * approach.driver->reaction_s;
}

bool must_wait(const Approach& approach, const Meeting& meeting, const OwnTimes& own, const Actor& other,
               const Occupation& theirs) {
  switch (meeting.rule) {
    case Rule::kFirstHasPriority:  // who stands does not start into somebody who has begun
      return approach.self->speed_mps < kStanding_mps && other.committed && other.speed_mps > kStanding_mps &&
             theirs.from_s < own.out_s && own.in_s < theirs.until_s;
    case Rule::kFirstYields:
      return other.lets_go != approach.self->id && !gap_accepted(approach, meeting.rule, own, other, theirs);
    case Rule::kFirstCome:
      break;
  }
  const bool they_first = theirs.inside_junction || theirs.from_s < own.in_s - kOrder_s ||
                          (theirs.from_s < own.in_s + kOrder_s && other.id < approach.self->id);
  return they_first && !gap_accepted(approach, meeting.rule, own, other, theirs);
}

/// Whether the other one, who is inside though he should have waited, will be there when we are.
bool in_the_way(const OwnTimes& own, const Occupation& theirs) {
  return theirs.inside_junction && theirs.from_s < own.out_s && own.in_s < theirs.until_s;
}

/// Whether a driver with right of way stops for somebody who has waited, and lets him finish what he began.
bool courteous(const Approach& approach, const Meeting& meeting, const Actor& other, double line_m) {
  if (meeting.rule != Rule::kFirstHasPriority || approach.committed || line_m < -0.5) {
    return false;
  }
  const bool standing = other.speed_mps < kStanding_mps;
  if (approach.lets_go == other.id) {
    return !standing || other.committed || approach.gave_way_s < kCourtesyLasts_s;
  }
  const double speed = approach.self->speed_mps;
  return approach.driver->courtesy >= kCourteous && approach.gave_way_s < kCourtesyLasts_s && standing &&
         other.waited_s > kCourtesyAfter_s && speed * speed < 2.0 * kCourtesy_mps2 * line_m;
}

/// Those ids, and all for whom they wait, be it through others; only who stands waits.
std::vector<int> waited_for(const TrafficView& view, std::vector<int> ids) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto actor = std::find_if(view.actors().begin(), view.actors().end(),
                                    [id = ids[i]](const Actor& a) { return a.id == id; });
    if (actor == view.actors().end() || actor->speed_mps >= kStanding_mps) {
      continue;
    }
    for (const int next : actor->waits_for) {
      if (std::find(ids.begin(), ids.end(), next) == ids.end()) {
        ids.push_back(next);
      }
    }
  }
  return ids;
}

/// Where all wait for each other, the one who has waited longest goes; the ego is not counted upon.
bool ends_deadlock(const TrafficView& view, const Actor& self, const std::vector<int>& waits_for) {
  if (waits_for.empty() || self.speed_mps >= kStanding_mps || self.waited_s < kDeadlock_s) {
    return false;
  }
  const auto waits_for_self = [&](int id) {
    const std::vector<int> all = waited_for(view, {id});
    return std::find(all.begin(), all.end(), self.id) != all.end();
  };
  if (!std::all_of(waits_for.begin(), waits_for.end(), waits_for_self)) {
    return false;
  }
  const std::vector<int> circle = waited_for(view, waits_for);
  return std::none_of(view.actors().begin(), view.actors().end(), [&](const Actor& other) {
    const bool longer =
        other.waited_s > self.waited_s || (other.waited_s == self.waited_s && other.id < self.id);
    return longer && other.id > 0 && other.id != self.id &&
           std::find(circle.begin(), circle.end(), other.id) != circle.end() && waits_for_self(other.id);
  });
}

/// A queue behind the junction must leave room for the whole car.
bool no_room_behind(const Approach& approach, double junction_end_m) {
  const Leader& leader = approach.leader;
  return leader.actor != nullptr && !leader.merging && leader.actor->speed_mps < 2.0 &&
         leader.gap_m < junction_end_m + 0.5 * approach.self->length_m + 1.0 &&
         leader.gap_m + 0.5 * leader.actor->length_m > 0.0;
}

}  // namespace

bool surprises_at_junction(const TrafficView& view, const std::vector<WayPart>& way) {
  for (const WayPart& part : way) {
    if (part.start_m > kLook_m || !view.road().lane(part.lane).in_junction) {
      continue;
    }
    for (const Meeting& meeting : view.road().meetings(part.lane)) {
      for (const Actor& other : view.actors()) {
        const Occupation theirs = occupation_of(view, other, meeting);
        if (theirs.coming && (theirs.inside_junction || other.committed)) {
          return true;
        }
      }
    }
  }
  return false;
}

JunctionChoice choose_at_junction(const TrafficView& view, const Approach& approach) {
  JunctionChoice choice;
  const std::vector<WayPart>& way = approach.self->way;
  const auto inside = [&](std::size_t i) { return view.road().lane(way[i].lane).in_junction; };
  if (way.empty() || inside(0)) {
    return choice;
  }
  std::size_t first = 1;
  while (first < way.size() && !inside(first)) {
    ++first;
  }
  if (first >= way.size() || way[first].start_m > kLook_m) {
    return choice;
  }
  std::size_t after = first;
  while (after < way.size() && inside(after)) {
    ++after;
  }
  const double half_m = 0.5 * approach.self->length_m;
  choice.near = true;
  choice.line_m = way[first].start_m - half_m - kLineRoom_m;
  double hazard_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = first - 1; i < std::min(after + 1, way.size()); ++i) {
    for (const Meeting& meeting : view.road().meetings(way[i].lane)) {
      const double in_m = way[i].start_m + meeting.entry_m;
      const double out_m = way[i].start_m + meeting.exit_m;
      if (out_m <= 0.0) {
        continue;
      }
      const OwnTimes own = own_times(approach, in_m, out_m);
      for (const Actor& other : view.actors()) {
        if (other.id == approach.self->id || other.way.empty()) {
          continue;
        }
        const Occupation theirs = occupation_of(view, other, meeting);
        if (!theirs.coming) {
          continue;
        }
        if (courteous(approach, meeting, other, choice.line_m)) {
          choice.stop = true;
          choice.lets_go = other.id;
        }
        if (!approach.committed && must_wait(approach, meeting, own, other, theirs)) {
          choice.stop = true;
          choice.waits_for.push_back(other.id);
          if (i < first) {  // shared ground begins before the line
            choice.line_m = std::min(choice.line_m, in_m - kLineRoom_m);
          }
        } else if (!meeting.merging && in_m > 0.0 && in_m < hazard_m && in_the_way(own, theirs)) {
          hazard_m = in_m;
          choice.hazard = other.id;
          choice.hazard_m = in_m - kLineRoom_m;
        }
      }
    }
  }
  choice.queues = approach.leader.gap_m < choice.line_m && approach.self->speed_mps < kStanding_mps &&
                  approach.leader.actor->speed_mps < kStanding_mps;
  const bool ends_it = !choice.queues && ends_deadlock(view, *approach.self, choice.waits_for);
  choice.stop = ends_it ? choice.lets_go != kNoCar : choice.stop;
  const double end_m = after < way.size() ? way[after].start_m : way.back().start_m;
  choice.stop = choice.stop || (!approach.committed && no_room_behind(approach, end_m));
  choice.goes_first = ends_it && !choice.stop;
  return choice;
}

}  // namespace s4tp::world
