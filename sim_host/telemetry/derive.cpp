#include "sim_host/telemetry/derive.hpp"

#include <algorithm>
#include <memory>

#include "algo/occupancy/lane_reach.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/sadrf/risk.hpp"
#include "algo/safety/fail_safe.hpp"
#include "algo/satp/predictor.hpp"
#include "algo/scene/lane_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp::telemetry {
namespace {

constexpr float kMovingMps = 0.5F;

scene::Scene scene_of(const CycleRecord& cycle) {
  scene::Scene scene = cycle.scene;
  scene.map = cycle.has_map ? &cycle.map : nullptr;
  return scene;
}

bool same(const trajectory::Candidate& a, const trajectory::Candidate& b) {
  return a.path == b.path && a.intent == b.intent && a.acceleration_mps2 == b.acceleration_mps2 &&
         a.target_s_m == b.target_s_m && a.lateral_length_m == b.lateral_length_m && a.in_gap == b.in_gap;
}

satp::KinematicSet constant_velocity(const scene::Scene& scene, const ecu::PlanRecord& plan,
                                     const Parameters& parameters) {
  const auto predictor = std::make_unique<satp::Predictor>();
  satp::KinematicSet others;
  predictor->encode(scene, parameters, plan.plan.start_ms);
  predictor->constant_velocity(others);
  return others;
}

/// When our box's centre is beyond the zone; after the horizon we go on as the guard takes us to.
float leaves_s(const scene::Scene& scene, const scene::EgoPath& path, const Trajectory& trajectory,
               const scene::ConflictZone& zone, const Parameters& parameters) {
  const float centre_m = trajectory::rear_axle_to_centre_m(parameters);
  float s_m = path.frenet.s_m;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    s_m = scene::project(*scene.map, path.path, position(trajectory.points[i].rear_axle), s_m, 15.0F).s_m;
    if (s_m + centre_m > zone.exit_s_m) return static_cast<float>(i) * kStepS;
  }
  constexpr float kGoesOnMps2 = 1.5F;
  const float end_mps = trajectory.points[kHorizonSteps].speed_mps;
  if (end_mps < kMovingMps) return occupancy::kNeverS;
  const float limit_mps = scene::path_point(*scene.map, path.path, zone.exit_s_m).speed_limit_mps;
  return kHorizonSteps * kStepS +
         occupancy::time_to_cover_s({end_mps, kGoesOnMps2, std::max(end_mps, limit_mps)},
                                    zone.exit_s_m - s_m - centre_m);
}

}  // namespace

std::vector<RolledOut> candidates_of(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                     const Parameters& parameters) {
  std::vector<RolledOut> result;
  if (!cycle.has_candidates) return result;
  for (int i = 0; i < cycle.candidates.size(); ++i) {
    const trajectory::Candidate& candidate = cycle.candidates[i];
    RolledOut one;
    trajectory::roll_out(cycle.lines[candidate.path], candidate, cycle.start, cycle.running,
                         plan.plan.start_ms, parameters, one.trajectory);
    one.rejection = plan.explanation.rejections[i];
    one.costed = one.rejection == trajectory::Rejection::kNone;
    if (one.costed) one.cost = cycle.costs[i];
    one.chosen = plan.plan.kind == PlanKind::kDrive && same(candidate, plan.explanation.chosen);
    result.push_back(one);
  }
  return result;
}

CostRange cost_range(const std::vector<RolledOut>& candidates) {
  CostRange range;
  bool first = true;
  for (const RolledOut& one : candidates) {
    if (!one.costed) continue;
    range.least = first ? one.cost.total() : std::min(range.least, one.cost.total());
    range.most = first ? one.cost.total() : std::max(range.most, one.cost.total());
    first = false;
  }
  return range;
}

