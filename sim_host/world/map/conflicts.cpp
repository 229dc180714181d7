/// Where two ways through a junction share ground. Each way is followed with a car's box from a little before
/// the junction to a little after it; wherever two boxes touch, both lanes' arc lengths belong to the zone.

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
constexpr double kSpare_m = 0.1;  // all around it, between links the network calls foes
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
  Box box;
};

/// Separating axes: do not touch if the boxes are apart along any of their four sides' normals.
bool touch(const Box& a, const Box& b, double spare_m) {
  const double half_length = kHalfLength_m + spare_m;
  const double half_width = kHalfWidth_m + spare_m;
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

/// So many places further on the boxes cannot touch yet, as a place is at most a step from the next.
std::size_t steps_apart(const Box& a, const Box& b) {
  const double gap_m = std::hypot(b.centre.x - a.centre.x, b.centre.y - a.centre.y) -
                       2.0 * std::hypot(kHalfLength_m + kSpare_m, kHalfWidth_m + kSpare_m);
  return gap_m > 0.0 ? static_cast<std::size_t>(gap_m / kStep_m) : 0;
}

const Lane& lane_at(const std::vector<Lane>& lanes, LaneId lane) {
  return lanes[static_cast<std::size_t>(lane)];
}

void append_places(const std::vector<Lane>& lanes, LaneId lane, double from_m, double to_m,
                   std::vector<Place>& places) {
  const Polyline& centre = lane_at(lanes, lane).centre;
  const int steps = std::max(1, static_cast<int>(std::ceil((to_m - from_m) / kStep_m)));
  for (int i = 0; i <= steps; ++i) {
    const double s = from_m + (to_m - from_m) * i / steps;
    const PolylinePose pose = centre.at(s);
    places.push_back({lane, s, {pose.point, std::cos(pose.heading_rad), std::sin(pose.heading_rad)}});
  }
}

std::vector<Place> places_along(const std::vector<Lane>& lanes, const Link& link) {
  std::vector<Place> places;
  const auto length = [&](LaneId lane) { return lane_at(lanes, lane).centre.length_m(); };
  append_places(lanes, link.from, std::max(0.0, length(link.from) - kReach_m), length(link.from), places);
  for (const LaneId inside : link.inside) {
    append_places(lanes, inside, 0.0, length(inside), places);
  }
  append_places(lanes, link.to, 0.0, std::min(length(link.to), kReach_m), places);
  return places;
}

bool foes(const Link& first, std::size_t second_index) {
  return second_index < first.foes.size() && first.foes[second_index];
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
              const std::vector<Place>& second, Rule rule, double spare_m) {
  Found found;
  for (const Place& a : first) {
    for (std::size_t k = 0; k < second.size(); k += 1 + steps_apart(a.box, second[k].box)) {
      const Place& b = second[k];
      if (!touch(a.box, b.box, spare_m) || joined(lanes, a.lane, b.lane) ||
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
      // Ways that merely graze each other with room to spare are no conflict unless the network says so.
      const double spare_m = foes(first, j) || foes(second, i) ? kSpare_m : 0.0;
      merge_into(all, touches(lanes, places[i], places[j], rule, spare_m));
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
