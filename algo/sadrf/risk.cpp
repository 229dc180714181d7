#include "algo/sadrf/risk.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/futures.hpp"
#include "algo/sadrf/road_risk.hpp"
#include "algo/sadrf/step_risk.hpp"

namespace s4tp::sadrf {
namespace {

constexpr int kRankStride = 3;
constexpr int kRankMiddle = 1;  // of three steps: their sum is three times it to first order
constexpr int kRankSteps = kHorizonSteps / kRankStride;
static_assert(kRankSteps * kRankStride == kHorizonSteps);

// Work (WorkMeter's units), beside what the steps and the road take.
constexpr std::int32_t kSmoothWork = 60;
constexpr std::int32_t kProfileWork = 300;

float instant(float obstacle, float road, float social, const Parameters& parameters) {
  return obstacle + road + parameters.risk.weight_social * social +
         parameters.scoring.risk_excess * max(obstacle - parameters.risk.threshold, 0.0F);
}

/// Whose share of any one step is largest; of equal ones the first.
struct Dominating {
  float largest = 0.0F;
  std::uint8_t agent = 255;
  std::uint8_t step = 0;

  void take(float share, int of_agent, int at_step) {
    if (share < largest || (share == largest && (agent == 255 || at_step >= step))) return;
    largest = share;
    agent = static_cast<std::uint8_t>(of_agent);
    step = static_cast<std::uint8_t>(at_step);
  }
};

}  // namespace

float risk_integral(const RiskProfile& profile, const Parameters& parameters) {
  float sum = 0.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    sum += instant(profile.obstacle[i], profile.road[i], profile.social[i], parameters);
  }
  return kStepS * sum;
}

void exact_risk(const scene::Scene& scene, const DrivableArea& area, const satp::PredictionSet& prediction,
                const satp::KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                RiskProfile& profile) {
  WorkMeter unbounded{kUnboundedWork};
  exact_risk(scene, area, prediction, others, trajectory, parameters, profile, unbounded);
}

void exact_risk(const scene::Scene& scene, const DrivableArea& area, const satp::PredictionSet& prediction,
                const satp::KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                RiskProfile& profile, WorkMeter& work) {
  const Futures futures = all_modes(scene, prediction, others);
  const std::int32_t least = least_work(futures.size());
  work.reserve = kRankSteps * least;
  work.spend(kProfileWork);
  road_risk(area, trajectory, parameters, 1, 1, profile.road, work);
  const StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kSlices);
  CostBoxes boxes;
  Dominating dominating;
  const auto look = [&](int i) {
    const StepRisk risk = risk_at(inputs, i, boxes, work);
    profile.obstacle[i] = risk.obstacle;
    profile.social[i] = risk.social;
    for (int agent = 0; agent < scene.agents.size(); ++agent) dominating.take(risk.share[agent], agent, i);
  };
  for (int i = kRankMiddle; i < kHorizonSteps; i += kRankStride) {
    if (i == kRankMiddle || work.left >= least) {
      look(i);
    } else {
      profile.obstacle[i] = profile.obstacle[i - kRankStride];
      profile.social[i] = profile.social[i - kRankStride];
    }
    work.reserve -= least;
  }
  work.reserve = least;
  for (int i = 0; i < kHorizonSteps; ++i) {
    if (i % kRankStride == kRankMiddle) continue;
    if (work.left >= least) {
      look(i);
      continue;
    }
    const int nearest = i / kRankStride * kRankStride + kRankMiddle;
    profile.obstacle[i] = profile.obstacle[nearest];
    profile.social[i] = profile.social[nearest];
  }
  profile.dominating_agent = dominating.agent;
  profile.dominating_step = dominating.step;
}

void smooth_risk(const scene::Scene& scene, const satp::PredictionSet& prediction,
                 const satp::KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                 int first, int stride, SmoothRisk (&risks)[kHorizonSteps], WorkMeter& work) {
  constexpr float kBlend = 0.1F;  // of the threshold: where the excess goes over into a straight line
  const Futures futures = all_modes(scene, prediction, others);
  const std::int32_t least = least_work(futures.size());
  work.spend(kSmoothWork);
  work.reserve = least;
  StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kLines);
  inputs.params.smoothing = kSmoothField;
  const float threshold = parameters.risk.threshold;
  const float blend = kBlend * threshold;
  const float at_none = 0.5F * (sqrt(square(threshold) + square(blend)) - threshold);
  CostBoxes boxes;
  for (int i = first; i < kHorizonSteps; i += stride) {
    if (work.left < least) {
      risks[i] = {i > first ? risks[i - stride].value : 0.0F};
      continue;
    }
    const StepSlope step = slope_at(inputs, i, boxes, work);
    const float over = step.obstacle_risk - threshold;
    const float root = sqrt(square(over) + square(blend));
    const float excess_slope = root > 0.0F ? 0.5F * (1.0F + over / root) : 0.0F;
    const float of_obstacles = 1.0F + parameters.scoring.risk_excess * excess_slope;
    const float of_social = parameters.risk.weight_social;
    risks[i].value = step.obstacle_risk + of_social * step.social_risk +
                     parameters.scoring.risk_excess * (0.5F * (over + root) - at_none);
    risks[i].slope = {of_obstacles * step.obstacle.x + of_social * step.social.x,
                      of_obstacles * step.obstacle.y + of_social * step.social.y,
                      of_obstacles * step.obstacle.heading + of_social * step.social.heading,
                      of_obstacles * step.obstacle.speed, of_obstacles * step.obstacle.steering};
  }
}

std::int32_t least_rank_work(const scene::Scene& scene) {
  return kLeastRoadWork + kRankSteps * least_work(scene.agents.size());
}

float rank_risk_of_vehicles(const scene::Scene& scene, const satp::PredictionSet& prediction,
                            const satp::KinematicSet& others, const Trajectory& trajectory,
                            const Parameters& parameters, WorkMeter& work) {
  Futures futures = all_modes(scene, prediction, others);
  keep_likeliest(futures);
  const StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kLines);
  const std::int32_t least = least_work(futures.size());
  work.reserve = kRankSteps * least;
  CostBoxes boxes;
  float sum = 0.0F;
  for (int i = kRankMiddle; i < kHorizonSteps; i += kRankStride) {
    const StepRisk risk = risk_at(inputs, i, boxes, work);
    sum += instant(risk.obstacle, 0.0F, risk.social, parameters);
    work.reserve -= least;
  }
  return static_cast<float>(kRankStride) * kStepS * sum;
}

float rank_risk_of_road(const DrivableArea& area, const Trajectory& trajectory, const Parameters& parameters,
                        WorkMeter& work) {
  float road[kHorizonSteps] = {};
  work.reserve = 0;
  road_risk(area, trajectory, parameters, kRankMiddle + 1, kRankStride, road, work);
  float sum = 0.0F;
  for (int i = kRankMiddle; i < kHorizonSteps; i += kRankStride) sum += road[i];
  return static_cast<float>(kRankStride) * kStepS * sum;
}

}  // namespace s4tp::sadrf
