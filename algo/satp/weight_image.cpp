#include "algo/satp/weight_image.hpp"

#include <cstddef>
#include <cstring>

#include "algo/core/crc32.hpp"
#include "algo/core/inline.hpp"

namespace s4tp::satp {
namespace {

// The network this firmware computes.
constexpr NetworkShape kShape = kMcuShape;

constexpr float kColdest = 0.05F;  // temperatures a calibration can find
constexpr float kHottest = 20.0F;

struct Offsets {
  int bytes[kLayerCount];
};

constexpr Offsets offsets_of() {
  Offsets offsets{};
  int offset = 0;
  for (int i = 0; i < kLayerCount; ++i) {
    offsets.bytes[i] = offset;
    offset += layer_bytes(layer_info(kShape, i));
  }
  return offsets;
}

constexpr Offsets kOffsets = offsets_of();

constexpr std::uint32_t kHeaderCrcBytes = offsetof(WeightHeader, header_crc);
constexpr std::int64_t kInt8AccumulatorLimit = 1 << 23;  // requantize.hpp
constexpr std::int64_t kInt16AccumulatorLimit = std::int64_t{1} << 31;
constexpr std::int32_t kLargestGain = 32767;
constexpr std::int32_t kLargestNormBias = 1 << 30;

bool same_shape(const WeightHeader& a, const WeightHeader& b) {
  return a.shape_id == b.shape_id && a.width == b.width && a.heads == b.heads &&
         a.feed_forward == b.feed_forward && a.hidden == b.hidden && a.embed == b.embed &&
         a.modes == b.modes && a.lane_points == b.lane_points && a.decoder_steps == b.decoder_steps &&
         a.steps_per_decode == b.steps_per_decode;
}

std::int64_t magnitude(std::int64_t x) {
  return x < 0 ? -x : x;
}

bool sound(const LayerInfo& info, const Linear& layer) {
  const bool wide = info.input == Format::kQ13 || info.input == Format::kQ15;
  const std::int64_t largest = wide ? 32768 : 128;
  const std::int64_t limit = wide ? kInt16AccumulatorLimit : kInt8AccumulatorLimit;
  for (int row = 0; row < layer.rows; ++row) {
    std::int64_t sum = 0;
    for (int j = 0; j < layer.stride; ++j) {
      const int weight = layer.weights[row * layer.stride + j];
      if (weight == -128 || (j >= layer.columns && weight != 0)) return false;
      sum += weight < 0 ? -weight : weight;
    }
    for (int b = 0; b < info.bias_rows; ++b) {
      if (sum * largest + magnitude(layer.bias[b * layer.rows + row]) >= limit) return false;
    }
    if (info.output == Format::kReal) {
      float scale = 0.0F;
      std::memcpy(&scale, &layer.multiplier[row], sizeof scale);
      if (!(abs(scale) < 1.0F)) return false;  // not a number as well
    } else if (layer.multiplier[row] < 0) {
      return false;
    }
  }
  return true;
}

bool sound(const Weights& weights, int index) {
  const LayerInfo info = layer_info(kShape, index);
  if (info.kind == LayerKind::kLinear) return sound(info, weights.linear(index));
  const std::int32_t* words = weights.words(index);
  for (int i = 0; i < info.rows; ++i) {
    switch (info.kind) {
      case LayerKind::kLayerNorm:
        if (magnitude(words[i]) > kLargestNormBias || magnitude(words[info.rows + i]) > kLargestGain)
          return false;
        break;
      case LayerKind::kVector:
        if (words[i] < 0 || words[i] > 32767) return false;
        break;
      case LayerKind::kAdd:
      case LayerKind::kScores:
        if (words[i] < 0) return false;
        break;
      case LayerKind::kLinear:
        break;
    }
  }
  return true;
}

}  // namespace

const char* weight_status_name(WeightStatus status) {
  constexpr const char* kNames[] = {"ok",     "absent", "truncated", "not weights",
                                    "format", "shape",  "checksum",  "range"};
  return kNames[static_cast<int>(status)];
}

WeightStatus Weights::check(const void* image, std::uint32_t size_bytes, Weights& weights) {
  if (image == nullptr) return WeightStatus::kAbsent;
  if (size_bytes < sizeof(WeightHeader)) return WeightStatus::kTruncated;
  if (reinterpret_cast<std::uintptr_t>(image) % alignof(WeightHeader) != 0) return WeightStatus::kNotWeights;
  const auto* header = static_cast<const WeightHeader*>(image);
  if (header->magic != kWeightMagic) return WeightStatus::kNotWeights;
  if (header->format != kWeightFormat) return WeightStatus::kFormat;
  if (crc32(image, kHeaderCrcBytes) != header->header_crc) return WeightStatus::kChecksum;
  const WeightHeader expected = header_of(kShape);
  if (!same_shape(*header, expected) || header->payload_bytes != expected.payload_bytes)
    return WeightStatus::kShape;
  if (size_bytes - sizeof(WeightHeader) < header->payload_bytes) return WeightStatus::kTruncated;
  if (crc32(header + 1, header->payload_bytes) != header->payload_crc) return WeightStatus::kChecksum;
  // Written so that NaN fails.
  if (!(header->temperature >= kColdest && header->temperature <= kHottest)) return WeightStatus::kRange;
  if (!(header->usual_residual_m >= 0.0F && header->usual_residual_m <= 100.0F)) return WeightStatus::kRange;
  Weights checked;
  checked.header_ = header;
  checked.payload_ = reinterpret_cast<const std::int32_t*>(header + 1);
  for (int i = 0; i < kLayerCount; ++i) {
    if (!sound(checked, i)) return WeightStatus::kRange;
  }
  weights = checked;
  return WeightStatus::kOk;
}

const std::int32_t* Weights::words(int layer) const {
  return payload_ + kOffsets.bytes[layer] / 4;
}

Linear Weights::linear(int layer) const {
  const LayerInfo info = layer_info(kShape, layer);
  const std::int32_t* bias = words(layer);
  const std::int32_t* multiplier = bias + info.bias_rows * info.rows;
  return {reinterpret_cast<const std::int8_t*>(multiplier + info.rows),
          bias,
          multiplier,
          info.rows,
          info.columns,
          static_cast<std::int16_t>(row_stride(info))};
}

Norm Weights::norm(int layer) const {
  const std::int32_t* bias = words(layer);
  return {bias, bias + layer_info(kShape, layer).rows};
}

WeightHeader header_of(const NetworkShape& shape) {
  const auto word = [](int value) { return static_cast<std::uint32_t>(value); };
  WeightHeader header{};
  header.magic = kWeightMagic;
  header.format = kWeightFormat;
  header.shape_id = shape.id;
  header.width = word(shape.width);
  header.heads = word(shape.heads);
  header.feed_forward = word(shape.feed_forward);
  header.hidden = word(shape.hidden);
  header.embed = word(shape.embed);
  header.modes = word(shape.modes);
  header.lane_points = word(shape.lane_points);
  header.decoder_steps = word(shape.decoder_steps);
  header.steps_per_decode = word(shape.steps_per_decode);
  header.payload_bytes = word(payload_bytes(shape));
  header.temperature = 1.0F;
  header.usual_residual_m = 0.5F;
  return header;
}

void seal(void* image) {
  auto* header = static_cast<WeightHeader*>(image);
  header->payload_crc = crc32(header + 1, header->payload_bytes);
  header->header_crc = crc32(header, kHeaderCrcBytes);
}

}  // namespace s4tp::satp
