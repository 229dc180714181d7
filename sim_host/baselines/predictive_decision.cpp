#include "sim_host/baselines/predictive_decision.hpp"

#include <algorithm>
#include <cmath>

#include "algo/behavior/manoeuvres.hpp"
#include "algo/core/check.hpp"
#include "algo/core/math.hpp"
#include "algo/sadrf/futures.hpp"
#include "algo/sadrf/overlap.hpp"
#include "algo/safety/fail_safe.hpp"
#include "algo/satp/shipped_weights.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/driven_lines.hpp"
#include "sim_host/baselines/goal_distance.hpp"
#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/metrics/time_to_collision.hpp"

namespace s4tp::baselines {
namespace {

template <bool kLearned>
PlannerEntry entry(const char* name, const char* meaning) {
  return {name, meaning, ecu_with<PredictiveDecisionPlanner<false, kLearned>>,
          ecu_with<Guarded<PredictiveDecisionPlanner<true, kLearned>>>};
}

const RegisterPlanner kRegistered{
    entry<true>("predictive_decision", "the same predictor, no risk field: a sum of seven features decides")};
const RegisterPlanner kKinematic{
    entry<false>("predictive_decision_kinematic", "the same, predicting with the kinematic model")};

constexpr float kJerkMps3 = 10.0F;
constexpr float kGapM = 1.0F;
constexpr float kFarM = 8.0F;  // gaps beyond this count as nothing
constexpr float kTtcS = 3.0F;
constexpr int kTtcStride = 5;

/// What the present and the next step say of a car's motion.
traffic::CarState car_at(const Pose& now, const Pose& next, float length_m, float width_m) {
  traffic::CarState car;
  car.centre = {now.x_m, now.y_m};
  car.heading_rad = now.heading_rad;
  car.speed_mps = distance(position(now), position(next)) / kStepS;
  car.yaw_rate_radps = wrap_angle(next.heading_rad - now.heading_rad) / kStepS;
  car.length_m = length_m;
  car.width_m = width_m;
  return car;
}

}  // namespace

float weighted(const PdCost& f, const PdCost& w) {
  return w.goal * f.goal + w.speed * f.speed + w.jerk * f.jerk + w.lateral * f.lateral +
         w.distance * f.distance + w.ttc * f.ttc + w.collision * f.collision;
}

PdCost pd_features(const scene::Scene& scene, int path_index, const trajectory::ReferenceLine& line,
                   const Trajectory& trajectory, const satp::PredictionSet& predicted,
                   const satp::KinematicSet& others, const Parameters& parameters) {
  const scene::EgoPath& path = scene.ego_paths[path_index];
  PdCost features;
  features.goal = goal_distance(scene, path, trajectory, parameters);

  float s_m = trajectory::locate_on(line, position(trajectory.points[0].rear_axle), path.frenet.s_m).s_m;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& before = trajectory.points[i - 1];
    const TrajectoryPoint& point = trajectory.points[i];
    s_m += 0.5F * kStepS * (before.speed_mps + point.speed_mps);
    const float allowed_mps = std::max(trajectory::reference_at(line, s_m).speed_cap_mps, 1.0F);
    features.speed += std::abs(point.speed_mps - allowed_mps) / allowed_mps;
    features.jerk += std::abs(point.acceleration_mps2 - before.acceleration_mps2) / (kStepS * kJerkMps3);
    features.lateral += point.speed_mps * point.speed_mps * std::abs(point.curvature_1pm) /
                        parameters.comfort.lateral_max_mps2;
  }
  features.speed /= kHorizonSteps;
  features.jerk /= kHorizonSteps;
  features.lateral /= kHorizonSteps;

  if (s_m + trajectory::rear_axle_to_front_m(parameters) > trajectory::dead_end_s_m(scene, path))
    features.collision = 1.0F;

  float near[kHorizonSteps] = {};
  const sadrf::Futures futures = sadrf::all_modes(scene, predicted, others);
  for (int first = 0; first < futures.size();) {
    float ttc = 0.0F;
    float hit = 0.0F;
    float beside[kHorizonSteps] = {};
    const int agent = futures[first].agent;
    const Track& track = scene.agents[agent].track;
    for (; first < futures.size() && futures[first].agent == agent; ++first) {
      const sadrf::Future& future = futures[first];
      const satp::Mode& mode = *future.mode;
      hit += future.probability * sadrf::touch_likelihood(trajectory, mode, track, parameters);
      float least_s = kTtcS;
      for (int i = 0; i < kHorizonSteps; ++i) {
        const Box own = trajectory::ego_box(trajectory.points[i + 1].rear_axle, parameters);
        const float reach_m = kFarM + 0.5F * (track.length_m + parameters.vehicle.length_m);
        const float apart_m = distance(position(own.centre), position(mode.steps[i]));
        if (apart_m < reach_m) {
          const float gap_m = std::max(0.0F, separation(own, {mode.steps[i], track.length_m, track.width_m}));
          beside[i] += future.probability * std::exp(-gap_m / kGapM);
        }
        if (i % kTtcStride != kTtcStride - 1) continue;
        const Pose before = trajectory::ego_box(trajectory.points[i].rear_axle, parameters).centre;
        const traffic::CarState us = car_at(before, own.centre, own.length_m, own.width_m);
        const traffic::CarState them =
            car_at(mode.steps[i - 1], mode.steps[i], track.length_m, track.width_m);
        least_s = std::min(least_s, static_cast<float>(metrics::time_to_collision_s(us, them, kTtcS)));
      }
      ttc += future.probability * (1.0F - least_s / kTtcS);
    }
    features.ttc = std::max(features.ttc, ttc);
    features.collision = std::max(features.collision, hit);
    for (int i = 0; i < kHorizonSteps; ++i) near[i] = std::max(near[i], beside[i]);
  }
  for (const float share : near) features.distance += share / kHorizonSteps;
  return features;
}

