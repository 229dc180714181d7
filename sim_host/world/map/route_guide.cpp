#include <algorithm>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sim_host/world/map/network.hpp"

namespace s4tp::map {
namespace {

/// A way from a lane of one edge of the route to a lane of the next.
struct Onward {
  std::vector<LaneId> inside;
  LaneId to = kNoLane;
};

/// Bookkeeping of a lane beside its advice.
struct Plan {
  bool leads_on = false;
  int changes_ahead = 0;  ///< lane changes from here to the goal after this edge, at least
};

class Builder {
 public:
  Builder(const Network& network, std::vector<RouteGuide::Advice>& advice)
      : network_(network), advice_(advice), plan_(network.lanes.size()) {}

  /// \pre goal_lane is one of `lanes` or kNoLane
  void last_edge(const std::vector<LaneId>& lanes, LaneId goal_lane, double goal_s_m) {
    for (const LaneId id : lanes) {
      const bool is_goal = goal_lane == kNoLane || id == goal_lane;
      plan(id) = {is_goal, 0};
      RouteGuide::Advice& advice = advice_of(id);
      advice.on_route = true;
      advice.remaining_m = is_goal ? length(id) : std::min(goal_s_m, length(id));
      advice.goal_distance_m = goal_s_m;
    }
    advise_changes(lanes);
  }

  /// \return whether any lane leads to the next edge
  bool edge_before(const std::vector<LaneId>& lanes, const std::string& next_edge) {
    bool any = false;
    for (const LaneId id : lanes) {
      plan(id) = {false, std::numeric_limits<int>::max() / 4};
      RouteGuide::Advice& advice = advice_of(id);
      advice = {true, 0, length(id), length(id), kNoLane};
      for (const LaneId first : lane(id).successors) {
        const Onward way = onward(first, next_edge);
        if (way.to == kNoLane) {
          continue;
        }
        any = true;
        advise_inside(way);
        // Of several ways the one with the fewest changes to come, then the one that goes on furthest.
        const int changes = plan(way.to).changes_ahead + std::abs(advice_of(way.to).changes_needed);
        const RouteGuide::Advice& entered = advice_of(first);
        const double remaining = length(id) + entered.remaining_m;
        if (!plan(id).leads_on || changes < plan(id).changes_ahead ||
            (changes == plan(id).changes_ahead && remaining > advice.remaining_m)) {
          plan(id) = {true, changes};
          advice.remaining_m = remaining;
          advice.goal_distance_m = length(id) + entered.goal_distance_m;
          advice.next = first;
        }
      }
    }
    advise_changes(lanes);
    return any;
  }

 private:
  const Lane& lane(LaneId id) const { return network_.lanes[static_cast<std::size_t>(id)]; }
  double length(LaneId id) const { return lane(id).centre.length_m(); }
  RouteGuide::Advice& advice_of(LaneId id) { return advice_[static_cast<std::size_t>(id)]; }
  Plan& plan(LaneId id) { return plan_[static_cast<std::size_t>(id)]; }

  Onward onward(LaneId first, const std::string& edge) const {
    Onward way;
    LaneId at = first;
    while (lane(at).in_junction && way.inside.size() < network_.lanes.size()) {
      way.inside.push_back(at);
      if (lane(at).successors.empty()) {
        return {};
      }
      at = lane(at).successors.front();
    }
    way.to = lane(at).edge == edge ? at : kNoLane;
    return way;
  }

  void advise_inside(const Onward& way) {
    RouteGuide::Advice after = advice_of(way.to);
    LaneId next = way.to;
    for (auto inside = way.inside.rbegin(); inside != way.inside.rend(); ++inside) {
      after = {true, after.changes_needed, length(*inside) + after.remaining_m,
               length(*inside) + after.goal_distance_m, next};
      advice_of(*inside) = after;
      next = *inside;
    }
  }

  /// Sends each lane to the one with the fewest changes in all; of equals to the furthest, so that a driver
  /// knows early what is to come.
  void advise_changes(const std::vector<LaneId>& lanes) {
    std::vector<std::pair<int, int>> best(lanes.size(), {0, std::numeric_limits<int>::max()});
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      for (std::size_t j = 0; j < lanes.size(); ++j) {
        const int changes = static_cast<int>(j) - static_cast<int>(i);
        const int total = std::abs(changes) + plan(lanes[j]).changes_ahead;
        if (plan(lanes[j]).leads_on &&
            (total < best[i].second ||
             (total == best[i].second && std::abs(changes) > std::abs(best[i].first)))) {
          best[i] = {changes, total};
        }
      }
    }
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      RouteGuide::Advice& advice = advice_of(lanes[i]);
      advice.changes_needed = best[i].first;
      if (!plan(lanes[i]).leads_on) {
        const std::size_t leading = static_cast<std::size_t>(static_cast<int>(i) + best[i].first);
        advice.goal_distance_m = advice_of(lanes[leading]).goal_distance_m;
      }
    }
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      plan(lanes[i]).changes_ahead = std::max(0, best[i].second - std::abs(best[i].first));
    }
  }

  const Network& network_;
  std::vector<RouteGuide::Advice>& advice_;
  std::vector<Plan> plan_;
};

}  // namespace

RouteGuide::RouteGuide(const Network& network, std::vector<std::string> edges, LaneId goal_lane,
                       double goal_s_m) {
  if (edges.empty()) {
    throw std::runtime_error("a route needs at least one edge");
  }
  std::vector<Advice> of_all(network.lanes.size());
  Builder builder(network, of_all);
  for (std::size_t i = edges.size(); i-- > 0;) {
    const std::vector<LaneId> lanes = network.lanes_of(edges[i]);
    if (lanes.empty()) {
      throw std::runtime_error("route: the network has no edge \"" + edges[i] + "\" that cars may use");
    }
    if (i + 1 == edges.size()) {
      if (goal_lane != kNoLane && std::find(lanes.begin(), lanes.end(), goal_lane) == lanes.end()) {
        throw std::runtime_error("route: the goal lane is not one of its last edge \"" + edges[i] + "\"");
      }
      builder.last_edge(lanes, goal_lane, goal_s_m);
    } else if (!builder.edge_before(lanes, edges[i + 1])) {
      throw std::runtime_error("route: no lane leads from edge \"" + edges[i] + "\" to \"" + edges[i + 1] +
                               "\"");
    }
  }
  for (std::size_t lane = 0; lane < of_all.size(); ++lane) {
    if (of_all[lane].on_route) {
      lanes_.push_back(static_cast<LaneId>(lane));
      advice_.push_back(of_all[lane]);
    }
  }
}

const RouteGuide::Advice& RouteGuide::advice(LaneId lane) const {
  static const Advice off_route;
  const auto found = std::lower_bound(lanes_.begin(), lanes_.end(), lane);
  return found == lanes_.end() || *found != lane ? off_route
                                                 : advice_[static_cast<std::size_t>(found - lanes_.begin())];
}

}  // namespace s4tp::map
