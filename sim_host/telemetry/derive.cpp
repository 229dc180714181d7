#include "sim_host/telemetry/derive.hpp"

#include <memory>

#include "algo/safety/fail_safe.hpp"
#include "algo/satp/predictor.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp::telemetry {
namespace {

Scene scene_of(const CycleRecord& cycle) {
  Scene scene = cycle.scene;
  scene.map = cycle.has_map ? &cycle.map : nullptr;
  return scene;
}

bool same(const Candidate& a, const Candidate& b) {
  return a.path == b.path && a.intent == b.intent && a.acceleration_mps2 == b.acceleration_mps2 &&
         a.target_s_m == b.target_s_m && a.lateral_length_m == b.lateral_length_m && a.in_gap == b.in_gap;
}

}  // namespace

std::vector<RolledOut> candidates_of(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                     const Parameters& parameters) {
  std::vector<RolledOut> result;
  if (!cycle.has_candidates) return result;
  for (int i = 0; i < cycle.candidates.size(); ++i) {
    const Candidate& candidate = cycle.candidates[i];
    RolledOut one;
    roll_out(cycle.lines[candidate.path], candidate, cycle.start, cycle.running, plan.plan.start_ms,
             parameters, one.trajectory);
    one.rejection = plan.explanation.rejections[i];
    one.costed = one.rejection == Rejection::kNone;
    if (one.costed) one.cost = cycle.costs[i];
    one.chosen = plan.plan.kind == PlanKind::kDrive && same(candidate, plan.explanation.chosen);
    result.push_back(one);
  }
  return result;
}

HeatMap heat_map_of(const ecu::PlanRecord& plan, const CycleRecord& cycle, const Parameters& parameters) {
  const Scene scene = scene_of(cycle);
  DrivableArea area;
  build_drivable(scene.map, area);
  const auto predictor = std::make_unique<Predictor>();
  KinematicSet others;
  predictor->encode(scene, parameters, plan.plan.start_ms);
  predictor->keep_going(others);
  HeatMap map;
  for (int row = 0; row < kHeatRows; ++row)
    heat_row(scene, area, cycle.prediction, others, parameters, row, map);
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

}  // namespace s4tp::telemetry
