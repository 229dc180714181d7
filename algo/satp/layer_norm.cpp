#include "algo/satp/layer_norm.hpp"

#include "algo/satp/requantize.hpp"

namespace s4tp::satp {
namespace {

constexpr int kWidth = kMcuShape.width;
constexpr int kNormBits = 12;    // of the normalized value
constexpr int kOutputBits = 20;  // gain 2^8, normalized value 2^12

// sqrt(kWidth) * 2^28, for the compiler only.
constexpr std::uint32_t root_of_width() {
  constexpr double kScale = 268435456.0;
  constexpr double kHalf = 0.5;
  double root = kWidth;
  for (int i = 0; i < 40; ++i) root = 0.5 * (root + kWidth / root);
  return static_cast<std::uint32_t>(root * kScale + kHalf);
}

constexpr std::uint32_t kRootOfWidth = root_of_width();
static_assert(kWidth <= 60, "its root times 2^28 fits 31 bits, and normalized values 16");

}  // namespace

std::uint32_t integer_sqrt(std::uint32_t x) {
  std::uint32_t root = 0;
  std::uint32_t rest = x;
  for (std::uint32_t bit = 1U << 30U; bit != 0U; bit >>= 2U) {
    if (rest >= root + bit) {
      rest -= root + bit;
      root = (root >> 1U) + bit;
    } else {
      root >>= 1U;
    }
  }
  return root;
}

void layer_norm(const Norm& norm, const std::int32_t* values, std::int8_t* outputs) {
  std::int32_t sum = 0;
  for (int j = 0; j < kWidth; ++j) sum += values[j];
  std::int32_t centred[kWidth];  // kWidth times the distance from the mean
  std::uint64_t squares = 0;
  for (int j = 0; j < kWidth; ++j) {
    centred[j] = kWidth * values[j] - sum;
    squares += static_cast<std::uint64_t>(static_cast<std::int64_t>(centred[j]) * centred[j]);
  }
  // The square root of `squares` = root * 2^exponent, with 16 significant bits.
  int exponent = 0;
  std::uint64_t scaled = squares;
  for (int i = 0; i < 16 && (scaled >> 32U) != 0U; ++i) {
    scaled >>= 2U;
    ++exponent;
  }
  for (int i = 0; i < 16 && scaled != 0U && (scaled >> 30U) == 0U; ++i) {
    scaled <<= 2U;
    --exponent;
  }
  const std::uint32_t root = integer_sqrt(static_cast<std::uint32_t>(scaled));
  const std::int32_t factor = root == 0U ? 0 : static_cast<std::int32_t>(kRootOfWidth / root);
  const int shift = 28 - kNormBits + exponent;
  const std::int64_t half = std::int64_t{1} << (shift - 1);
  for (int j = 0; j < kWidth; ++j) {
    const auto normalized =
        static_cast<std::int32_t>((static_cast<std::int64_t>(centred[j]) * factor + half) >> shift);
    const std::int32_t scaled_up = normalized * norm.gain[j];
    // Gain and bias are bounded, their sum with a half is not: in 64 bits.
    const std::int64_t output =
        static_cast<std::int64_t>(scaled_up) + norm.bias[j] + (1 << (kOutputBits - 1));
    outputs[j] = static_cast<std::int8_t>(saturate8(static_cast<std::int32_t>(output >> kOutputBits)));
  }
}

}  // namespace s4tp::satp
