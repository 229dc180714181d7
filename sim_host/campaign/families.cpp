#include "sim_host/campaign/families.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "sim_host/metrics/clusters.hpp"
#include "sim_host/roads/generator.hpp"

namespace s4tp::campaign {
namespace {

using metrics::EpisodeMetrics;
using nlohmann::ordered_json;

constexpr const char* kAll = "all roads";

/// A road's episodes, driven by one.
using Roads = std::vector<const CellResult*>;

Cell family_cell(Cell cell) {
  cell.scenario = roads::family_of(cell.scenario);
  return cell;
}

Cell all_cell(Cell cell) {
  cell.scenario = kAll;
  return cell;
}

bool failed(const EpisodeMetrics& episode) {
  return episode.ending != traffic::Ending::kGoal;
}

double restricted_s(const EpisodeMetrics& episode) {
  return failed(episode) ? kFailureTime_s : std::min(episode.duration_s, kFailureTime_s);
}

/// Families in the order of the cells, then all of them together; a group for each other member of a cell.
template <class Item, class CellOf>
std::vector<std::pair<Cell, std::vector<Item>>> grouped(const std::vector<Item>& items,
                                                        const CellOf& cell_of) {
  std::vector<Cell> order;
  std::map<Cell, std::vector<Item>> groups;
  std::map<Cell, std::set<std::string>> families;
  for (const Item& item : items) {
    const Cell family = family_cell(cell_of(item));
    if (groups[family].empty()) order.push_back(family);
    groups[family].push_back(item);
    groups[all_cell(family)].push_back(item);
    families[all_cell(family)].insert(family.scenario);
  }
  std::vector<std::pair<Cell, std::vector<Item>>> result;
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.emplace_back(order[i], groups.at(order[i]));
    const Cell all = all_cell(order[i]);
    const bool last = i + 1 == order.size() || all_cell(order[i + 1]) != all;
    if (last && families.at(all).size() > 1) result.emplace_back(all, groups.at(all));
  }
  return result;
}

FamilyResult result_of(const Cell& like, const Roads& roads) {
  FamilyResult result;
  result.like = like;
  result.roads = static_cast<int>(roads.size());
  std::vector<EpisodeMetrics> episodes;
  std::vector<metrics::Cluster> failures;
  for (const CellResult* const road : roads) {
    metrics::Cluster cluster;
    for (const EpisodeMetrics& episode : road->episodes) {
      cluster.add(failed(episode) ? 1.0 : 0.0);
      result.restricted_mean_s += restricted_s(episode);
    }
    failures.push_back(cluster);
    episodes.insert(episodes.end(), road->episodes.begin(), road->episodes.end());
  }
  result.summary = metrics::summarize(episodes);
  result.restricted_mean_s /= static_cast<double>(episodes.size());
  result.design_effect = metrics::design_effect(failures);
  const metrics::Interval failing = metrics::clustered_wilson(failures);
  result.interval = {1.0 - failing.high, 1.0 - failing.low};
  return result;
}

using RoadPair = std::pair<const CellResult*, const CellResult*>;

FamilyPair pair_of(const Cell& like, const std::vector<RoadPair>& roads) {
  FamilyPair pair;
  pair.first = like;
  pair.second = like;
  pair.second.planner = roads.front().second->cell.planner;
  pair.second.guarded = roads.front().second->cell.guarded;
  std::vector<metrics::Cluster> differences;
  for (const auto& [first, second] : roads) {
    std::map<std::uint64_t, const EpisodeMetrics*> others;
    for (const EpisodeMetrics& episode : second->episodes) others[episode.seed] = &episode;
    metrics::Cluster cluster;
    for (const EpisodeMetrics& episode : first->episodes) {
      const auto found = others.find(episode.seed);
      if (found == others.end()) continue;
      const EpisodeMetrics& other = *found->second;
      ++pair.paired.pairs;
      pair.paired.only_first_fails += failed(episode) && !failed(other) ? 1 : 0;
      pair.paired.only_second_fails += !failed(episode) && failed(other) ? 1 : 0;
      pair.first_at_fault += episode.collisions_at_fault > 0 ? 1 : 0;
      pair.second_at_fault += other.collisions_at_fault > 0 ? 1 : 0;
      pair.first_restricted_mean_s += restricted_s(episode);
      pair.second_restricted_mean_s += restricted_s(other);
      cluster.add((failed(episode) ? 1.0 : 0.0) - (failed(other) ? 1.0 : 0.0));
    }
    if (cluster.episodes > 0) differences.push_back(cluster);
  }
  if (pair.paired.pairs == 0) return pair;
  pair.first_restricted_mean_s /= pair.paired.pairs;
  pair.second_restricted_mean_s /= pair.paired.pairs;
  pair.design_effect = metrics::design_effect(differences);
  pair.upper = metrics::difference_upper(pair.paired, pair.design_effect);
  return pair;
}

Roads with_episodes(const std::vector<CellResult>& cells) {
  Roads driven;
  for (const CellResult& cell : cells) {
    if (!cell.episodes.empty()) driven.push_back(&cell);
  }
  return driven;
}

/// Pairs of the cells that `partner` makes partners; the same partner for all of them.
template <class Partner>
void append_pairs(const Roads& roads, const Partner& partner, std::vector<FamilyPair>& result) {
  std::map<Cell, const CellResult*> by_cell;
  for (const CellResult* const road : roads) by_cell[road->cell] = road;
  std::vector<RoadPair> pairs;
  for (const CellResult* const road : roads) {
    Cell other = road->cell;
    if (!partner(other)) continue;
    const auto found = by_cell.find(other);
    if (found != by_cell.end()) pairs.emplace_back(road, found->second);
  }
  for (const auto& [like, group] : grouped(pairs, [](const RoadPair& pair) { return pair.first->cell; })) {
    FamilyPair pair = pair_of(like, group);
    if (pair.paired.pairs > 0) result.push_back(std::move(pair));
  }
}

ordered_json cell_words(const Cell& cell) {
  return {{"planner", cell.planner}, {"guarded", cell.guarded}, {"family", cell.scenario},
          {"flavour", cell.flavour}, {"traffic", cell.traffic}, {"perception", cell.perception}};
}

}  // namespace

