#include "sim_host/train/quantizer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "algo/satp/weight_image.hpp"

namespace s4tp::train {
namespace {

using satp::Format;
using satp::LayerInfo;
using satp::LayerKind;

constexpr double kMost8 = 127.0;
constexpr double kSumUnits = 8000.0;  // of an add's largest sum; 64 of them are one of an int8 activation
constexpr double kEmbedUnits = 24000.0;
constexpr double kWidestBias8 = 4194304.0;  // leaves the accumulator's other half to inputs and zero points
constexpr double kWidestBias16 = 1073741824.0;
constexpr double kShift8 = 16777216.0;     // 2^24, behind int8 inputs
constexpr double kShift16 = 4294967296.0;  // 2^32, behind int16 inputs

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

class Writer {
 public:
  Writer(const FloatNetwork& network, const Ranges& ranges) : network_(network), ranges_(ranges) {}

  std::vector<std::uint32_t> write(const ImageFacts& facts);

 private:
  [[nodiscard]] double magnitude(const std::string& name) const;
  [[nodiscard]] Scale int8(const std::string& name) const { return {magnitude(name) / kMost8, 0.0}; }
  [[nodiscard]] Scale relu(const std::string& name) const { return {magnitude(name) / 255.0, -128.0}; }
  [[nodiscard]] double units(const std::string& add) const { return magnitude(add) / kSumUnits; }
  [[nodiscard]] Scale history() const;
  [[nodiscard]] double embed_unit() const;
  [[nodiscard]] double output_scale(const LayerInfo& info) const;
  [[nodiscard]] std::vector<Segment> inputs_of(const LayerInfo& info) const;
  [[nodiscard]] Scale query_of(const std::string& block) const;
  [[nodiscard]] Scale keys_of(const std::string& block) const;

  [[nodiscard]] double bias_of(const LayerInfo& info, int row, int o) const;

  void word(std::int64_t value, const std::string& name);
  void multiplier(double ratio, double shift, const std::string& name);
  void linear(const LayerInfo& info);
  void norm(const LayerInfo& info);
  void adds(const LayerInfo& info);
  void score(const LayerInfo& info);

