#include "sim_host/world/traffic/traffic_junction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace s4tp::traffic {
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
constexpr double kCourtesyAfter_s = 5.0;  // of waiting
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
    return occupation;  // it cannot come before the one ahead of it has gone
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
    // One that stands inside the junction, but short of the ground shared, waits there: nobody waits for it.
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

bool gap_accepted(const Approach& approach, map::Rule rule, const OwnTimes& own, const Actor& other,
                  Occupation theirs) {
  if (rule == map::Rule::kFirstCome && other.speed_mps < kStanding_mps && !theirs.inside_junction) {
    theirs.from_s += 0.5 * std::max(0.0, approach.waited_s - kPatience_s);
  }
  const double margin_s = accepted_margin_s(*approach.driver, approach.waited_s);
  return own.out_s + margin_s < theirs.from_s ||
         own.in_s > theirs.until_s + kBehindOther * approach.driver->reaction_s;
}

bool must_wait(const Approach& approach, const Meeting& meeting, const OwnTimes& own, const Actor& other,
               const Occupation& theirs) {
  switch (meeting.rule) {
    case map::Rule::kFirstHasPriority:  // who stands does not start into somebody who has begun
      return approach.self->speed_mps < kStanding_mps && other.committed && other.speed_mps > kStanding_mps &&
             theirs.from_s < own.out_s && own.in_s < theirs.until_s;
    case map::Rule::kFirstYields:
      return other.lets_go != approach.self->id && !gap_accepted(approach, meeting.rule, own, other, theirs);
    case map::Rule::kFirstCome:
      break;
  }
  const bool they_first = theirs.inside_junction || theirs.from_s < own.in_s - kOrder_s ||
                          (theirs.from_s < own.in_s + kOrder_s && other.id < approach.self->id);
  return they_first && !gap_accepted(approach, meeting.rule, own, other, theirs);
}

/// Whether the other one, inside though it should have waited, will be there when we are.
bool in_the_way(const OwnTimes& own, const Occupation& theirs) {
  return theirs.inside_junction && theirs.from_s < own.out_s && own.in_s < theirs.until_s;
}

/// Whether a driver with right of way stops for somebody who has waited, and goes on doing so.
bool courteous(const Approach& approach, const Meeting& meeting, const Actor& other, double line_m) {
  if (meeting.rule != map::Rule::kFirstHasPriority || approach.committed || line_m < -0.5) {
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

/// The next junction on a way: its lanes are way[first] to way[after - 1].
struct JunctionAhead {
  std::size_t first = 0;
  std::size_t after = 0;
};

/// \return nothing: none within sight, or inside one already
std::optional<JunctionAhead> junction_ahead(const TrafficView& view, const std::vector<WayPart>& way) {
  const auto inside = [&](const WayPart& part) { return view.road().lane(part.lane).in_junction; };
  const auto first = std::find_if(way.begin(), way.end(), inside);
  if (first == way.begin() || first == way.end() || first->start_m > kLook_m) {
    return std::nullopt;
  }
  const auto after = std::find_if_not(first, way.end(), inside);
  return JunctionAhead{static_cast<std::size_t>(first - way.begin()),
                       static_cast<std::size_t>(after - way.begin())};
}

/// Ground on the way that another lane shares, from the box centre.
struct SharedGround {
  const Meeting& meeting;
  double in_m;
  double out_m;
  bool before_line;  ///< begins before the stop line
};

/// What one vehicle that comes over shared ground adds to the choice: somebody to let go, to wait for, or to brake for.
void heed_vehicle(const Approach& approach, const SharedGround& ground, const OwnTimes& own,
                  const Actor& other, const Occupation& theirs, JunctionChoice& choice) {
  if (courteous(approach, ground.meeting, other, choice.line_m)) {
    choice.stop = true;
    choice.lets_go = other.id;
  }
  const double room_m = ground.in_m - kLineRoom_m;
  if (!approach.committed && must_wait(approach, ground.meeting, own, other, theirs)) {
    choice.stop = true;
    choice.waits_for.push_back(other.id);
    if (ground.before_line) {
      choice.line_m = std::min(choice.line_m, room_m);
    }
    return;
  }
  const bool nearest = choice.hazard == kNoCar || room_m < choice.hazard_m;
  if (!ground.meeting.merging && ground.in_m > 0.0 && nearest && in_the_way(own, theirs)) {
    choice.hazard = other.id;
    choice.hazard_m = room_m;
  }
}

/// The same for all vehicles that come over it.
void heed_meeting(const TrafficView& view, const Approach& approach, const SharedGround& ground,
                  JunctionChoice& choice) {
  if (ground.out_m <= 0.0) {
    return;
  }
  const OwnTimes own = own_times(approach, ground.in_m, ground.out_m);
  for (const Actor& other : view.actors()) {
    if (other.id == approach.self->id || other.way.empty()) {
      continue;
    }
    const Occupation theirs = occupation_of(view, other, ground.meeting);
    if (theirs.coming) {
      heed_vehicle(approach, ground, own, other, theirs, choice);
    }
  }
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
  const std::optional<JunctionAhead> junction = junction_ahead(view, way);
  if (!junction) {
    return choice;
  }
  choice.near = true;
  choice.line_m = way[junction->first].start_m - 0.5 * approach.self->length_m - kLineRoom_m;
  for (std::size_t i = junction->first - 1; i < std::min(junction->after + 1, way.size()); ++i) {
    for (const Meeting& meeting : view.road().meetings(way[i].lane)) {
      heed_meeting(
          view, approach,
          {meeting, way[i].start_m + meeting.entry_m, way[i].start_m + meeting.exit_m, i < junction->first},
          choice);
    }
  }
  choice.queues = approach.leader.gap_m < choice.line_m && approach.self->speed_mps < kStanding_mps &&
                  approach.leader.actor->speed_mps < kStanding_mps;
  const bool ends_it = !choice.queues && ends_deadlock(view, *approach.self, choice.waits_for);
  choice.stop = ends_it ? choice.lets_go != kNoCar : choice.stop;
  const double end_m = junction->after < way.size() ? way[junction->after].start_m : way.back().start_m;
  choice.stop = choice.stop || (!approach.committed && no_room_behind(approach, end_m));
  choice.goes_first = ends_it && !choice.stop;
  return choice;
}

}  // namespace s4tp::traffic
