// The network's operators against real arithmetic and against another implementation.

#include <gemmlowp/fixedpoint/fixedpoint.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "algo/satp/activation.hpp"
#include "algo/satp/attention.hpp"
#include "algo/satp/gru_cell.hpp"
#include "algo/satp/kernels.hpp"
#include "algo/satp/layer_norm.hpp"
#include "algo/satp/linear.hpp"
#include "algo/satp/requantize.hpp"
#include "algo/satp/softmax.hpp"
#include "tests/support/random_network.hpp"

namespace s4tp::satp {
namespace {

constexpr double kOne = 32768.0;

struct RandomNetwork {
  std::vector<std::int32_t> words = std::vector<std::int32_t>(kImageBytes / 4);
  Weights weights;

  explicit RandomNetwork(std::uint64_t seed = 3) {
    test::make_random_image(seed, words.data());
    EXPECT_EQ(Weights::check(words.data(), kImageBytes, weights), WeightStatus::kOk);
  }
};

// SATP-021 gemmlowp's product of 2^7 times the accumulator is the same but for halves below zero: it rounds
// them away from zero, we round up.
TEST(Requantize, AgreesWithGemmlowp) {
  test::Random random(11);
  int halves = 0;
  for (int i = 0; i < 200000; ++i) {
    const std::int32_t sum = random.integer(-(1 << 23) + 1, (1 << 23) - 1) >> random.integer(0, 20);
    // Every other multiplier is a power of two: then halves happen.
    const std::int32_t multiplier =
        i % 2 == 0 ? 1 << random.integer(0, 30)
                   : static_cast<std::int32_t>(random.next() >> 1U) >> random.integer(0, 25);
    const bool half = ((static_cast<std::int64_t>(sum) * multiplier) & 0xFFFFFF) == 0x800000 && sum < 0;
    const std::int32_t theirs = gemmlowp::SaturatingRoundingDoublingHighMul(sum * 128, multiplier);
    ASSERT_EQ(requantize(sum, multiplier), theirs) << sum << " * " << multiplier;
    halves += half ? 1 : 0;
  }
  EXPECT_GT(halves, 100);
}

// SATP-021 Corners: the largest sums and multipliers, halves on both sides of zero, shift 32.
TEST(Requantize, RoundsHalvesUp) {
  EXPECT_EQ(requantize(1, 1 << 23), 1);
  EXPECT_EQ(requantize(-1, 1 << 23), 0);
  EXPECT_EQ(requantize(-3, 1 << 23), -1);
  EXPECT_EQ(requantize((1 << 23) - 1, INT32_MAX), 1073741696);
  EXPECT_EQ(requantize(-(1 << 23) + 1, INT32_MAX), -1073741696);
  EXPECT_EQ(requantize_wide(INT32_MIN, INT32_MAX), -1073741823);
  EXPECT_EQ(requantize_wide(1 << 30, 2), 1);
  EXPECT_EQ(requantize_wide(-(1 << 30), 2), 0);
}

// SATP-020 Whatever kernel this target has, on every size of the network's layers.
TEST(Kernels, GiveTheReferencesBits) {
  const RandomNetwork network;
  test::Random random(5);
  std::vector<std::int8_t> narrow(kMaxBatch * kMaxColumns);
  std::vector<std::int16_t> wide(kMaxBatch * kMaxColumns);
  for (int layer = 0; layer < kLayerCount; ++layer) {
    const LayerInfo info = layer_info(kMcuShape, layer);
    if (info.kind != LayerKind::kLinear) continue;
    Linear linear = network.weights.linear(layer);
    linear.rows = std::min<std::int16_t>(linear.rows, kMaxRows);
    for (std::int8_t& value : narrow) value = static_cast<std::int8_t>(random.integer(-128, 127));
    for (std::int16_t& value : wide) value = static_cast<std::int16_t>(random.integer(-32768, 32767));
    for (int batch = 1; batch <= kMaxBatch; ++batch) {
      std::int32_t fast[kMaxBatch][kMaxRows] = {};
      std::int32_t plain[kMaxBatch][kMaxRows] = {};
      if (info.input == Format::kQ13 || info.input == Format::kQ15) {
        multiply(linear, linear.bias, 0, wide.data(), kMaxColumns, batch, fast);
        reference::multiply(linear, linear.bias, 0, wide.data(), kMaxColumns, batch, plain);
      } else {
        multiply(linear, linear.bias, 0, narrow.data(), kMaxColumns, batch, fast);
        reference::multiply(linear, linear.bias, 0, narrow.data(), kMaxColumns, batch, plain);
      }
      for (int b = 0; b < batch; ++b) {
        for (int o = 0; o < linear.rows; ++o)
          ASSERT_EQ(fast[b][o], plain[b][o]) << info.name << " " << b << " " << o;
      }
    }
  }
}

// SATP-021 Inputs at both ends of their range, on the network's own layers: outputs use their range and never
// leave it.
TEST(Linear, Saturates) {
  const RandomNetwork network;
  alignas(4) std::int8_t input[80];
  for (std::size_t j = 0; j < sizeof input; ++j) input[j] = j % 2 == 0 ? 127 : -127;
  Linear layer = network.weights.linear(kAgent1 + kQuery);
  std::vector<std::int32_t> large(32, INT32_MAX);
  layer.multiplier = large.data();
  alignas(4) std::int8_t output[32];
  linear(layer, {input, 80}, 1, Rows<std::int8_t>{output, 32});
  for (const std::int8_t value : output) EXPECT_TRUE(value == 127 || value == -128);
  linear_relu(layer, {input, 80}, 1, Rows<std::int8_t>{output, 32});
  int low = 0;
  for (const std::int8_t value : output) low += value == -128 ? 1 : 0;
  EXPECT_GT(low, 5);
  EXPECT_LT(low, 27);
}

// SATP-022 The whole range, every step of 2^-12.
TEST(Activation, FollowsSigmoidAndTanh) {
  double worst_sigmoid = 0.0;
  double worst_tanh = 0.0;
  std::int16_t last_sigmoid = 0;
  std::int16_t last_tanh = -32767;
  for (int q = -32767; q <= 32767; ++q) {
    const double x = q / 4096.0;
    const std::int16_t s = sigmoid_q15(static_cast<std::int16_t>(q));
    const std::int16_t t = tanh_q15(static_cast<std::int16_t>(q));
    worst_sigmoid = std::max(worst_sigmoid, std::fabs(s / kOne - 1.0 / (1.0 + std::exp(-x))));
    worst_tanh = std::max(worst_tanh, std::fabs(t / kOne - std::tanh(x)));
    ASSERT_GE(s, last_sigmoid);
    ASSERT_GE(t, last_tanh);
    EXPECT_NEAR(t, -tanh_q15(static_cast<std::int16_t>(-q)), 1);
    last_sigmoid = s;
    last_tanh = t;
  }
  EXPECT_LT(worst_sigmoid, 2e-4);
  EXPECT_LT(worst_tanh, 6e-4);
}

// SATP-023 Random scores, a third of the keys masked, some so far apart that only one counts.
TEST(Softmax, FollowsTheRealOne) {
  test::Random random(17);
  for (int round = 0; round < 2000; ++round) {
    const int count = random.integer(1, kMaxKeys);
    const float unit = random.real(0.0005F, 0.05F);
    std::int32_t scores[kMaxKeys];
    std::uint32_t mask = 0;
    double total = 0.0;
    std::int32_t largest = INT32_MIN;
    for (int j = 0; j < count; ++j) {
      scores[j] = random.integer(-4000, 4000);
      if (random.integer(0, 2) == 0) continue;
      mask |= 1U << static_cast<unsigned>(j);
      largest = std::max(largest, scores[j]);
    }
    std::int32_t weights[kMaxKeys];
    const auto multiplier = static_cast<std::int32_t>(unit * 256.0F * 16777216.0F / 16.0F);
    const double real_unit = multiplier / 256.0 / 16777216.0;
    const std::int32_t sum = softmax(scores, count, mask, multiplier, weights);
    if (mask == 0) {
      EXPECT_EQ(sum, 0);
      continue;
    }
    for (int j = 0; j < count; ++j)
      total += (mask >> j & 1U) != 0U ? std::exp(real_unit * (scores[j] - largest)) : 0.0;
    for (int j = 0; j < count; ++j) {
      if ((mask >> j & 1U) == 0U) {
        EXPECT_EQ(weights[j], 0);
        continue;
      }
      EXPECT_NEAR(weights[j] / static_cast<double>(sum), std::exp(real_unit * (scores[j] - largest)) / total,
                  0.004);
      ASSERT_TRUE(scores[j] != largest || weights[j] == 32767);
    }
  }
}

// SATP-024 Against real arithmetic on values from 1 to 60000 in size: one unit of the output at most.
TEST(LayerNorm, FollowsTheRealOne) {
  test::Random random(23);
  constexpr int kWidth = kMcuShape.width;
  for (int round = 0; round < 2000; ++round) {
    std::int32_t bias[kWidth];
    std::int32_t gain[kWidth];
    std::int32_t values[kWidth];
    const int size = 1 << random.integer(1, 16);
    const int offset = random.integer(-20000, 20000);
    double mean = 0.0;
    double variance = 0.0;
    for (int c = 0; c < kWidth; ++c) {
      bias[c] = random.integer(-20 << 20, 20 << 20);
      gain[c] = random.integer(-12000, 12000);
      values[c] = random.integer(-size, size) + offset;
      mean += values[c] / static_cast<double>(kWidth);
    }
    for (const std::int32_t value : values) variance += (value - mean) * (value - mean) / kWidth;
    std::int8_t outputs[kWidth];
    std::int32_t used_up[kWidth];
    std::copy(std::begin(values), std::end(values), used_up);
    layer_norm({bias, gain}, used_up, outputs);
    for (int c = 0; c < kWidth; ++c) {
      const double normalized = variance > 0.0 ? (values[c] - mean) / std::sqrt(variance) : 0.0;
      const double real = normalized * gain[c] / 256.0 + bias[c] / 1048576.0;
      ASSERT_NEAR(outputs[c], std::clamp(real, -128.0, 127.0), 0.6) << "size " << size;
    }
  }
}

// SATP-024 Equal values have no deviation to divide by: what is left is the bias, 5.
TEST(LayerNorm, EqualValuesGiveTheBias) {
  constexpr int kWidth = kMcuShape.width;
  const std::vector<std::int32_t> bias(kWidth, 5 << 20);
  const std::vector<std::int32_t> gain(kWidth, 9000);
  std::vector<std::int32_t> values(kWidth, 777);
  std::int8_t outputs[kWidth];
  layer_norm({bias.data(), gain.data()}, values.data(), outputs);
  for (const std::int8_t output : outputs) EXPECT_EQ(output, 5);
  for (const std::uint32_t x : {0U, 1U, 3U, 4U, 99U, 0x7FFFFFFFU, 0xFFFFFFFFU})
    EXPECT_EQ(integer_sqrt(x), static_cast<std::uint32_t>(std::sqrt(static_cast<double>(x)))) << x;
}

// SATP-025 What a masked key holds changes no bit; with none left the answer does not depend on any.
TEST(Attention, MaskedKeysDoNotCount) {
  const RandomNetwork network;
  const Attention block = attention_at(network.weights, kAgent1);
  constexpr int kWidth = kMcuShape.width;
  test::Random random(29);
  alignas(4) std::int8_t query[kWidth];
  alignas(4) std::int8_t keys[6][kWidth];
  alignas(4) std::int8_t values[6][kWidth];
  AttentionScratch scratch;
  const auto fill = [&random](std::int8_t* row) {
    for (int c = 0; c < kWidth; ++c) row[c] = static_cast<std::int8_t>(random.integer(-127, 127));
  };
  const auto answer = [&](std::uint32_t mask) {
    std::vector<std::int8_t> output(kWidth);
    attend(block, {query, kWidth}, 1, {keys[0], kWidth}, {values[0], kWidth}, 6, mask, scratch,
           {output.data(), kWidth});
    return output;
  };
  fill(query);
  for (auto& key : keys) fill(key);
  for (auto& value : values) fill(value);
  const auto some = answer(0x2D);
  const auto none = answer(0);
  EXPECT_NE(some, answer(0x3F));
  for (const int masked : {1, 4}) {
    fill(keys[masked]);
    fill(values[masked]);
  }
  EXPECT_EQ(some, answer(0x2D));
  fill(keys[0]);
  fill(values[2]);
  EXPECT_NE(some, answer(0x2D));
  EXPECT_EQ(none, answer(0));
}

// SATP-026 Thirty steps from random states with random inputs.
TEST(GruCell, StatesStayInRange) {
  const RandomNetwork network;
  const GruCell cell = gru_at(network.weights);
  test::Random random(31);
  alignas(4) std::int8_t inputs[kMaxBatch][kGruInput] = {};
  std::int16_t states[kMaxBatch][kHidden];
  GruScratch scratch;
  int most = 0;
  for (auto& state : states) {
    for (std::int16_t& value : state)
      value = random.integer(0, 1) == 0 ? std::int16_t{32767} : std::int16_t{-32767};
  }
  for (int step = 0; step < 30; ++step) {
    for (auto& input : inputs) {
      for (int c = 0; c < kEmbed; ++c) input[c] = static_cast<std::int8_t>(random.integer(-127, 127));
    }
    gru_step(cell, inputs, kMaxBatch, scratch, states);
    for (const auto& state : states) {
      for (const std::int16_t value : state) {
        ASSERT_GE(value, -32767);
        most = std::max(most, std::abs(static_cast<int>(value)));
      }
    }
  }
  EXPECT_GT(most, 20000);
}

}  // namespace
}  // namespace s4tp::satp
