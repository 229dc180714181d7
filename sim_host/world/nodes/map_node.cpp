#include "sim_host/world/nodes/map_node.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "sim_host/world/map/lane_roles.hpp"

namespace s4tp::nodes {
namespace {

constexpr double kTolerance_m = 0.03;
constexpr double kMaxPart_m = 250.0;
// Where a lane bends more often than that many parts can follow, they follow it as well as they can.
constexpr int kMostPerLane = 16;
constexpr int kMostPerPart = 4;  // of 250 m
constexpr double kHysteresis_m = 10.0;
constexpr double kMaxWidth_m = 6.3;  // s4tp.dbc's ranges
constexpr double kMaxSpeed_mps = 63.75;
constexpr double kMaxRoute_m = 6553.5;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

double distance_to(const map::Polyline& line, map::Vec2 point) {
  const double s = std::clamp(line.project(point).s_m, 0.0, line.length_m());
  const map::Vec2 nearest = line.at(s).point;
  return std::hypot(nearest.x - point.x, nearest.y - point.y);
}

/// Keeps the slots of those still wanted, frees the others, and gives the new ones the lowest free slots.
void reassign(std::map<int, int>& slots, const std::vector<int>& wanted, int slot_count) {
  const std::set<int> keep(wanted.begin(), wanted.end());
  std::erase_if(slots, [&](const auto& held) { return keep.count(held.first) == 0; });
  std::vector<bool> taken(index(slot_count), false);
  for (const auto& held : slots) {
    taken[index(held.second)] = true;
  }
  for (const int item : wanted) {
    if (slots.count(item) == 0) {
      const auto free = std::find(taken.begin(), taken.end(), false);
      slots[item] = static_cast<int>(free - taken.begin());
      *free = true;
    }
  }
}

}  // namespace

MapNode::MapNode(const map::Network& network, const map::RouteGuide& guide, map::Vec2 origin,
                 double horizon_m)
    : network_(network), guide_(guide), origin_(origin), horizon_m_(horizon_m) {
  split_into_parts();
  split_conflicts();
}

const wire::Map& MapNode::update(map::Vec2 position) {
  choose_lanes(position);
  choose_conflicts();
  return map_;
}

void MapNode::split_into_parts() {
  const std::vector<bool> ours = map::lanes_of_ours(network_, guide_);
  const std::vector<int> ranks = map::lane_ranks(network_, guide_);
  for (std::size_t i = 0; i < network_.lanes.size(); ++i) {
    const map::Polyline& centre = network_.lanes[i].centre;
    std::vector<map::Polyline> lines;
    const int fewest = static_cast<int>(std::ceil(centre.length_m() / kMaxPart_m));
    const int most = kMostPerLane + kMostPerPart * fewest;
    for (int count = fewest;; count = std::min(most, count + std::max(1, count / 8))) {
      const int points = count < most ? std::numeric_limits<int>::max() : wire::kMaxLanePoints;
      lines.clear();
      bool fits = true;
      for (int k = 0; k < count && fits; ++k) {
        const double step_m = centre.length_m() / count;
        const map::Polyline whole = centre.part(k * step_m, (k + 1) * step_m);
        lines.push_back(whole.simplified(points, kTolerance_m));
        fits = lines.back().points().size() <= index(wire::kMaxLanePoints);
      }
      if (fits) {
        break;
      }
    }
    const int first = static_cast<int>(parts_.size());
    const double step_m = centre.length_m() / static_cast<double>(lines.size());
    for (std::size_t k = 0; k < lines.size(); ++k) {
      Part part;
      part.lane = static_cast<map::LaneId>(i);
      part.from_m = static_cast<double>(k) * step_m;
      part.to_m = part.from_m + step_m;
      part.scale = lines[k].length_m() / step_m;
      part.line = lines[k];
      part.rank = ranks[i];
      fill_record(part, ours[i], k + 1 == lines.size());
      parts_.push_back(std::move(part));
    }
    parts_of_lane_.emplace_back(first, static_cast<int>(parts_.size()));
  }
}

void MapNode::fill_record(Part& part, bool ours, bool last) const {
  const map::Lane& lane = network_.lanes[index(part.lane)];
  const map::RouteGuide::Advice& advice = guide_.advice(part.lane);
  const auto left_over = [&](double from_start_m) {
    return static_cast<float>(std::clamp(from_start_m - part.from_m, 0.0, kMaxRoute_m));
  };
  wire::Lane& record = part.record;
  record.present = true;
  record.kind = ours ? 0 : 1;
  record.in_junction = lane.in_junction;
  record.on_route = advice.on_route;
  record.changes_needed = static_cast<std::int8_t>(std::clamp(advice.changes_needed, -8, 7));
  record.speed_limit_mps = static_cast<float>(std::min(lane.speed_limit_mps, kMaxSpeed_mps));
  record.width_m = static_cast<float>(std::min(lane.width_m, kMaxWidth_m));
  record.route_remaining_m = left_over(advice.remaining_m);
  record.goal_distance_m = left_over(advice.goal_distance_m);
  if (last && map::yields_at_end(network_, guide_, part.lane)) {
    record.stop_line_m = static_cast<float>(part.line.length_m());
  }
  for (const map::Vec2& point : part.line.points()) {
    record.x_m[record.point_count] = static_cast<float>(point.x - origin_.x);
    record.y_m[record.point_count] = static_cast<float>(point.y - origin_.y);
    ++record.point_count;
  }
}

void MapNode::split_conflicts() {
  const auto overlaps = [](const Part& part, double entry_m, double exit_m) {
    return entry_m <= part.to_m && exit_m >= part.from_m;
  };
  const auto local = [](const Part& part, double s_m) {
    return static_cast<float>((std::clamp(s_m, part.from_m, part.to_m) - part.from_m) * part.scale);
  };
  for (const map::Conflict& each : network_.conflicts) {
    const auto [first_begin, first_end] = parts_of_lane_[index(each.first)];
    const auto [second_begin, second_end] = parts_of_lane_[index(each.second)];
    for (int i = first_begin; i < first_end; ++i) {
      for (int j = second_begin; j < second_end; ++j) {
        const Part& first = parts_[index(i)];
        const Part& second = parts_[index(j)];
        if (!overlaps(first, each.first_entry_m, each.first_exit_m) ||
            !overlaps(second, each.second_entry_m, each.second_exit_m)) {
          continue;
        }
        PartConflict conflict;
        conflict.first = i;
        conflict.second = j;
        conflict.rank = std::min(first.rank, second.rank);
        conflict.record.present = true;
        conflict.record.priority = static_cast<std::uint8_t>(each.rule);
        conflict.record.first_entry_m = local(first, each.first_entry_m);
        conflict.record.first_exit_m = local(first, each.first_exit_m);
        conflict.record.second_entry_m = local(second, each.second_entry_m);
        conflict.record.second_exit_m = local(second, each.second_exit_m);
        conflicts_.push_back(conflict);
      }
    }
  }
}

void MapNode::choose_lanes(map::Vec2 position) {
  struct Candidate {
    int part;
    int rank;
    double distance_m;  ///< those shown already count as nearer: no flicker at the edge
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const int part = static_cast<int>(i);
    const double bonus_m = slot_of_part_.count(part) != 0 ? kHysteresis_m : 0.0;
    const double distance_m = distance_to(parts_[i].line, position) - bonus_m;
    if (distance_m <= horizon_m_) {
      candidates.push_back({part, parts_[i].rank, distance_m});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.rank != b.rank ? a.rank < b.rank : a.distance_m < b.distance_m;
  });
  const std::size_t shown = std::min(candidates.size(), index(wire::kMaxLanes));
  map_.lanes_left_out = static_cast<std::uint8_t>(std::min<std::size_t>(candidates.size() - shown, 255));
  std::vector<int> wanted;
  for (std::size_t i = 0; i < shown; ++i) {
    wanted.push_back(candidates[i].part);
  }
  reassign(slot_of_part_, wanted, wire::kMaxLanes);
  std::fill(std::begin(map_.lanes), std::end(map_.lanes), wire::Lane{});
  for (const auto& [part, slot] : slot_of_part_) {
    map_.lanes[slot] = linked(part);
  }
}

void MapNode::choose_conflicts() {
  std::vector<int> wanted;
  for (std::size_t i = 0; i < conflicts_.size(); ++i) {
    if (slot_of(conflicts_[i].first) != wire::kNoLane && slot_of(conflicts_[i].second) != wire::kNoLane) {
      wanted.push_back(static_cast<int>(i));
    }
  }
  std::stable_sort(wanted.begin(), wanted.end(),
                   [&](int a, int b) { return conflicts_[index(a)].rank < conflicts_[index(b)].rank; });
  wanted.resize(std::min(wanted.size(), index(wire::kMaxConflicts)));
  reassign(slot_of_conflict_, wanted, wire::kMaxConflicts);
  std::fill(std::begin(map_.conflicts), std::end(map_.conflicts), wire::Conflict{});
  for (const auto& [conflict, slot] : slot_of_conflict_) {
    const PartConflict& each = conflicts_[index(conflict)];
    map_.conflicts[slot] = each.record;
    map_.conflicts[slot].first = slot_of(each.first);
    map_.conflicts[slot].second = slot_of(each.second);
  }
}

wire::Lane MapNode::linked(int part_number) const {
  const Part& part = parts_[index(part_number)];
  const map::Lane& lane = network_.lanes[index(part.lane)];
  wire::Lane record = part.record;
  if (part_number + 1 < parts_of_lane_[index(part.lane)].second) {
    record.successors[0] = slot_of(part_number + 1);
  } else {
    std::vector<map::LaneId> next = lane.successors;  // of more than the wire can tell, the route's own first
    std::stable_partition(next.begin(), next.end(),
                          [&](map::LaneId each) { return each == guide_.advice(part.lane).next; });
    int count = 0;
    for (const map::LaneId each : next) {
      const std::uint8_t slot = slot_of(parts_of_lane_[index(each)].first);
      if (slot != wire::kNoLane && count < 3) {
        record.successors[count++] = slot;
      }
    }
  }
  record.left = lane.left == map::kNoLane ? wire::kNoLane : slot_of(part_beside(part, lane.left));
  record.right = lane.right == map::kNoLane ? wire::kNoLane : slot_of(part_beside(part, lane.right));
  return record;
}

std::uint8_t MapNode::slot_of(int part) const {
  const auto found = slot_of_part_.find(part);
  return found == slot_of_part_.end() ? wire::kNoLane : static_cast<std::uint8_t>(found->second);
}

/// Of a neighbour in parts, the one beside the middle of ours.
int MapNode::part_beside(const Part& part, map::LaneId neighbour) const {
  const map::Vec2 middle = part.line.at(0.5 * part.line.length_m()).point;
  const double s_m = network_.lanes[index(neighbour)].centre.project(middle).s_m;
  const auto [begin, end] = parts_of_lane_[index(neighbour)];
  int beside = begin;
  while (beside + 1 < end && s_m > parts_[index(beside)].to_m) {
    ++beside;
  }
  return beside;
}

}  // namespace s4tp::nodes