Status PredictiveDecision::init(const Parameters& parameters) {
  int first_bad = 0;
  parameters_ = parameters;
  scene_builder_.reset();
  guard_.reset();
  trust_.reset();
  if (const satp::ShippedWeights shipped = satp::shipped_weights(); learned_ && shipped.image != nullptr) {
    const satp::WeightStatus taken = satp::Weights::check(shipped.image, shipped.size_bytes, weights_);
    S4TP_ASSERT(taken == satp::WeightStatus::kOk);  // the build's own
  }
  return validate(parameters, first_bad);
}

Status PredictiveDecision::plan(const planner::PlannerInput& input, Plan& plan,
                                planner::Explanation& explanation) {
  explanation = planner::Explanation{};
  const Plan running = input.running != nullptr ? *input.running : Plan{};
  const TrajectoryPoint start =
      trajectory::plan_start(input.ego, input.now_ms, running, input.start_ms, parameters_);
  Status status = scene_builder_.build(input.now_ms, input.ego, input.tracks, input.tracks_ms, input.map,
                                       parameters_, scene_);
  plan.start_ms = input.start_ms;
  plan.kind = PlanKind::kDrive;
  plan.manoeuvre = running.manoeuvre;
  if (running.kind != PlanKind::kNone)
    behavior::pass_time(static_cast<std::int32_t>(input.start_ms - running.start_ms), plan.manoeuvre);
  satp::PredictionSet chosen;
  if (status == Status::kOk) {
    explanation.learned = weights_.present();
    if (weights_.present()) trust_.observe(scene_, weights_.header().usual_residual_m);
    predictor_.encode(weights_, scene_, parameters_, input.start_ms, nullptr, &trust_, scratch_);
    predictor_.decode(nullptr, satp::kMaxPredictionWork, marginal_);
    if (weights_.present()) trust_.remember(scene_, marginal_, input.start_ms);
    predictor_.constant_velocity(constant_velocity_);
    const float lead_s = 1e-3F * static_cast<float>(input.start_ms - scene_.time_ms);
    (void)trajectory::build_lines(start, lead_s, parameters_, scene_, lines_);
    guard_.look(scene_, start, lead_s, parameters_);
    int left_out = 0;
    trajectory::generate_candidates(scene_, start, running, input.start_ms, parameters_, kMaxCandidates,
                                    lines_, candidates_, left_out);
    float least = 1e9F;
    satp::PredictionSet conditioned;
    Trajectory trajectory;
    status = Status::kNoSafePlan;
    for (const trajectory::Candidate& candidate : candidates_) {
      trajectory::roll_out(lines_[candidate.path], candidate, start, running, input.start_ms, parameters_,
                           trajectory);
      predictor_.decode(&trajectory, satp::kMaxPredictionWork, conditioned);
      if (guarded_ && !guard_.judge(candidate.path, trajectory).safe()) continue;
      const float cost = weighted(pd_features(scene_, candidate.path, lines_[candidate.path], trajectory,
                                              conditioned, constant_velocity_, parameters_),
                                  kPdWeights);
      if (cost >= least) continue;
      least = cost;
      status = Status::kOk;
      explanation.chosen = candidate;
      plan.trajectory = trajectory;
      chosen = conditioned;
    }
    if (status == Status::kOk) {
      const safety::Verdict verdict = guard_.judge(explanation.chosen.path, plan.trajectory);
      guard_.commit(explanation.chosen.path, verdict);
      plan.fail_safe = verdict.fail_safe;
      const bool passes_group = verdict.clears && !verdict.stops_short;
      behavior::advance({explanation.chosen.path, &plan.trajectory, passes_group, verdict.cleared_end},
                        scene_, parameters_, plan.manoeuvre);
    }
  }
  if (status != Status::kOk) {
    safety::drive_fail_safe(running, start, input.start_ms, parameters_.guard.braking_mps2, parameters_,
                            plan);
  }
  explanation.status = status;
  if (probe != nullptr) probe->cycle_done(scene_, chosen, sadrf::RiskProfile{});
  return status;
}

}  // namespace s4tp::baselines
