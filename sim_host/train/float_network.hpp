#pragma once
/// The network in plain floating point, for any size of the table: what the trained model must agree with,
/// what the integer network is measured against, and what its activations' ranges are taken from.

#include <map>
#include <string>
#include <vector>

#include "algo/satp/network_input.hpp"
#include "algo/satp/network_shape.hpp"

namespace s4tp::train {

/// Numbers by name: "<linear>.weight" [rows][columns], "<linear>.bias", "<norm>.gain", "<norm>.bias",
/// "start.mode" [K][hidden], "null_plan" [embed] (>= 0).
using Tensors = std::map<std::string, std::vector<float>>;

/// Names and sizes of all tensors of a shape.
[[nodiscard]] std::map<std::string, int> tensor_sizes(const satp::NetworkShape& shape);

/// Sinusoidal position of history sample `t` in feature `c`: sin(t 10000^(-c / width)) for even c, the cosine
/// of the same for the odd one after it.
[[nodiscard]] float position_encoding(const satp::NetworkShape& shape, int t, int c);

struct Range {
  float low = 0.0F;
  float high = 0.0F;
  [[nodiscard]] float magnitude() const;
};
/// Of each layer's output, by its name in the table.
using Ranges = std::map<std::string, Range>;

/// What the decoder needs, per vehicle.
struct FloatEncoded {
  std::vector<float> start[kMaxAgents];  ///< [K][hidden]
  float gate[kMaxAgents] = {};
  float route[kMaxAgents][kPathsPerAgent] = {};  ///< attention over its lane paths, mean of the heads
};

struct FloatFutures {
  float score[kMaxModes] = {};
  float probability[kMaxModes] = {};
  float yields[kMaxModes] = {};
  float pose[kMaxModes][kHorizonSteps][3] = {};  ///< own frame: x, y, heading
};

class FloatNetwork {
 public:
  /// Throws std::runtime_error that names the tensor that is missing or of a wrong size.
  FloatNetwork(const satp::NetworkShape& shape, Tensors tensors);

  [[nodiscard]] FloatEncoded encode(const satp::NetworkInput& input);
  /// \param plan  null: without plan
  [[nodiscard]] FloatFutures decode(const FloatEncoded& encoded, const satp::NetworkInput& input, int hdv,
                                    const satp::PlanInput* plan, float temperature = 1.0F);

  [[nodiscard]] const satp::NetworkShape& shape() const { return shape_; }
  [[nodiscard]] const Tensors& tensors() const { return tensors_; }
  [[nodiscard]] const Ranges& ranges() const { return ranges_; }  ///< of all calls so far

 private:
  using Vector = std::vector<float>;
  Vector linear(const std::string& name, const Vector& input);
  Vector relu(const std::string& name, const Vector& input);
  Vector norm(const std::string& name, const Vector& input);
  Vector attend(const std::string& name, const Vector& query, const std::vector<Vector>& keys, unsigned mask,
                float* mean_weights = nullptr);
  Vector history(const std::string& name, const float (&rows)[kHistorySamples][satp::kHistoryFeatures],
                 unsigned valid);
  const Vector& record(const std::string& name, const Vector& values);

  satp::NetworkShape shape_;
  Tensors tensors_;
  Ranges ranges_;
};

}  // namespace s4tp::train
