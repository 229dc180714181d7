#pragma once
/// What one step of each activation is worth: shared by the way from real numbers to integers and the way back.

#include <string>
#include <vector>

#include "sim_host/train/float_network.hpp"

namespace s4tp::train {

inline constexpr double kMost8 = 127.0;
inline constexpr double kShift8 = 16777216.0;     ///< 2^24, behind int8 inputs
inline constexpr double kShift16 = 4294967296.0;  ///< 2^32, behind int16 inputs

/// value = scale * (q - zero).
struct Scale {
  double scale = 0.0;
  double zero = 0.0;
};

/// A stretch of a layer's input and what it comes from.
struct Segment {
  int columns = 0;
  Scale scale;
};

/// "agent_1" of "agent_1.norm_2", and "norm_2" of it.
[[nodiscard]] std::string block_of(const std::string& name);
[[nodiscard]] std::string part_of(const std::string& name);
/// Whether its inputs are int16.
[[nodiscard]] bool wide(const satp::LayerInfo& info);

class ActivationScales {
 public:
  /// \param ranges  of the layers' outputs; must outlive this \param largest_null_plan  it goes the embeddings' way
  ActivationScales(const satp::NetworkShape& shape, const Ranges& ranges, double largest_null_plan)
      : shape_(shape), ranges_(ranges), largest_null_plan_(largest_null_plan) {}

  /// Of a layer's inputs and output. \throws std::runtime_error naming a range that was not seen
  [[nodiscard]] std::vector<Segment> inputs_of(const satp::LayerInfo& info) const;
  [[nodiscard]] double output_scale(const satp::LayerInfo& info) const;
  [[nodiscard]] Scale int8(const std::string& name) const { return {magnitude(name) / kMost8, 0.0}; }
  [[nodiscard]] Scale relu(const std::string& name) const { return {magnitude(name) / 255.0, -128.0}; }
  [[nodiscard]] double units(const std::string& add) const { return magnitude(add) / kSumUnits; }
  /// Both kinds of history go into the same sums.
  [[nodiscard]] Scale history() const;
  /// Of the GRU's two addends.
  [[nodiscard]] double embed_unit() const;
  [[nodiscard]] Scale query_of(const std::string& block) const;

  static constexpr double kSumUnits = 8000.0;  ///< of an add's largest sum; 64 are one of an int8 activation
  static constexpr double kEmbedUnits = 24000.0;

 private:
  [[nodiscard]] double magnitude(const std::string& name) const;
  [[nodiscard]] Scale keys_of(const std::string& block) const;

  satp::NetworkShape shape_;
  const Ranges& ranges_;
  double largest_null_plan_;
};

}  // namespace s4tp::train
