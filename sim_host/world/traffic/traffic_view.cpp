#include "sim_host/world/traffic/traffic_view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace s4tp::traffic {
namespace {

constexpr double kSight_m = 120.0;
constexpr std::size_t kWayPartsMax = 10;
constexpr int kLanesBack = 3;
constexpr double kAsFar_m = 1000.0;    // beyond it nobody asks whether two lanes have parted
constexpr double kSideBySide_m = 2.3;  // two car widths and half a metre: no longer in each other's way

bool meet(const map::Lane& a, const map::Lane& b) {
  return std::any_of(a.successors.begin(), a.successors.end(), [&](map::LaneId next) {
    return std::find(b.successors.begin(), b.successors.end(), next) != b.successors.end();
  });
}

double apart_m(const map::Polyline& a, const map::Polyline& b) {
  const double shorter = std::min({a.length_m(), b.length_m(), kAsFar_m});
  for (double s = 0.0; s < shorter; s += 0.5) {
    if (std::abs(b.project(a.at(s).point).d_m) > kSideBySide_m) {
      return s;
    }
  }
  return shorter;
}

map::Rule turned(map::Rule rule) {
  if (rule == map::Rule::kFirstCome) {
    return rule;
  }
  return rule == map::Rule::kFirstYields ? map::Rule::kFirstHasPriority : map::Rule::kFirstYields;
}

}  // namespace

RoadIndex::RoadIndex(const map::Network& network)
    : network_(network), meetings_(network.lanes.size()), siblings_(network.lanes.size()) {
  for (const map::Conflict& c : network.conflicts) {
    const bool merging = meet(lane(c.first), lane(c.second));
    meetings_[static_cast<std::size_t>(c.first)].push_back(
        {c.second, c.rule, c.first_entry_m, c.first_exit_m, c.second_entry_m, c.second_exit_m, merging});
    meetings_[static_cast<std::size_t>(c.second)].push_back({c.first, turned(c.rule), c.second_entry_m,
                                                             c.second_exit_m, c.first_entry_m, c.first_exit_m,
                                                             merging});
  }
  for (const map::Lane& from : network.lanes) {
    for (const map::LaneId one : from.successors) {
      for (const map::LaneId other : from.successors) {
        if (one != other) add_siblings(way_across(one), way_across(other));
      }
    }
  }
}

std::vector<WayPart> RoadIndex::way_across(map::LaneId first) const {
  std::vector<WayPart> way{{first, 0.0}};
  while (lane(way.back().lane).in_junction && way.size() < kWayPartsMax) {
    const map::Lane& last = lane(way.back().lane);
    if (last.successors.size() != 1 || !lane(last.successors.front()).in_junction) break;
    way.push_back({last.successors.front(), way.back().start_m + last.centre.length_m()});
  }
  return way;
}

void RoadIndex::add_siblings(const std::vector<WayPart>& one, const std::vector<WayPart>& other) {
  const auto centre_of = [&](const std::vector<WayPart>& way) {
    std::vector<map::Vec2> points;
    for (const WayPart& part : way) {
      const std::vector<map::Vec2>& more = lane(part.lane).centre.points();
      points.insert(points.end(), more.begin(), more.end());
    }
    return map::Polyline(points);
  };
  const double parted_m = apart_m(centre_of(other), centre_of(one));
  for (const WayPart& own : one) {
    for (const WayPart& theirs : other) {
      if (own.start_m < parted_m && theirs.start_m < parted_m) {
        siblings_[static_cast<std::size_t>(own.lane)].push_back(
            {theirs.lane, parted_m - theirs.start_m, theirs.start_m - own.start_m});
      }
    }
  }
}

TrafficView::TrafficView(const RoadIndex& road, std::vector<Actor> actors)
    : road_(road), actors_(std::move(actors)), occupants_(road.network().lanes.size()) {
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    Actor& actor = actors_[i];
    if (actor.lane == map::kNoLane) {
      continue;
    }
    actor.way = way_from(actor.lane, actor.s_m, actor.guide);
    occupants_[static_cast<std::size_t>(actor.lane)].push_back({i, actor.s_m});
    for (const WayPart& part : actor.also) {
      occupants_[static_cast<std::size_t>(part.lane)].push_back({i, -part.start_m});
    }
  }
}