  const FloatNetwork& network_;
  const Ranges& ranges_;
  std::vector<std::uint32_t> words_;
};

std::string block_of(const std::string& name) {
  return name.substr(0, name.rfind('.'));
}

std::string part_of(const std::string& name) {
  return name.substr(name.rfind('.') + 1);
}

double Writer::magnitude(const std::string& name) const {
  const auto found = ranges_.find(name);
  if (found == ranges_.end() || !(found->second.magnitude() > 0.0F) ||
      !std::isfinite(found->second.magnitude()))
    throw std::runtime_error("no range of " + name + " was seen");
  return found->second.magnitude();
}

// Both kinds of history go into the same sums.
Scale Writer::history() const {
  return {
      std::max(magnitude("ego_history.attention.norm_2"), magnitude("hdv_history.attention.norm_2")) / kMost8,
      0.0};
}

// Of the GRU's two addends.
double Writer::embed_unit() const {
  double most = std::max(magnitude("own.embed"), magnitude("plan.embed"));
  for (const float value : network_.tensors().at("null_plan"))
    most = std::max(most, static_cast<double>(value));
  return most / kEmbedUnits;
}

Scale Writer::query_of(const std::string& block) const {
  if (block == "ego_history.attention") return int8("ego_history.embed_2");
  if (block == "hdv_history.attention") return int8("hdv_history.embed_2");
  if (block == "agent_1") return {64.0 * units("token.add"), 0.0};
  if (block == "agent_2") return {64.0 * units("agent_2.input"), 0.0};
  return int8("agent_2.norm_2");
}

Scale Writer::keys_of(const std::string& block) const {
  if (block == "lane") return relu("map.point_2");
  if (block == "route") return int8("lane.norm_2");
  return query_of(block);
}

std::vector<Segment> Writer::inputs_of(const LayerInfo& info) const {
  const std::string name = info.name;
  const std::string block = block_of(name);
  const std::string part = part_of(name);
  const int width = network_.shape().width;
  const int embed = network_.shape().embed;
  const int hidden = network_.shape().hidden;
  const Scale state8{1.0 / 128.0, 0.0};
  const auto whole = [&](const Scale& scale) { return std::vector<Segment>{{info.columns, scale}}; };
  if (info.input == Format::kQ13) return whole({1.0 / 8192.0, 0.0});
  if (info.input == Format::kQ15) return whole({1.0 / 32768.0, 0.0});
  if (part == "embed_2") return whole(relu(block + ".embed_1"));
  if (part == "query") return whole(query_of(block));
  if (part == "key" || part == "value") return whole(keys_of(block));
  if (part == "output") return whole(int8(block + ".value"));
  if (part == "expand") return whole(int8(block + ".norm_1"));
  if (part == "contract") return whole(relu(block + ".expand"));
  if (name == "map.point_2") return whole(relu("map.point_1"));
  if (name == "pair.pair_2") return whole(relu("pair.pair_1"));
  if (name == "gate.gate_1") return {{width, history()}, {width, history()}, {width, relu("pair.pair_2")}};
  if (name == "gate.gate_2") return whole(relu("gate.gate_1"));
  if (name == "start.state")
    return {{width, int8("agent_2.norm_2")}, {width, int8("route.norm_2")}, {width, relu("pair.pair_2")}};
  if (name == "gru.gates") return {{embed, relu("gru.mix")}, {hidden, state8}};
  if (name == "gru.input") return whole(relu("gru.mix"));
  if (name == "gru.state") return whole(state8);
  throw std::logic_error("no input is known of " + name);
}

double Writer::output_scale(const LayerInfo& info) const {
  const std::string name = info.name;
  const std::string block = block_of(name);
  switch (info.output) {
    case Format::kInt8:
      return int8(name).scale;
    case Format::kInt8Relu:
      return relu(name).scale;
    case Format::kInt16Relu:
      return embed_unit();
    case Format::kQ12:
      return 1.0 / 4096.0;
    case Format::kInt16:
      if (name == "place.embed") return units("token.add");
      return units(block + (part_of(name) == "output" ? ".add_1" : ".add_2"));
    default:
      break;
  }
  throw std::logic_error("no output scale is known of " + name);
}

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
  const bool wide = info.input == Format::kQ13 || info.input == Format::kQ15;
  std::vector<Scale> columns;
  double common = 0.0;
  for (const Segment& segment : inputs_of(info)) {
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
        std::max(most / kMost8, largest_bias / common / (wide ? kWidestBias16 : kWidestBias8));
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
      multiplier(sum_scale[o] / output_scale(info), wide ? kShift16 : kShift8, name);
    }
  }
  const std::size_t from = words_.size();
  words_.resize(from + quantized.size() / 4);
  std::memcpy(&words_[from], quantized.data(), quantized.size());
}

void Writer::norm(const LayerInfo& info) {
  const std::string name = info.name;
  const bool history_end = name == "ego_history.attention.norm_2" || name == "hdv_history.attention.norm_2";
  const double scale = history_end ? history().scale : int8(name).scale;
  for (const float bias : network_.tensors().at(name + ".bias"))
    word(std::llround(bias / scale * 1048576.0), name);
  for (const float gain : network_.tensors().at(name + ".gain"))
    word(std::llround(gain / scale * 256.0), name);
}

void Writer::adds(const LayerInfo& info) {
  const std::string name = info.name;
  const std::string block = block_of(name);
  if (name == "token.add") return multiplier(history().scale / units(name), kShift8, name);
  if (name == "agent_2.input") {
    multiplier(64.0 * units("token.add") / units(name), kShift8, name);
    return multiplier(int8("agent_1.norm_2").scale / units(name), kShift8, name);
  }
  if (name == "gru.mix") return multiplier(embed_unit() / relu(name).scale, kShift8, name);
  const Scale residual = part_of(name) == "add_1" ? query_of(block) : int8(block + ".norm_1");
  multiplier(residual.scale / units(name), kShift8, name);
}

void Writer::score(const LayerInfo& info) {
  const std::string block = block_of(info.name);
  const double head_width = network_.shape().width / network_.shape().heads;
  const double product = int8(block + ".query").scale * int8(block + ".key").scale / std::sqrt(head_width);
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
          word(std::llround(static_cast<double>(value) / embed_unit()), info.name);
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
