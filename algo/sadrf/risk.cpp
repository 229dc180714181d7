#include "algo/sadrf/risk.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/futures.hpp"
#include "algo/sadrf/road_risk.hpp"
#include "algo/sadrf/step_risk.hpp"

namespace s4tp {
namespace {

constexpr int kRankStride = 3;
constexpr int kRankMiddle = 1;  // of three steps: their sum is three times it to first order

float instant(float obstacle, float road, float social, const Parameters& parameters) {
  return obstacle + road + parameters.risk.weight_social * social +
         parameters.scoring.risk_excess * max(obstacle - parameters.risk.threshold, 0.0F);
}

}  // namespace

float risk_integral(const RiskProfile& profile, const Parameters& parameters) {
  float sum = 0.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    sum += instant(profile.obstacle[i], profile.road[i], profile.social[i], parameters);
  }
  return kStepS * sum;
}

void exact_risk(const Scene& scene, const DrivableArea& area, const PredictionSet& prediction,
                const KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                RiskProfile& profile) {
  const Futures futures = all_modes(scene, prediction, others);
  road_risk(area, trajectory, parameters, 1, 1, profile.road);
  profile.dominating_agent = 255;
  profile.dominating_step = 0;
  float largest = 0.0F;
  const StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kSlices);
  CostBoxes boxes;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const StepRisk risk = risk_at(inputs, i, boxes);
    profile.obstacle[i] = risk.obstacle;
    profile.social[i] = risk.social;
    for (int agent = 0; agent < scene.agents.size(); ++agent) {
      if (risk.share[agent] <= largest) continue;
      largest = risk.share[agent];
      profile.dominating_agent = static_cast<std::uint8_t>(agent);
      profile.dominating_step = static_cast<std::uint8_t>(i);
    }
  }
}

void smooth_risk(const Scene& scene, const PredictionSet& prediction, const KinematicSet& others,
                 const Trajectory& trajectory, const Parameters& parameters, int first, int stride,
                 SmoothRisk (&risks)[kHorizonSteps]) {
  constexpr float kBlend = 0.1F;  // of the threshold: where the excess goes over into a straight line
  const Futures futures = all_modes(scene, prediction, others);
  StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kLines);
  inputs.params.smoothing = kSmoothField;
  const float threshold = parameters.risk.threshold;
  const float blend = kBlend * threshold;
  const float at_none = 0.5F * (sqrt(square(threshold) + square(blend)) - threshold);
  CostBoxes boxes;
  for (int i = first; i < kHorizonSteps; i += stride) {
    const StepSlope step = slope_at(inputs, i, boxes);
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

float rank_risk_of_vehicles(const Scene& scene, const PredictionSet& prediction, const KinematicSet& others,
                            const Trajectory& trajectory, const Parameters& parameters) {
  Futures futures = all_modes(scene, prediction, others);
  keep_likeliest(futures);
  const StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kLines);
  CostBoxes boxes;
  float sum = 0.0F;
  for (int i = kRankMiddle; i < kHorizonSteps; i += kRankStride) {
    const StepRisk risk = risk_at(inputs, i, boxes);
    sum += instant(risk.obstacle, 0.0F, risk.social, parameters);
  }
  return static_cast<float>(kRankStride) * kStepS * sum;
}

float rank_risk_of_road(const DrivableArea& area, const Trajectory& trajectory,
                        const Parameters& parameters) {
  float road[kHorizonSteps] = {};
  road_risk(area, trajectory, parameters, kRankMiddle + 1, kRankStride, road);
  float sum = 0.0F;
  for (int i = kRankMiddle; i < kHorizonSteps; i += kRankStride) sum += road[i];
  return static_cast<float>(kRankStride) * kStepS * sum;
}

}  // namespace s4tp
