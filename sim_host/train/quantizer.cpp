#include "sim_host/train/quantizer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "algo/satp/weight_image.hpp"
#include "sim_host/train/activation_scales.hpp"

namespace s4tp::train {
namespace {

using satp::Format;
using satp::LayerInfo;
using satp::LayerKind;

constexpr double kWidestBias8 = 4194304.0;  // leaves the accumulator's other half to inputs and zero points
constexpr double kWidestBias16 = 1073741824.0;

double largest(const std::vector<float>& values) {
  return static_cast<double>(*std::max_element(values.begin(), values.end()));
}

class Writer {
 public:
  Writer(const FloatNetwork& network, const Ranges& ranges)
      : network_(network), scales_(network.shape(), ranges, largest(network.tensors().at("null_plan"))) {}

  std::vector<std::uint32_t> write(const ImageFacts& facts);

 private:
  [[nodiscard]] double bias_of(const LayerInfo& info, int row, int o) const;

  void word(std::int64_t value, const std::string& name);
  void multiplier(double ratio, double shift, const std::string& name);
  void linear(const LayerInfo& info);
  void norm(const LayerInfo& info);
  void adds(const LayerInfo& info);
  void score(const LayerInfo& info);

  const FloatNetwork& network_;
  ActivationScales scales_;
  std::vector<std::uint32_t> words_;
};

void Writer::word(std::int64_t value, const std::string& name) {
  if (value > INT32_MAX || value < INT32_MIN)
    throw std::runtime_error(name + ": a number does not fit 32 bits");
  words_.push_back(static_cast<std::uint32_t>(static_cast<std::int32_t>(value)));
}

void Writer::multiplier(double ratio, double shift, const std::string& name) {
  word(std::llround(ratio * shift), name);
}

// Of output `o`: position and mode are known beforehand.
double Writer::bias_of(const LayerInfo& info, int row, int o) const {
  const std::string name = info.name;
  double bias = network_.tensors().at(name + ".bias")[o];
  if (part_of(name) == "embed_2") bias += position_encoding(network_.shape(), row, o);
  if (name == "start.state") bias += network_.tensors().at("start.mode")[row * info.rows + o];
  return bias;
}

void Writer::linear(const LayerInfo& info) {
  const std::string name = info.name;
  const std::vector<float>& weight = network_.tensors().at(name + ".weight");
  std::vector<Scale> columns;
  double common = 0.0;
  for (const Segment& segment : scales_.inputs_of(info)) {
    columns.insert(columns.end(), static_cast<std::size_t>(segment.columns), segment.scale);
    common = std::max(common, segment.scale.scale);
  }
  const int stride = satp::row_stride(info);
  std::vector<std::int8_t> quantized(static_cast<std::size_t>(info.rows) * stride, 0);
  std::vector<double> sum_scale(static_cast<std::size_t>(info.rows));
  std::vector<double> zero_sum(static_cast<std::size_t>(info.rows), 0.0);
  for (int o = 0; o < info.rows; ++o) {
    const auto folded = [&](int j) {
      return static_cast<double>(weight[o * info.columns + j]) * columns[j].scale / common;
    };
    double most = 1e-9;  // a row of zeros keeps a scale
    for (int j = 0; j < info.columns; ++j) most = std::max(most, std::fabs(folded(j)));
    // A bias that outweighs all inputs together must still fit its accumulator.
    double largest_bias = 0.0;
    for (int b = 0; b < info.bias_rows; ++b)
      largest_bias = std::max(largest_bias, std::fabs(bias_of(info, b, o)));
    const double weight_scale =
        std::max(most / kMost8, largest_bias / common / (wide(info) ? kWidestBias16 : kWidestBias8));
    for (int j = 0; j < info.columns; ++j) {
      const double q = std::round(folded(j) / weight_scale);
      quantized[o * stride + j] = static_cast<std::int8_t>(q);
      zero_sum[o] += q * columns[j].zero;
    }
    sum_scale[o] = weight_scale * common;
  }
  for (int b = 0; b < info.bias_rows; ++b) {
    for (int o = 0; o < info.rows; ++o) {
      word(std::llround(bias_of(info, b, o) / sum_scale[o] - zero_sum[o]), name);
    }
  }
  for (int o = 0; o < info.rows; ++o) {
    if (info.output == Format::kReal) {
      const double unit = name == "head.increments" ? satp::kIncrementUnit[o % 3] : 1.0;
      const float scale = static_cast<float>(sum_scale[o] * unit);
      std::uint32_t bits = 0;
      std::memcpy(&bits, &scale, sizeof bits);
      words_.push_back(bits);
    } else {
      multiplier(sum_scale[o] / scales_.output_scale(info), wide(info) ? kShift16 : kShift8, name);
    }
  }
  const std::size_t from = words_.size();
  words_.resize(from + quantized.size() / 4);
  std::memcpy(&words_[from], quantized.data(), quantized.size());
}

void Writer::norm(const LayerInfo& info) {
  const std::string name = info.name;
  const bool history_end = name == "ego_history.attention.norm_2" || name == "hdv_history.attention.norm_2";
  const double scale = history_end ? scales_.history().scale : scales_.int8(name).scale;
  for (const float bias : network_.tensors().at(name + ".bias"))
    word(std::llround(bias / scale * 1048576.0), name);
  for (const float gain : network_.tensors().at(name + ".gain"))
    word(std::llround(gain / scale * 256.0), name);
}

void Writer::adds(const LayerInfo& info) {
  const std::string name = info.name;
  const std::string block = block_of(name);
  if (name == "token.add") return multiplier(scales_.history().scale / scales_.units(name), kShift8, name);
  if (name == "agent_2.input") {
    multiplier(64.0 * scales_.units("token.add") / scales_.units(name), kShift8, name);
    return multiplier(scales_.int8("agent_1.norm_2").scale / scales_.units(name), kShift8, name);
  }
  if (name == "gru.mix") return multiplier(scales_.embed_unit() / scales_.relu(name).scale, kShift8, name);
  const Scale residual = part_of(name) == "add_1" ? scales_.query_of(block) : scales_.int8(block + ".norm_1");
  multiplier(residual.scale / scales_.units(name), kShift8, name);
}

void Writer::score(const LayerInfo& info) {
  const std::string block = block_of(info.name);
  const double head_width = network_.shape().width / network_.shape().heads;
  const double product =
      scales_.int8(block + ".query").scale * scales_.int8(block + ".key").scale / std::sqrt(head_width);
  multiplier(product * 256.0, kShift8, info.name);
}

std::vector<std::uint32_t> Writer::write(const ImageFacts& facts) {
  satp::WeightHeader header = satp::header_of(network_.shape());
  header.temperature = facts.temperature;
  header.usual_residual_m = facts.usual_residual_m;
  header.trained_steps = facts.trained_steps;
  header.seed = facts.seed;
  words_.resize(sizeof header / 4);
  for (int i = 0; i < satp::kLayerCount; ++i) {
    const LayerInfo info = satp::layer_info(network_.shape(), i);
    switch (info.kind) {
      case LayerKind::kLinear:
        linear(info);
        break;
      case LayerKind::kLayerNorm:
        norm(info);
        break;
      case LayerKind::kAdd:
        adds(info);
        break;
      case LayerKind::kScores:
        score(info);
        break;
      case LayerKind::kVector:
        for (const float value : network_.tensors().at(info.name))
          word(std::llround(static_cast<double>(value) / scales_.embed_unit()), info.name);
        break;
    }
  }
  std::memcpy(words_.data(), &header, sizeof header);
  satp::seal(words_.data());
  return std::move(words_);
}

}  // namespace

std::vector<std::uint32_t> quantize(const FloatNetwork& network, const Ranges& ranges,
                                    const ImageFacts& facts) {
  return Writer(network, ranges).write(facts);
}

}  // namespace s4tp::train
