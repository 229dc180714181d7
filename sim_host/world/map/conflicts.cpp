/// Where two ways through a junction share ground. Each way is followed with a car's box from a little before
/// the junction to a little after it; wherever two boxes touch, both lanes' arc lengths belong to the zone.
/// In a bend a car's box lies along the lane's centre line at its middle, or with both ends on the line as drawn
/// (as SUMO moves cars) and so further in: ours and theirs. One of two at most does the latter.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "sim_host/world/map/junction_links.hpp"

namespace s4tp::map {
namespace {

constexpr double kStep_m = 0.25;
constexpr double kHalfLength_m = 0.5 * 5.0;  // the box of a usual car
constexpr double kHalfWidth_m = 0.5 * 1.8;
constexpr double kSpare_m = 0.1;  // all around it: nobody is exactly on the line
constexpr double kReach_m = 4.0;  ///< before and after the junction: a car's nose or tail is still inside

struct Box {
  Vec2 centre;
  double cos_heading = 1.0;
  double sin_heading = 0.0;
};

/// A car's place on a link.
struct Place {
  LaneId lane = kNoLane;
  double s_m = 0.0;
  Box along;  ///< the centre line at its middle
  Box chord;  ///< both ends on the line as drawn
};

/// Separating axes: do not touch if the boxes are apart along any of their four sides' normals.
bool touch(const Box& a, const Box& b) {
  const double half_length = kHalfLength_m + kSpare_m;
  const double half_width = kHalfWidth_m + kSpare_m;
  const double dx = b.centre.x - a.centre.x;
  const double dy = b.centre.y - a.centre.y;
  const double diagonal = 2.0 * std::hypot(half_length, half_width);
  if (dx * dx + dy * dy > diagonal * diagonal) {
    return false;
  }
  const double cosine = std::abs(a.cos_heading * b.cos_heading + a.sin_heading * b.sin_heading);
  const double sine = std::abs(a.cos_heading * b.sin_heading - a.sin_heading * b.cos_heading);
  const double along = half_length + half_length * cosine + half_width * sine;
  const double across = half_width + half_length * sine + half_width * cosine;
  for (const Box& frame : {a, b}) {
    if (std::abs(dx * frame.cos_heading + dy * frame.sin_heading) > along ||
        std::abs(dy * frame.cos_heading - dx * frame.sin_heading) > across) {
      return false;
    }
  }
  return true;
}

bool touch(const Place& a, const Place& b) {
  return touch(a.along, b.along) || touch(a.along, b.chord) || touch(a.chord, b.along);
}

/// So many places further on the boxes cannot touch yet, as a place is at most a step from the next.
std::size_t steps_apart(const Place& a, const Place& b) {
  // One of the two may be a chord: it is within half a car of the line drawn, and that of the centre line.
  const double gap_m = std::hypot(b.along.centre.x - a.along.centre.x, b.along.centre.y - a.along.centre.y) -
                       2.0 * (std::hypot(kHalfLength_m + kSpare_m, kHalfWidth_m + kSpare_m) + kHalfLength_m);
  return gap_m > 0.0 ? static_cast<std::size_t>(gap_m / kStep_m) : 0;
}

const Lane& lane_at(const std::vector<Lane>& lanes, LaneId lane) {
  return lanes[static_cast<std::size_t>(lane)];
}

Box box_at(const PolylinePose& pose) {
  return {pose.point, std::cos(pose.heading_rad), std::sin(pose.heading_rad)};
}

double distance_m(Vec2 a, Vec2 b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

/// Front first: where the line bends back the rear sticks out. \return `folded` where the two are one place
Box box_between(Vec2 rear, Vec2 front, const Box& folded) {
  const double length_m = distance_m(rear, front);
  if (length_m < kStep_m) {
    return folded;
  }
  const Vec2 ahead{(front.x - rear.x) / length_m, (front.y - rear.y) / length_m};
  return {{front.x - kHalfLength_m * ahead.x, front.y - kHalfLength_m * ahead.y}, ahead.x, ahead.y};
}

/// \param way      through the junction
/// \param start_m  of the lane on it
void append_places(const std::vector<Lane>& lanes, const Polyline& way, double start_m, LaneId lane,
                   double from_m, double to_m, std::vector<Place>& places) {
  const Polyline& centre = lane_at(lanes, lane).centre;
  const double drawn_share = lane_at(lanes, lane).drawn.length_m() / centre.length_m();
  const int steps = std::max(1, static_cast<int>(std::ceil((to_m - from_m) / kStep_m)));
  for (int i = 0; i <= steps; ++i) {
    const double s_m = from_m + (to_m - from_m) * i / steps;
    const double way_m = start_m + s_m * drawn_share;
    const Box along = box_at(centre.at(s_m));
    const Box chord =
        box_between(way.at(way_m - kHalfLength_m).point, way.at(way_m + kHalfLength_m).point, along);
    places.push_back({lane, s_m, along, chord});
  }
}

std::vector<Place> places_along(const std::vector<Lane>& lanes, const Link& link) {
  const auto length = [&](LaneId lane) { return lane_at(lanes, lane).centre.length_m(); };
  std::vector<LaneId> all{link.from};
  all.insert(all.end(), link.inside.begin(), link.inside.end());
  all.push_back(link.to);
  std::vector<Vec2> points;
  std::vector<double> starts_m;  // of the lanes on the way: what lies between two is part of it
  for (const LaneId lane : all) {
    const std::vector<Vec2>& more = lane_at(lanes, lane).drawn.points();
    const double before_m =
        points.empty() ? 0.0 : starts_m.back() + lane_at(lanes, all[starts_m.size() - 1]).drawn.length_m();
    starts_m.push_back(points.empty() ? 0.0 : before_m + distance_m(points.back(), more.front()));
    points.insert(points.end(), more.begin(), more.end());
  }
  const Polyline way(points);
  std::vector<Place> places;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double from_m = i == 0 ? std::max(0.0, length(all[i]) - kReach_m) : 0.0;
    const double to_m = i + 1 == all.size() ? std::min(length(all[i]), kReach_m) : length(all[i]);
    append_places(lanes, way, starts_m[i], all[i], from_m, to_m, places);
  }
  return places;
}

Rule rule_of(const Link& first, std::size_t first_index, const Link& second, std::size_t second_index,
             bool signals) {
  const auto yields = [](const Link& link, std::size_t other) {
    return other < link.yields_to.size() && link.yields_to[other];
  };
  const bool first_yields = yields(first, second_index);
  const bool second_yields = yields(second, first_index);
  if (signals && first_yields && second_yields && first.priority != second.priority) {
    return first.priority < second.priority ? Rule::kFirstYields : Rule::kFirstHasPriority;
  }
  if (first_yields == second_yields) {  // zipper, right before left all round, or nothing said
    return Rule::kFirstCome;
  }
  return first_yields ? Rule::kFirstYields : Rule::kFirstHasPriority;
}

/// Cars that follow each other or drive side by side keep apart by themselves: no conflict.
bool follow_or_accompany(const std::vector<Lane>& lanes, const Link& first, const Link& second) {
  const auto edge = [&](LaneId lane) -> const std::string& { return lane_at(lanes, lane).edge; };
  return first.from == second.from || (edge(first.from) == edge(second.from) &&
                                       edge(first.to) == edge(second.to) && first.to != second.to);
}

bool joined(const std::vector<Lane>& lanes, LaneId first, LaneId second) {
  const auto leads_to = [&](LaneId from, LaneId to) {
    const std::vector<LaneId>& successors = lane_at(lanes, from).successors;
    return std::find(successors.begin(), successors.end(), to) != successors.end();
  };
  return first == second || leads_to(first, second) || leads_to(second, first);
}

using Found = std::map<std::pair<LaneId, LaneId>, Conflict>;

void add_touch(Found& found, const Place& a, const Place& b, Rule rule) {
  const auto [entry, is_new] = found.try_emplace({a.lane, b.lane});
  Conflict& conflict = entry->second;
  if (is_new) {
    conflict = {a.lane, b.lane, rule, a.s_m, a.s_m, b.s_m, b.s_m};
  }
  conflict.first_entry_m = std::min(conflict.first_entry_m, a.s_m);
  conflict.first_exit_m = std::max(conflict.first_exit_m, a.s_m);
  conflict.second_entry_m = std::min(conflict.second_entry_m, b.s_m);
  conflict.second_exit_m = std::max(conflict.second_exit_m, b.s_m);
}

/// The same two lanes met on several links (a lane before the junction serves them all): one zone, and the
/// rules must agree to stay sharper than first come.
void merge_into(Found& all, const Found& of_pair) {
  for (const auto& [lanes, conflict] : of_pair) {
    const auto [entry, is_new] = all.try_emplace(lanes, conflict);
    if (!is_new) {
      Conflict& known = entry->second;
      known.rule = known.rule == conflict.rule ? known.rule : Rule::kFirstCome;
      known.first_entry_m = std::min(known.first_entry_m, conflict.first_entry_m);
      known.first_exit_m = std::max(known.first_exit_m, conflict.first_exit_m);
      known.second_entry_m = std::min(known.second_entry_m, conflict.second_entry_m);
      known.second_exit_m = std::max(known.second_exit_m, conflict.second_exit_m);
    }
  }
}

Rule seen_from_the_other(Rule rule) {
  switch (rule) {
    case Rule::kFirstYields:
      return Rule::kFirstHasPriority;
    case Rule::kFirstHasPriority:
      return Rule::kFirstYields;
    case Rule::kFirstCome:
      break;
  }
  return Rule::kFirstCome;
}

/// Where the boxes of vehicles on two links of a junction touch.
Found touches(const std::vector<Lane>& lanes, const std::vector<Place>& first,
              const std::vector<Place>& second, Rule rule) {
  Found found;
  for (const Place& a : first) {
    for (std::size_t k = 0; k < second.size(); k += 1 + steps_apart(a, second[k])) {
      const Place& b = second[k];
      if (!touch(a, b) || joined(lanes, a.lane, b.lane) ||
          !(lane_at(lanes, a.lane).in_junction || lane_at(lanes, b.lane).in_junction)) {
        continue;
      }
      a.lane < b.lane ? add_touch(found, a, b, rule) : add_touch(found, b, a, seen_from_the_other(rule));
    }
  }
  return found;
}

void add_conflicts(Found& all, const std::vector<Lane>& lanes, const Junction& junction) {
  std::vector<std::vector<Place>> places;
  for (const Link& link : junction.links) {
    places.push_back(link.from == kNoLane ? std::vector<Place>{} : places_along(lanes, link));
  }
  for (std::size_t i = 0; i < junction.links.size(); ++i) {
    for (std::size_t j = i + 1; j < junction.links.size(); ++j) {
      const Link& first = junction.links[i];
      const Link& second = junction.links[j];
      if (places[i].empty() || places[j].empty() || follow_or_accompany(lanes, first, second)) {
        continue;
      }
      const Rule rule =
          junction.first_come ? Rule::kFirstCome : rule_of(first, i, second, j, junction.signals);
      merge_into(all, touches(lanes, places[i], places[j], rule));
    }
  }
}

}  // namespace

std::vector<Conflict> find_conflicts(const std::vector<Lane>& lanes, const std::vector<Junction>& junctions) {
  Found all;
  for (const Junction& junction : junctions) {
    add_conflicts(all, lanes, junction);
  }
  std::vector<Conflict> conflicts;
  for (const auto& entry : all) {
    conflicts.push_back(entry.second);
  }
  return conflicts;
}

}  // namespace s4tp::map
