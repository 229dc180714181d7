#include "algo/planner/decision.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/sort.hpp"

namespace s4tp::planner {
namespace {

constexpr int kZoneBit = 2;  // two bits of path
constexpr int kVehicleBit = kZoneBit + kMaxPathZones;
static_assert(kVehicleBit + kMaxAgents <= 32, "a decision key is 32 bits");

}  // namespace

DecisionKey decision_key(const scene::Scene& scene, int path_index, const Trajectory& trajectory,
                         const satp::PredictionSet& marginal) {
  const scene::EgoPath& path = scene.ego_paths[path_index];
  const Pose& end = trajectory.points[kHorizonSteps].rear_axle;
  float reached_m = path.frenet.s_m;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    reached_m = reached_m + kStepS * trajectory.points[i].speed_mps;
  }

  DecisionKey key = static_cast<DecisionKey>(path_index);
  for (int i = 0; i < path.zones.size(); ++i) {
    if (reached_m > path.zones[i].entry_s_m) key |= DecisionKey{1} << (kZoneBit + i);
  }
  const Point ahead = direction(end.heading_rad);
  for (int i = 0; i < marginal.agents.size(); ++i) {
    const satp::AgentPrediction& agent = marginal.agents[i];
    if (agent.modes.empty()) continue;
    const Point there = position(agent.modes[0].steps[kHorizonSteps - 1]);
    if (dot(ahead, there - position(end)) < 0.0F) key |= DecisionKey{1} << (kVehicleBit + i);
  }
  return key;
}

int path_of(DecisionKey key) {
  return static_cast<int>(key & ((DecisionKey{1} << kZoneBit) - 1U));
}

bool DecisionList::open_to(DecisionKey key, float least, int count) const {
  int better = 0;
  for (const Decision& decision : decisions_) {
    if (least < decision.score) continue;
    if (decision.key == key) return false;
    ++better;
  }
  return better < count;
}

void DecisionList::offer(DecisionKey key, int candidate, float score) {
  const Decision offered{key, static_cast<std::uint8_t>(candidate), score};
  for (Decision& decision : decisions_) {
    if (decision.key != key) continue;
    if (score < decision.score) decision = offered;
    return;
  }
  const bool kept = decisions_.push(offered);
  S4TP_ASSERT(kept);  // there are no more decisions than candidates
}

bool DecisionList::leads_path(int path, float score) const {
  for (const Decision& decision : decisions_) {
    if (path_of(decision.key) == path && decision.score <= score) return false;
  }
  return true;
}

void DecisionList::shortlist(int count, const Reserved& reserved) {
  sort(decisions_, [](const Decision& a, const Decision& b) { return a.score < b.score; });
  if (decisions_.size() <= count || count <= 0) return;
  bool kept[kMaxCandidates] = {};
  int room = count;
  const auto keep_first = [&](const auto& is_it) {
    for (int i = 0; i < decisions_.size() && room > 0; ++i) {
      if (!is_it(decisions_[i].key)) continue;
      if (!kept[i]) --room;
      kept[i] = true;
      return;
    }
  };
  const auto on_path = [](int path) { return [path](DecisionKey key) { return path_of(key) == path; }; };
  if (reserved.keeps_plan) keep_first([&](DecisionKey key) { return key == reserved.plan; });
  if (reserved.goes_on != 0) {
    keep_first(on_path(reserved.goes_on));
    keep_first(on_path(0));
  }
  for (int i = 0; i < decisions_.size() && room > 0; ++i) {
    if (!kept[i]) --room;
    kept[i] = true;
  }
  int size = 0;
  for (int i = 0; i < decisions_.size(); ++i) {
    if (kept[i]) decisions_[size++] = decisions_[i];
  }
  decisions_.truncate(size);
}

}  // namespace s4tp::planner
