#pragma once
/// The network's first half: from what is seen to the state each vehicle's futures start from. Once a cycle.

#include <cstdint>

#include "algo/satp/attention.hpp"
#include "algo/satp/network_input.hpp"
#include "algo/satp/weight_image.hpp"

namespace s4tp::satp {

/// Most columns of what a vehicle's history or a lane's points are told by, filled up.
inline constexpr int kMaxFeatures = 8;

/// All the decoder needs of the scene.
struct Encoded {
  int hdvs = 0;
  std::int16_t start[kMaxAgents][kMcuShape.modes][kMcuShape.hidden];  ///< 2^-15
  /// How strongly our plan enters its futures, 2^-15; 0: not at all, our paths do not meet.
  std::int16_t gate[kMaxAgents];
  float speed_mps[kMaxAgents];
  float pair[kMaxAgents][kPairFeatures];
  Pose anchor[kMaxAgents];
};

/// Room for one call of encode.
struct EncoderScratch {
  static constexpr int kAgents = 1 + kMaxAgents;
  using Features = std::int8_t[kAgents][kMcuShape.width];
  using Tokens = std::int8_t[kLanePoints][kMcuShape.width];

  alignas(4) Features histories, tokens, second, mixed, agent_keys, agent_values;
  alignas(4) Tokens inner, seen, keys, lanes;
  alignas(4) std::int16_t features[kLanePoints][kMaxFeatures];
  std::int16_t places[kAgents][kMcuShape.width];
  AttentionScratch attention;
};

/// SATP-030 The same input and weights give the same bits on every target. SATP-031 Vehicles that are not
/// there change nothing. \pre weights.present()
void encode(const Weights& weights, const NetworkInput& input, EncoderScratch& scratch, Encoded& encoded);

}  // namespace s4tp::satp
