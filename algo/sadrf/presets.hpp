#pragma once
/// The two published shapes of the field, and how far it looks at later steps: what they set in
/// Parameters::risk, with the threshold C_t measured for each pair (docs/risk.md).

#include "algo/core/parameters.hpp"

namespace s4tp::sadrf {

enum class FieldPreset : std::uint8_t { kPaper = 0, kKolekar2020 = 1 };

enum class LookAhead : std::uint8_t {
  kShrinking = 0,  ///< max(t_la - t, 1 s) at t into the horizon
  kFixed = 1,      ///< t_la at every step, as the paper has it
};

/// CORE-071 Sets steepness, look-ahead, the three widenings and the threshold; everything else stays. The
/// pair (kPaper, kShrinking) is what Parameters{} holds.
void choose_risk(FieldPreset preset, LookAhead look_ahead, Parameters& parameters);

}  // namespace s4tp::sadrf
