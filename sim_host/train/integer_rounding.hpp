#pragma once
/// TRAIN-014 What the ECU's integers make of the network's numbers, in torch: a training with it learns to live with
/// them, and how far each activation's range reaches (learned step sizes: Esser et al., arXiv 1902.08153).

#include <torch/types.h>

#include <vector>

#include "sim_host/train/activation_scales.hpp"

namespace s4tp::train {

class IntegerRounding {
 public:
  /// \param ranges  of the layers' outputs, as of a calibration: where learning begins
  /// \throws std::runtime_error naming one that is missing
  IntegerRounding(const satp::NetworkShape& shape, Ranges ranges, double largest_null_plan);

  [[nodiscard]] const Ranges& calibrated() const { return calibrated_; }
  /// Learned: [layers] natural logarithm of how many times the calibration's range a layer's output has.
  [[nodiscard]] const torch::Tensor& log_stretch() const { return log_stretch_; }
  /// As learned so far.
  [[nodiscard]] Ranges ranges() const;
  /// Before each forward pass: weights are folded with the ranges of now.
  void fold();

  /// \param layer  a linear one \return weight as int8, one scale a row, the scales of its inputs folded in
  [[nodiscard]] torch::Tensor weight(int layer, const torch::Tensor& weight) const;
  /// What a layer hands on, as int8; as it is where the ECU keeps 16 bits.
  [[nodiscard]] torch::Tensor output(int layer, const torch::Tensor& x) const;
  /// A GRU's hidden state as its gates read it.
  [[nodiscard]] static torch::Tensor state(const torch::Tensor& x);

 private:
  satp::NetworkShape shape_;
  Ranges calibrated_;
  double largest_null_plan_;
  torch::Tensor log_stretch_;
  std::vector<torch::Tensor> columns_;  ///< by layer: scale of each input over the largest of them
  std::vector<Scale> output_;           ///< by layer, as calibrated: 0 where it is not rounded
};

}  // namespace s4tp::train
