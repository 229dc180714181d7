#pragma once
/// A network of random numbers and scenes of random numbers, the same on every processor: nothing it predicts
/// makes sense, but every operator works on values of a usual size. C++17, no heap: targets compute it too.

#include <cstdint>
#include <cstring>
#include <new>

#include "algo/core/math.hpp"
#include "algo/satp/network_input.hpp"
#include "algo/satp/weight_image.hpp"

namespace s4tp::test {

/// Linear congruential generator (Knuth's MMIX constants), its upper half.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {
    for (int i = 0; i < 4; ++i) (void)next();
  }
  std::uint32_t next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::uint32_t>(state_ >> 32U);
  }
  /// low .. high, both included
  int integer(int low, int high) {
    return low + static_cast<int>(next() % static_cast<std::uint32_t>(high - low + 1));
  }
  float real(float low, float high) {
    return low + (high - low) * (static_cast<float>(next() >> 8U) * 5.9604644775390625e-8F);
  }

 private:
  std::uint64_t state_;
};

namespace detail {

inline std::int32_t whole(float x) {
  return to_int(x, -2147483647, 2147483647);
}

/// How much a layer's output of usual inputs varies, asked for.
inline float usual_output(satp::Format format) {
  switch (format) {
    case satp::Format::kInt16:
      return 2500.0F;
    case satp::Format::kInt16Relu:
      return 6000.0F;
    case satp::Format::kQ12:
      return 5000.0F;
    case satp::Format::kReal:
      return 0.05F;
    default:
      break;
  }
  return 45.0F;
}

inline std::int32_t* fill_linear(const satp::LayerInfo& info, Random& random, std::int32_t* word) {
  const bool wide = info.input == satp::Format::kQ13 || info.input == satp::Format::kQ15;
  const float sum = sqrt(static_cast<float>(info.columns)) * 73.0F * (wide ? 6000.0F : 50.0F);
  for (int i = 0; i < info.bias_rows * info.rows; ++i) *word++ = whole(random.real(-0.5F, 0.5F) * sum);
  for (int o = 0; o < info.rows; ++o) {
    const float ratio = usual_output(info.output) / sum * random.real(0.7F, 1.3F);
    if (info.output == satp::Format::kReal) {
      std::memcpy(word++, &ratio, sizeof ratio);
    } else {
      *word++ = whole(wide ? ratio * 65536.0F * 65536.0F : ratio * 16777216.0F);
    }
  }
  auto* weights = reinterpret_cast<std::int8_t*>(word);
  const int stride = satp::row_stride(info);
  for (int o = 0; o < info.rows; ++o) {
    for (int j = 0; j < stride; ++j)
      weights[o * stride + j] = static_cast<std::int8_t>(j < info.columns ? random.integer(-127, 127) : 0);
  }
  return word + info.rows * stride / 4;
}

inline std::int32_t other_word(const satp::LayerInfo& info, int index, Random& random) {
  switch (info.kind) {
    case satp::LayerKind::kLayerNorm:
      return index < info.rows ? random.integer(-15, 15) * (1 << 20) : random.integer(6000, 13000);
    case satp::LayerKind::kVector:
      return random.integer(0, 12000);
    case satp::LayerKind::kScores:
      return whole(random.real(0.03F, 0.1F) * 16777216.0F);
    default:
      break;
  }
  const bool mixes = std::strcmp(info.name, "gru.mix") == 0;
  return whole((mixes ? random.real(0.008F, 0.012F) : random.real(30.0F, 60.0F)) * 16777216.0F);
}

}  // namespace detail

/// An image that passes Weights::check. \param words  kImageBytes / 4 of them
inline void make_random_image(std::uint64_t seed, std::int32_t* words) {
  Random random(seed);
  const satp::WeightHeader header = satp::header_of(satp::kMcuShape);
  std::memcpy(words, &header, sizeof header);
  std::int32_t* word = words + sizeof header / 4;
  for (int i = 0; i < satp::kLayerCount; ++i) {
    const satp::LayerInfo info = satp::layer_info(satp::kMcuShape, i);
    if (info.kind == satp::LayerKind::kLinear) {
      word = detail::fill_linear(info, random, word);
      continue;
    }
    const int count = satp::layer_bytes(info) / 4;
    for (int k = 0; k < count; ++k) *word++ = detail::other_word(info, k, random);
  }
  satp::seal(words);
}

/// Values of the size the units stand for; lane paths of any length, none too.
inline void make_random_input(std::uint64_t seed, int hdvs, satp::NetworkInput& input) {
  Random random(seed);
  new (&input) satp::NetworkInput;
  input.hdvs = hdvs;
  const auto fill = [&random](float* row, const float* units, int count) {
    for (int c = 0; c < count; ++c) row[c] = random.real(-1.5F, 1.5F) * units[c];
  };
  input.ego_history_valid = 0x7FF;
  for (auto& row : input.ego_history) fill(row, satp::kHistoryUnit, satp::kHistoryFeatures);
  for (int a = 0; a <= hdvs; ++a) fill(input.place[a], satp::kPlaceUnit, satp::kPlaceFeatures);
  for (int i = 0; i < hdvs; ++i) {
    input.speed_mps[i] = random.real(0.0F, 15.0F);
    input.paths_meet[i] = i != 3 ? 1 : 0;
    input.history_valid[i] = static_cast<std::uint16_t>(0x400 | random.integer(0, 0x3FF));
    for (auto& row : input.history[i]) fill(row, satp::kHistoryUnit, satp::kHistoryFeatures);
    fill(input.pair[i], satp::kPairUnit, satp::kPairFeatures);
    for (int k = 0; k < kPathsPerAgent; ++k) {
      const int points = random.integer(0, satp::kLanePoints);
      input.lane_points[i][k] = static_cast<std::uint8_t>(points);
      for (int p = 0; p < points; ++p) fill(input.lane[i][k][p], satp::kLaneUnit, satp::kLaneFeatures);
    }
  }
}

inline void make_random_plan(std::uint64_t seed, int hdvs, satp::PlanInput& plan) {
  Random random(seed);
  new (&plan) satp::PlanInput;
  for (int i = 0; i < hdvs; ++i) {
    for (auto& row : plan.step[i]) {
      for (float& value : row) value = random.real(-20.0F, 20.0F);
      row[2] = random.real(-3.0F, 3.0F);
      row[5] = random.real(-3.0F, 3.0F);
    }
  }
}

/// FNV-1a over the bytes.
inline std::uint32_t hash_bytes(const void* data, int size, std::uint32_t value = 2166136261U) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (int i = 0; i < size; ++i) value = (value ^ bytes[i]) * 16777619U;
  return value;
}

}  // namespace s4tp::test