sadrf::HeatMap heat_map_of(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                           const Parameters& parameters) {
  const scene::Scene scene = scene_of(cycle);
  sadrf::DrivableArea area;
  sadrf::build_drivable(scene.map, area);
  const satp::KinematicSet others = constant_velocity(scene, plan, parameters);
  sadrf::HeatMap map;
  for (int row = 0; row < sadrf::kHeatRows; ++row)
    sadrf::heat_row(scene, area, cycle.prediction, others, parameters, row, map);
  return map;
}

Plan fail_safe_of(const ecu::PlanRecord& plan, const Parameters& parameters) {
  Plan result;
  const float planned_mps2 = plan.plan.fail_safe.braking_mps2;
  safety::drive_fail_safe(plan.plan, plan.plan.trajectory.points[0], plan.plan.start_ms,
                          planned_mps2 > 0.0F ? planned_mps2 : parameters.guard.braking_mps2, parameters,
                          result);
  return result;
}

bool matters_more(const safety::ZoneOccupancy& one, const safety::ZoneOccupancy& other) {
  if (one.claim == safety::Claim::kNone || other.claim == safety::Claim::kNone)
    return one.claim != safety::Claim::kNone;
  const bool comes = one.claim == safety::Claim::kMayCome;
  if (comes != (other.claim == safety::Claim::kMayCome)) return comes;
  return one.from_s < other.from_s;
}

std::vector<GroundClaim> claims_of(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                   const Parameters& parameters) {
  const scene::Scene scene = scene_of(cycle);
  std::vector<GroundClaim> claims(static_cast<std::size_t>(scene.agents.size()));
  if (scene.map == nullptr || scene.ego_paths.empty()) return claims;
  const int chosen = plan.explanation.chosen.path;
  const scene::EgoPath& path = scene.ego_paths[chosen < scene.ego_paths.size() ? chosen : 0];
  const float lead_s = 0.001F * static_cast<float>(plan.plan.start_ms - scene.time_ms);
  for (int i = 0; i < scene.agents.size(); ++i) {
    GroundClaim& claim = claims[static_cast<std::size_t>(i)];
    for (const scene::ConflictZone& zone : path.zones) {
      if (zone.exit_s_m < path.frenet.s_m) continue;  // behind us
      occupancy::LaneReach reach;
      reach.measure(*scene.map, scene.agents[i], !zone.merging);
      const safety::ZoneOccupancy when =
          safety::zone_occupancy(scene, scene.agents[i], reach, zone, lead_s, parameters);
      if (matters_more(when, claim.its))
        claim = {when, leaves_s(scene, path, plan.plan.trajectory, zone, parameters)};
    }
  }
  return claims;
}

std::vector<float> risk_shares(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                               const Parameters& parameters) {
  const scene::Scene scene = scene_of(cycle);
  sadrf::DrivableArea area;
  sadrf::build_drivable(scene.map, area);
  const satp::KinematicSet others = constant_velocity(scene, plan, parameters);
  std::vector<float> shares;
  float sum = 0.0F;
  for (int i = 0; i < scene.agents.size(); ++i) {
    scene::Scene alone = scene;
    alone.agents.clear();
    (void)alone.agents.push(scene.agents[i]);
    satp::PredictionSet expected;
    for (const satp::AgentPrediction& one : cycle.prediction.agents) {
      if (one.agent != i) continue;
      (void)expected.agents.push(one);
      expected.agents[0].agent = 0;
    }
    alone.watched = expected.agents.size();
    satp::KinematicSet going;
    if (i < others.agents.size()) (void)going.agents.push(others.agents[i]);
    sadrf::RiskProfile profile{};
    sadrf::exact_risk(alone, area, expected, going, plan.plan.trajectory, parameters, profile);
    float risk = 0.0F;
    for (int step = 0; step < kHorizonSteps; ++step)
      risk += profile.obstacle[step] + parameters.risk.weight_social * profile.social[step];
    shares.push_back(risk);
    sum += risk;
  }
  for (float& share : shares) share = sum > 0.0F ? share / sum : 0.0F;
  return shares;
}

}  // namespace s4tp::telemetry
