#include "sim_host/baselines/guard.hpp"

#include <cmath>

#include "algo/safety/fail_safe.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp::baselines {
namespace {

/// The ego path in whose lane the trajectory ends.
int path_of(const scene::Scene& scene, const Trajectory& trajectory) {
  const TrajectoryPoint& end = trajectory.points[kHorizonSteps];
  int nearest = 0;
  float least_m = 1e9F;
  for (int i = 0; i < scene.ego_paths.size(); ++i) {
    const scene::Frenet there =
        scene::project(*scene.map, scene.ego_paths[i].path, position(end.rear_axle), 0.0F, -1.0F);
    if (std::abs(there.d_m) >= least_m) continue;
    least_m = std::abs(there.d_m);
    nearest = i;
  }
  return nearest;
}

}  // namespace

Status Guard::init(const Parameters& parameters) {
  int first_bad = 0;
  parameters_ = parameters;
  scene_builder_.reset();
  guard_.reset();
  return validate(parameters, first_bad);
}

Status Guard::apply(const planner::PlannerInput& input, Status status, Plan& plan,
                    planner::Explanation& explanation) {
  const Plan running = input.running != nullptr ? *input.running : Plan{};
  const Status seen = scene_builder_.build(input.now_ms, input.ego, input.tracks, input.tracks_ms, input.map,
                                           parameters_, scene_);
  if (status == Status::kOk) status = seen;
  const TrajectoryPoint start =
      trajectory::plan_start(input.ego, input.now_ms, running, input.start_ms, parameters_);
  if (seen == Status::kOk)
    guard_.look(scene_, start, 1e-3F * static_cast<float>(input.start_ms - scene_.time_ms), parameters_);
  if (status == Status::kOk) {
    const int path = path_of(scene_, plan.trajectory);
    const safety::Verdict verdict = guard_.judge(path, plan.trajectory);
    if (verdict.safe() && trajectory::feasible(plan.trajectory, parameters_)) {
      guard_.commit(path, verdict);
      plan.fail_safe = verdict.fail_safe;
    } else {
      status = Status::kNoSafePlan;
      explanation.blocking.verdict = verdict;
      if (verdict.agent < scene_.agents.size())
        explanation.blocking.track = scene_.agents[verdict.agent].track.id;
    }
  }
  explanation.status = status;
  if (status == Status::kOk) return status;
  // A licence not yet used may be gone: who can still stop before the zones does, whatever the fail-safe in force.
  if (seen == Status::kOk && running.fail_safe.branch_s > parameters_.guard.takeover_s) {
    Plan at_once = running;
    at_once.fail_safe.branch_s = 0.0F;
    safety::drive_fail_safe(at_once, start, input.start_ms, parameters_.guard.braking_mps2, parameters_,
                            plan);
    const int path = path_of(scene_, plan.trajectory);
    const safety::Verdict verdict = guard_.judge(path, plan.trajectory);
    if (verdict.safe() && !verdict.clears) {
      guard_.commit(path, verdict);
      return status;
    }
  }
  safety::drive_fail_safe(running, start, input.start_ms, parameters_.guard.braking_mps2, parameters_, plan);
  return status;
}

}  // namespace s4tp::baselines
