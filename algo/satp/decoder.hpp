#pragma once
/// The network's second half: from a vehicle's state to its futures, without our plan or for a plan.

#include "algo/satp/encoder.hpp"
#include "algo/satp/gru_cell.hpp"

namespace s4tp::satp {

/// The futures of one vehicle in its own frame; pose i at (i + 1) * kStepS after plan start.
struct Futures {
  float probability[kMcuShape.modes];
  /// How likely it lets us pass first, if that is how it drives and our paths meet.
  float yields[kMcuShape.modes];
  Pose poses[kMcuShape.modes][kHorizonSteps];
};

/// Room for one call of decode.
struct DecoderScratch {
  static constexpr int kModes = kMcuShape.modes;
  static_assert(kOwnFeatures % 4 == 0 && kPlanFeatures % 4 == 0, "rows are as long as the kernels read");

  alignas(4) std::int16_t own_rows[kModes][kOwnFeatures];
  alignas(4) std::int16_t plan_rows[kModes][kPlanFeatures];
  std::int16_t own[kModes][kEmbed];
  std::int16_t ours[kModes][kEmbed];
  alignas(4) std::int8_t inputs[kModes][kGruInput];
  alignas(4) std::int16_t states[kModes][kHidden];
  alignas(4) std::int16_t ends[kModes][2 * kHidden];
  float increments[kModes][3 * kStepsPerDecode];
  GruScratch gru;
};

/// SATP-032 Every pose is finite and within 300 m; probabilities are in 0 .. 1, those of the futures add up to 1.
/// SATP-033 Without a plan nothing of a plan enters; with a gate of 0 a plan and none give the same bits.
/// \param plan  PlanInput::step of the vehicle, or null \pre hdv < encoded.hdvs
void decode(const Weights& weights, const Encoded& encoded, int hdv, const float (*plan)[kPlanValues],
            DecoderScratch& scratch, Futures& futures);

}  // namespace s4tp::satp
