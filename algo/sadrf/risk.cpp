#include "algo/sadrf/risk.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/futures.hpp"
#include "algo/sadrf/road_risk.hpp"
#include "algo/sadrf/step_risk.hpp"

namespace s4tp {
namespace {

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
  CostBoxes felt;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const StepRisk risk = risk_at(inputs, i, felt);
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

void risk_slopes(const Scene& scene, const PredictionSet& prediction, const KinematicSet& others,
                 const Trajectory& trajectory, const Parameters& parameters, int first, int stride,
                 FieldGradient (&slopes)[kHorizonSteps]) {
  const Futures futures = all_modes(scene, prediction, others);
  const StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kLines);
  CostBoxes felt;
  for (int i = first; i < kHorizonSteps; i += stride) {
    const StepSlope slope = slope_at(inputs, i, felt);
    const bool excess = slope.obstacle_risk > parameters.risk.threshold;
    const float of_obstacles = 1.0F + (excess ? parameters.scoring.risk_excess : 0.0F);
    const float of_social = parameters.risk.weight_social;
    slopes[i] = {of_obstacles * slope.obstacle.x + of_social * slope.social.x,
                 of_obstacles * slope.obstacle.y + of_social * slope.social.y,
                 of_obstacles * slope.obstacle.heading + of_social * slope.social.heading,
                 of_obstacles * slope.obstacle.speed, of_obstacles * slope.obstacle.steering};
  }
}

float rank_risk(const Scene& scene, const DrivableArea& area, const PredictionSet& prediction,
                const KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters) {
  constexpr int kStride = 3;
  constexpr int kMiddle = 1;  // of three steps: their sum is three times it to first order
  Futures futures = all_modes(scene, prediction, others);
  keep_likeliest(futures);
  float road[kHorizonSteps] = {};
  road_risk(area, trajectory, parameters, kMiddle + 1, kStride, road);
  const StepInputs inputs = step_inputs(scene, futures, trajectory, parameters, Precision::kLines);
  CostBoxes felt;
  float sum = 0.0F;
  for (int i = kMiddle; i < kHorizonSteps; i += kStride) {
    const StepRisk risk = risk_at(inputs, i, felt);
    sum += instant(risk.obstacle, road[i], risk.social, parameters);
  }
  return static_cast<float>(kStride) * kStepS * sum;
}

}  // namespace s4tp