std::vector<WayPart> TrafficView::way_from(map::LaneId lane, double s_m, const map::RouteGuide* guide) const {
  std::vector<WayPart> way;
  double start_m = -s_m;
  while (lane != map::kNoLane && start_m < kSight_m && way.size() < kWayPartsMax) {
    way.push_back({lane, start_m});
    start_m += road_.lane(lane).centre.length_m();
    lane = guide != nullptr ? guide->advice(lane).next : map::kNoLane;
  }
  return way;
}

Leader TrafficView::leader(const std::vector<WayPart>& way, int self, double length_m, int unseen) const {
  Leader nearest;
  const auto consider = [&](const Occupant& occupant, double start_m) {
    const Actor& actor = actors_[occupant.actor];
    const double ahead_m = start_m + occupant.s_m;
    const double gap_m = ahead_m - 0.5 * (length_m + actor.length_m);
    if (actor.id != self && actor.id != unseen && ahead_m > 0.0 && gap_m < nearest.gap_m) {
      nearest = {&actor, gap_m, false};
    }
  };
  const bool inside = !way.empty() && road_.lane(way.front().lane).in_junction;
  for (const WayPart& part : way) {
    for (const Occupant& occupant : occupants(part.lane)) {
      consider(occupant, part.start_m);
    }
    for (const Sibling& sibling : road_.siblings(part.lane)) {
      for (const Occupant& occupant : occupants(sibling.lane)) {
        if (occupant.s_m - 0.5 * actors_[occupant.actor].length_m < sibling.apart_m) {
          consider(occupant, part.start_m + sibling.start_m);
        }
      }
    }
    merging_leader(part, self, unseen, inside, length_m, nearest);
  }
  return nearest;
}

/// One that is inside the junction already and reaches the common lane before us is followed at the distance it
/// will have; but a driver inside a junction has no eyes for the ego coming from the side.
void TrafficView::merging_leader(const WayPart& part, int self, int unseen, bool inside, double length_m,
                                 Leader& nearest) const {
  const double own_end_m = part.start_m + road_.lane(part.lane).centre.length_m();
  for (const Meeting& meeting : road_.meetings(part.lane)) {
    if (!meeting.merging) {
      continue;
    }
    for (const Actor& actor : actors_) {
      if (actor.id == self || actor.id == unseen || actor.way.empty() ||
          !road_.lane(actor.lane).in_junction || (inside && actor.id == 0)) {
        continue;
      }
      for (const WayPart& theirs : actor.way) {
        const double their_end_m = theirs.start_m + road_.lane(theirs.lane).centre.length_m();
        const double ahead_m = own_end_m - their_end_m;
        const double gap_m = ahead_m - 0.5 * (length_m + actor.length_m);
        if (theirs.lane == meeting.other && (ahead_m > 0.0 || (ahead_m == 0.0 && actor.id < self)) &&
            gap_m < nearest.gap_m) {
          nearest = {&actor, gap_m, true};
        }
      }
    }
  }
}

Leader TrafficView::follower(map::LaneId lane, double s_m, int self, double length_m) const {
  struct Reach {
    map::LaneId lane = map::kNoLane;
    double start_m = 0.0;  ///< how far the place lies ahead of the lane's start
    int back = 0;
  };
  Leader nearest;
  std::vector<Reach> open{{lane, s_m, 0}};
  while (!open.empty()) {
    const Reach here = open.back();
    open.pop_back();
    for (const Occupant& occupant : occupants(here.lane)) {
      const Actor& actor = actors_[occupant.actor];
      const double behind_m = here.start_m - occupant.s_m;
      const double gap_m = behind_m - 0.5 * (length_m + actor.length_m);
      if (actor.id != self && behind_m >= 0.0 && gap_m < nearest.gap_m) {
        nearest = {&actor, gap_m, false};
      }
    }
    for (const map::LaneId before : road_.lane(here.lane).predecessors) {
      if (here.back < kLanesBack && here.start_m < kSight_m) {
        open.push_back({before, here.start_m + road_.lane(before).centre.length_m(), here.back + 1});
      }
    }
  }
  return nearest;
}

}  // namespace s4tp::traffic
