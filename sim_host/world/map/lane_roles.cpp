#include "sim_host/world/map/lane_roles.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

namespace s4tp::map {
namespace {

constexpr double kStraight_rad = 45.0 / 180.0 * std::numbers::pi;
constexpr double kTurnedRound_rad = 150.0 / 180.0 * std::numbers::pi;

const Lane& lane_at(const Network& network, LaneId lane) {
  return network.lanes[static_cast<std::size_t>(lane)];
}

/// The lane itself, or the one that a way through a junction leads to.
LaneId after_junction(const Network& network, LaneId lane) {
  for (std::size_t hops = 0; hops < network.lanes.size(); ++hops) {
    const Lane& at = lane_at(network, lane);
    if (!at.in_junction || at.successors.empty()) {
      break;
    }
    lane = at.successors.front();
  }
  return lane;
}

/// Between the end of one lane and the start of another, 0 .. pi.
double turn_rad(const Network& network, LaneId from, LaneId to) {
  const Polyline& before = lane_at(network, from).centre;
  const double turn =
      lane_at(network, to).centre.at(0.0).heading_rad - before.at(before.length_m()).heading_rad;
  return std::acos(std::clamp(std::cos(turn), -1.0, 1.0));
}

bool yields(const Network& network, LaneId lane) {
  return std::any_of(network.conflicts.begin(), network.conflicts.end(), [&](const Conflict& each) {
    return (each.first == lane && each.rule == Rule::kFirstYields) ||
           (each.second == lane && each.rule == Rule::kFirstHasPriority);
  });
}

}  // namespace

std::vector<bool> lanes_of_ours(const Network& network, const RouteGuide& guide) {
  std::vector<bool> ours(network.lanes.size(), false);
  std::deque<LaneId> open;
  const auto reach = [&](LaneId lane) {
    if (lane != kNoLane && !ours[static_cast<std::size_t>(lane)]) {
      ours[static_cast<std::size_t>(lane)] = true;
      open.push_back(lane);
    }
  };
  const LaneId count = static_cast<LaneId>(network.lanes.size());
  for (LaneId lane = 0; lane < count; ++lane) {
    if (guide.advice(lane).on_route) {
      reach(lane);
    }
  }
  while (!open.empty()) {
    const LaneId from = open.front();
    const Lane& lane = lane_at(network, from);
    open.pop_front();
    reach(lane.left);
    reach(lane.right);
    for (const LaneId next : lane.successors) {
      if (lane.in_junction || turn_rad(network, from, after_junction(network, next)) < kTurnedRound_rad) {
        reach(next);
      }
    }
  }
  for (LaneId lane = 0; lane < count; ++lane) {
    for (const LaneId next : lane_at(network, lane).successors) {
      const LaneId after = after_junction(network, next);
      if (guide.advice(after).on_route && turn_rad(network, lane, after) < kStraight_rad) {
        ours[static_cast<std::size_t>(lane)] = true;
      }
    }
  }
  return ours;
}

std::vector<int> lane_ranks(const Network& network, const RouteGuide& guide) {
  enum Rank { kRoute, kConflicting, kNeighbour, kRest };
  std::vector<int> rank(network.lanes.size(), kRest);
  const auto rank_of = [&](LaneId lane) -> int& { return rank[static_cast<std::size_t>(lane)]; };
  const auto improve = [&](LaneId lane, int to) {
    if (lane != kNoLane) {
      rank_of(lane) = std::min(rank_of(lane), to);
    }
  };
  const LaneId count = static_cast<LaneId>(network.lanes.size());
  for (LaneId lane = 0; lane < count; ++lane) {
    if (guide.advice(lane).on_route) {
      rank_of(lane) = kRoute;
    }
  }
  const auto conflicting = [&](LaneId lane) {
    improve(lane, kConflicting);
    LaneId at = lane;
    for (std::size_t hops = 0; hops < network.lanes.size(); ++hops) {
      if (!lane_at(network, at).in_junction || lane_at(network, at).predecessors.empty()) {
        break;
      }
      at = lane_at(network, at).predecessors.front();
      improve(at, kConflicting);
    }
  };
  for (const Conflict& each : network.conflicts) {
    if (rank_of(each.first) == kRoute) {
      conflicting(each.second);
    }
    if (rank_of(each.second) == kRoute) {
      conflicting(each.first);
    }
  }
  for (LaneId lane = 0; lane < count; ++lane) {
    if (rank_of(lane) <= kConflicting) {
      improve(lane_at(network, lane).left, kNeighbour);
      improve(lane_at(network, lane).right, kNeighbour);
    }
  }
  return rank;
}

bool yields_at_end(const Network& network, const RouteGuide& guide, LaneId lane) {
  const LaneId next = guide.advice(lane).next;
  const std::vector<LaneId>& all = lane_at(network, lane).successors;
  const auto must = [&](LaneId after) {
    return lane_at(network, after).in_junction && yields(network, after);
  };
  return next != kNoLane ? must(next) : std::any_of(all.begin(), all.end(), must);
}

}  // namespace s4tp::map
