#include "algo/sadrf/presets.hpp"

#include "algo/sadrf/field.hpp"

namespace s4tp::sadrf {

void choose_risk(FieldPreset preset, LookAhead look_ahead, Parameters& parameters) {
  // 95th percentile of R_obs(t) along collision-free drives of the traffic's own drivers (`s4tp risk
  // calibrate`).
  constexpr float kThresholds[2][2] = {{32300.0F, 126000.0F}, {18600.0F, 76400.0F}};  // [preset][look_ahead]
  const bool paper = preset == FieldPreset::kPaper;
  const FieldParams field = paper ? paper_preset(0.0F) : kolekar2020_preset(0.0F);
  auto& risk = parameters.risk;
  risk.steepness = field.steepness;
  risk.look_ahead_s = field.look_ahead_s;
  risk.look_ahead_shrinks = look_ahead == LookAhead::kShrinking ? 1.0F : 0.0F;
  risk.widening = field.widening;
  risk.widening_inner = field.widening_inner;
  risk.widening_outer = field.widening_outer;
  risk.threshold = kThresholds[paper ? 0 : 1][look_ahead == LookAhead::kShrinking ? 0 : 1];
}

}  // namespace s4tp::sadrf
