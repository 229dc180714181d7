#include "algo/satp/step_features.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::satp {

void own_features(const StepState& state, float speed_mps, int step, float (&features)[kOwnFeatures]) {
  const SinCos turn = sin_cos(state.last.heading_rad);
  features[0] = state.last.x_m;
  features[1] = state.last.y_m;
  features[2] = turn.sin;
  features[3] = turn.cos;
  features[4] = state.velocity_x_mps;
  features[5] = state.velocity_y_mps;
  features[6] = speed_mps;
  features[7] = kStepS * static_cast<float>(step * kStepsPerDecode);
}

void plan_features(const StepState& state, const float (&plan)[kPlanValues],
                   const float (&pair)[kPairFeatures], float (&features)[kPlanFeatures]) {
  const Point ahead = direction(state.last.heading_rad);
  const Point from = position(state.last);
  const Point begin = Point{plan[0], plan[1]} - from;
  const Point end = Point{plan[3], plan[4]} - from;
  const SinCos turn = sin_cos(plan[5] - state.last.heading_rad);
  features[0] = dot(ahead, begin);
  features[1] = cross(ahead, begin);
  features[2] = dot(ahead, end);
  features[3] = cross(ahead, end);
  features[4] = turn.sin;
  features[5] = turn.cos;
  features[6] = plan[6];
  features[7] = plan[7];
  features[8] = plan[8];
  features[9] = pair[static_cast<int>(PairFeature::kZone)];
  features[10] = pair[static_cast<int>(PairFeature::kYields)];
  features[11] = pair[static_cast<int>(PairFeature::kHasPriority)];
}

}  // namespace s4tp::satp
