#include "sim_host/world/attribution.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim_host/world/box.hpp"

namespace s4tp::world {
namespace {

constexpr double kLately_s = 3.0;
constexpr double kStanding_mps = 0.5;
constexpr double kStoodFor_s = 1.0;
constexpr double kReasonAhead_m = 15.0;  // a car or a junction this close ahead is a reason to stand

/// One of the two cars through time, newest last.
using Trace = std::vector<std::pair<double, CarState>>;

Trace trace_of(const std::vector<Snapshot>& history, int car) {
  Trace trace;
  for (const Snapshot& snapshot : history) {
    if (car == 0) {
      trace.emplace_back(snapshot.time_s, snapshot.ego);
      continue;
    }
    const auto found = std::find_if(snapshot.others.begin(), snapshot.others.end(),
                                    [&](const CarState& state) { return state.id == car; });
    if (found != snapshot.others.end()) {
      trace.emplace_back(snapshot.time_s, *found);
    }
  }
  return trace;
}

struct Visit {
  LaneId lane = kNoLane;
  double since_s = 0.0;
};

/// Lanes a car was on lately, and the ones it was about to enter.
std::vector<Visit> visits(const Network& network, const Trace& trace) {
  std::vector<Visit> result;
  const double now_s = trace.back().first;
  for (const auto& [time_s, car] : trace) {
    if (car.lane == kNoLane || time_s < now_s - kLately_s) {
      continue;
    }
    if (result.empty() || result.back().lane != car.lane) {
      result.push_back({car.lane, time_s});
    }
  }
  if (!result.empty()) {
    const NetworkLane& last = network.lanes[static_cast<std::size_t>(result.back().lane)];
    if (!last.in_junction && last.successors.size() == 1) {
      result.push_back({last.successors.front(), now_s + 1.0});
    }
  }
  return result;
}

std::optional<Verdict> junction_rows(const Network& network, const Trace& ego, const Trace& other) {
  std::optional<Verdict> verdict;
  for (const Visit& ours : visits(network, ego)) {
    for (const Visit& theirs : visits(network, other)) {
      for (const NetworkConflict& c : network.conflicts) {
        const bool ours_first = c.first == ours.lane && c.second == theirs.lane;
        if (!ours_first && !(c.first == theirs.lane && c.second == ours.lane)) {
          continue;
        }
        if (c.rule == Rule::kFirstCome) {
          const bool we_later = ours.since_s >= theirs.since_s;
          verdict = Verdict{we_later ? Fault::kEgo : Fault::kOther, "entered after the other"};
          continue;
        }
        const bool we_yield = (c.rule == Rule::kFirstYields) == ours_first;
        return we_yield ? Verdict{Fault::kEgo, "entered without priority"}
                        : Verdict{Fault::kOther, "failed to yield to us"};
      }
    }
  }
  return verdict;
}

bool beside(const Network& network, LaneId from, LaneId to) {
  return from != kNoLane && to != kNoLane &&
         (network.lanes[static_cast<std::size_t>(from)].left == to ||
          network.lanes[static_cast<std::size_t>(from)].right == to);
}

bool changed_lane_lately(const Network& network, const Trace& trace) {
  for (std::size_t i = 1; i < trace.size(); ++i) {
    if (trace[i].first >= trace.back().first - kLately_s &&
        beside(network, trace[i - 1].second.lane, trace[i].second.lane)) {
      return true;
    }
  }
  return false;
}

bool over_the_line(const Network& network, const CarState& car) {
  if (car.lane == kNoLane) {
    return true;
  }
  const NetworkLane& lane = network.lanes[static_cast<std::size_t>(car.lane)];
  for (const Vec2 corner : corners(box_of(car))) {
    if (std::abs(lane.centre.project(corner).d_m) > 0.5 * lane.width_m + 0.05) {
      return true;
    }
  }
  return false;
}

bool left_its_lane(const Network& network, const Trace& trace) {
  return over_the_line(network, trace.back().second) || changed_lane_lately(network, trace);
}

bool stands_without_reason(const Network& network, const std::vector<Snapshot>& history) {
  const Snapshot& now = history.back();
  for (const Snapshot& snapshot : history) {
    if (snapshot.time_s >= now.time_s - kStoodFor_s && snapshot.ego.speed_mps > kStanding_mps) {
      return false;
    }
  }
  const double c = std::cos(now.ego.heading_rad);
  const double s = std::sin(now.ego.heading_rad);
  for (const CarState& car : now.others) {
    const double dx = car.centre.x - now.ego.centre.x;
    const double dy = car.centre.y - now.ego.centre.y;
    const double ahead = c * dx + s * dy;
    if (ahead > 0.0 && ahead < kReasonAhead_m && std::abs(c * dy - s * dx) < 2.0) {
      return false;
    }
  }
  if (now.ego.lane == kNoLane) {
    return true;
  }
  const NetworkLane& lane = network.lanes[static_cast<std::size_t>(now.ego.lane)];
  const bool junction_next = std::any_of(lane.successors.begin(), lane.successors.end(), [&](LaneId id) {
    return network.lanes[static_cast<std::size_t>(id)].in_junction;
  });
  return !junction_next || lane.centre.length_m() - lane.centre.project(now.ego.centre).s_m > kReasonAhead_m;
}

}  // namespace

Verdict attribute(const Network& network, const std::vector<Snapshot>& history, int other) {
  const Trace ours = trace_of(history, 0);
  const Trace theirs = trace_of(history, other);
  if (ours.empty() || theirs.empty()) {
    return {Fault::kEgo, "unclear"};
  }
  if (const std::optional<Verdict> verdict = junction_rows(network, ours, theirs)) {
    return *verdict;
  }
  const CarState& ego = ours.back().second;
  const CarState& car = theirs.back().second;
  const double dx = car.centre.x - ego.centre.x;
  const double dy = car.centre.y - ego.centre.y;
  const double ahead = std::cos(ego.heading_rad) * dx + std::sin(ego.heading_rad) * dy;
  const double left = std::cos(ego.heading_rad) * dy - std::sin(ego.heading_rad) * dx;
  const double length_overlap = 0.5 * (ego.length_m + car.length_m) - std::abs(ahead);
  const double width_overlap = 0.5 * (ego.width_m + car.width_m) - std::abs(left);
  if (length_overlap <= width_overlap) {  // nose to tail
    if (ahead < 0.0) {
      if (changed_lane_lately(network, ours)) {
        return {Fault::kEgo, "cut in"};
      }
      return stands_without_reason(network, history) ? Verdict{Fault::kEgo, "stopped in a live lane"}
                                                     : Verdict{Fault::kOther, "rear-ended by"};
    }
    return changed_lane_lately(network, theirs) && !changed_lane_lately(network, ours)
               ? Verdict{Fault::kOther, "cut in by"}
               : Verdict{Fault::kEgo, "ran into"};
  }
  return left_its_lane(network, theirs) && !left_its_lane(network, ours)
             ? Verdict{Fault::kOther, "changed lane into us"}
             : Verdict{Fault::kEgo, "changed lane into"};
}

}  // namespace s4tp::world