bool has_families(const std::vector<CellResult>& cells) {
  std::map<std::string, std::string> road_of;
  return std::any_of(cells.begin(), cells.end(), [&](const CellResult& cell) {
    const std::string& road = cell.cell.scenario;
    return road_of.emplace(roads::family_of(road), road).first->second != road;
  });
}

std::vector<FamilyResult> by_family(const std::vector<CellResult>& cells) {
  std::vector<FamilyResult> results;
  for (const auto& [like, roads] :
       grouped(with_episodes(cells), [](const CellResult* road) { return road->cell; })) {
    results.push_back(result_of(like, roads));
  }
  return results;
}

std::vector<FamilyPair> pair_families(const std::vector<CellResult>& cells) {
  const Roads roads = with_episodes(cells);
  std::vector<FamilyPair> result;
  append_pairs(
      roads, [](Cell& other) { return std::exchange(other.guarded, false); }, result);
  std::vector<std::string> planners;
  for (const CellResult* const road : roads) {
    if (std::find(planners.begin(), planners.end(), road->cell.planner) == planners.end()) {
      planners.push_back(road->cell.planner);
    }
  }
  for (std::size_t i = 1; i < planners.size(); ++i) {
    const bool has_guard = std::any_of(roads.begin(), roads.end(), [&](const CellResult* road) {
      return road->cell.planner == planners[i] && road->cell.guarded;
    });
    const auto partner = [&](Cell& other) {
      other.guarded = other.guarded && has_guard;
      return std::exchange(other.planner, planners[i]) == planners[0];
    };
    append_pairs(roads, partner, result);
  }
  return result;
}

ordered_json families_json(const std::vector<FamilyResult>& families) {
  auto list = ordered_json::array();
  for (const FamilyResult& family : families) {
    const metrics::Summary& s = family.summary;
    ordered_json one = cell_words(family.like);
    one["roads"] = family.roads;
    one["episodes"] = s.episodes;
    one["goals"] = s.success.count;
    one["success_rate"] = s.success.share;
    one["clustered_low"] = family.interval.low;
    one["clustered_high"] = family.interval.high;
    one["design_effect"] = family.design_effect;
    one["collisions"] = s.collision.count;
    one["at_fault_collisions"] = s.at_fault.count;
    one["off_road"] = s.off_road.count;
    one["time_outs"] = s.time_out.count;
    one["dead_ecu"] = s.dead_ecu.count;
    one["restricted_mean_time_to_goal_s"] = family.restricted_mean_s;
    one["near_misses"] = s.near_misses;
    one["rss_violation_share"] = s.rss_violation_share;
    one["mean_abs_jerk_mps3"] = s.mean_abs_jerk_mps3;
    list.push_back(std::move(one));
  }
  return list;
}

ordered_json family_pairs_json(const std::vector<FamilyPair>& pairs) {
  auto list = ordered_json::array();
  for (const FamilyPair& pair : pairs) {
    ordered_json one = cell_words(pair.first);
    one["against_planner"] = pair.second.planner;
    one["against_guarded"] = pair.second.guarded;
    one["pairs"] = pair.paired.pairs;
    one["only_first_fails"] = pair.paired.only_first_fails;
    one["only_second_fails"] = pair.paired.only_second_fails;
    one["mcnemar_p"] = metrics::mcnemar_p(pair.paired);
    one["design_effect"] = pair.design_effect;
    one["loss_of_goals_upper"] = pair.upper;
    one["first_at_fault"] = pair.first_at_fault;
    one["second_at_fault"] = pair.second_at_fault;
    one["first_restricted_mean_s"] = pair.first_restricted_mean_s;
    one["second_restricted_mean_s"] = pair.second_restricted_mean_s;
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace s4tp::campaign
