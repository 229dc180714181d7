#pragma once
/// What the training makes small (method.md 2).
/// TRAIN-017 Who shares a zone with us counts as three: few do, and what they do is what we plan by.
/// TRAIN-018 Beside the distances the likelihood at the horizon's end, of the mixture of all modes; who is not seen any
/// more then has none.
/// TRAIN-019 With a teacher half of the total is learned from it: each of its futures is taken for what happens, as often as it is
/// probable.

#include <torch/types.h>

#include "sim_host/train/network.hpp"

namespace s4tp::train {

/// Means over vehicles that were seen for at least one step.
struct Loss {
  torch::Tensor total;
  torch::Tensor position;    ///< smooth L1 of the mode nearest to what happened: x, y [m], heading [rad]
  torch::Tensor expected;    ///< the same of all modes, by their probabilities
  torch::Tensor mode;        ///< cross-entropy of the modes' probabilities to which of them were nearest
  torch::Tensor likelihood;  ///< -log of the mixture of modes at the horizon's end, up to a constant
  torch::Tensor route;       ///< cross-entropy of the attention over lane paths, where the one taken is known
  torch::Tensor yields;  ///< of each mode's odds of letting us pass, weighted as in `mode`, where it is known
  torch::Tensor
      ego;  ///< smooth L1 of the ego head where a sample tells our motion; of other sizes than full 0
};

/// \param teacher  what a larger network expects of the same batch, or nullptr; the parts but the total are of what did happen
[[nodiscard]] Loss loss_of(const Batch& batch, const Encoded& encoded, const Decoded& decoded,
                           const Decoded* teacher = nullptr);

/// Mean distance over the steps seen, of each mode [V, K]; 0 where nothing was seen.
[[nodiscard]] torch::Tensor mean_distance_m(const Batch& batch, const Decoded& decoded);

}  // namespace s4tp::train
