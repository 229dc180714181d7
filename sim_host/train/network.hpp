#pragma once
/// The predictor's network in libtorch, for all its sizes: parameters from the one table of layers, the
/// forward pass as docs/satp.md has it.

#include <torch/nn/module.h>
#include <torch/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "algo/satp/network_shape.hpp"
#include "sim_host/train/batch.hpp"
#include "sim_host/train/integer_rounding.hpp"

namespace s4tp::train {

/// A scene's vehicles, read once.
struct Encoded {
  torch::Tensor start;  ///< [V, K, hidden] hidden state of each mode
  torch::Tensor gate;   ///< [V, 1] how much our plan matters to it, 0 .. 1
  torch::Tensor route;  ///< [V, paths] attention over its lane paths
  torch::Tensor ego;    ///< of full alone: [B, horizon, 3] x, y, heading in our own frame (full_size.hpp)
};

/// What they will do.
struct Decoded {
  torch::Tensor pose;    ///< [V, K, horizon, 3] x, y [m], heading [rad] in the own frame
  torch::Tensor score;   ///< [V, K] softmax of score / temperature: probabilities
  torch::Tensor yields;  ///< [V, K] log-odds that such a one lets us pass first, if our ways meet
};

class Network : public torch::nn::Module {
 public:
  /// Parameters drawn from torch's generator: seed it first.
  explicit Network(const satp::NetworkShape& shape);

  [[nodiscard]] const satp::NetworkShape& shape() const { return shape_; }
  [[nodiscard]] Encoded encode(const Batch& batch);
  /// \param has_plan  [V], 1 where batch.plan is our plan, 0 where nothing is known of it
  [[nodiscard]] Decoded decode(const Batch& batch, const Encoded& encoded, const torch::Tensor& has_plan);

  /// From now on with the ECU's integers in it. \param ranges  of its layers' outputs, where learning them begins
  /// \throws std::runtime_error naming a range that is missing
  void round_as_integers(Ranges ranges);
  /// What it rounds with; null: it does not.
  [[nodiscard]] const IntegerRounding* rounding() const { return rounding_ ? &*rounding_ : nullptr; }

  /// Log-odds of yielding become `scale` times what they were plus `shift`.
  void rescale_yields(double scale, double shift);

  /// Number of parameters.
  [[nodiscard]] std::int64_t size() const;
  /// TRAIN-003 Everything the ECU needs, by the names of the table: NAME.weight, NAME.bias, NAME.gain, and
  /// for what is added by mode start.mode; row-major.
  [[nodiscard]] std::map<std::string, std::vector<float>> arrays() const;

 private:
  [[nodiscard]] bool full() const { return shape_.id == satp::kFullShape.id; }
  void add_layer(const std::string& name, satp::LayerKind kind, int rows, int columns, float share);
  [[nodiscard]] torch::Tensor linear(int layer, const torch::Tensor& x) const;
  [[nodiscard]] torch::Tensor relu(int layer, const torch::Tensor& x) const;
  /// What a layer hands on: `x`, rounded where the network rounds.
  [[nodiscard]] torch::Tensor kept(int layer, const torch::Tensor& x) const;
  [[nodiscard]] torch::Tensor normalize(int layer, const torch::Tensor& x) const;
  /// \param query [R, Q, d] \param keys [R, N, d] \param mask [R, N] \param weights  of the softmax, mean
  /// over heads [R, Q, N], when asked for \return [R, Q, d]
  [[nodiscard]] torch::Tensor attend(int block, const torch::Tensor& query, const torch::Tensor& keys,
                                     const torch::Tensor& mask, torch::Tensor* weights = nullptr) const;
  [[nodiscard]] torch::Tensor history(int embed, int block, const torch::Tensor& samples,
                                      const torch::Tensor& mask) const;

  /// What a channel of the map tells each vehicle. \param begin  its first layer \param agent [V, d]
  /// \param weights  over its paths [V, 1, paths], when asked for \return [V, d]
  [[nodiscard]] torch::Tensor map_channel(int begin, const torch::Tensor& agent, const MapChannel& map,
                                          torch::Tensor* weights = nullptr) const;

  satp::NetworkShape shape_;
  std::vector<torch::Tensor> weight_;  ///< by satp::Layer, then FullLayer; for a vector the vector itself
  std::vector<torch::Tensor> bias_;
  std::optional<IntegerRounding> rounding_;
  torch::Tensor mode_;      ///< [K, hidden]
  torch::Tensor position_;  ///< [samples, d], constant
  torch::Tensor head_of_;   ///< [d, heads], 1 where a feature belongs to a head
};

}  // namespace s4tp::train
