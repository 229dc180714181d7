#include "algo/satp/layer_norm.hpp"

#include "algo/satp/lanes.hpp"

namespace s4tp::satp {
namespace {

constexpr int kWidth = kMcuShape.width;
constexpr int kNormBits = 12;  // of the normalized value

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

void layer_norm(const Norm& norm, std::int32_t* values, std::int8_t* outputs) {
  const std::uint64_t squares = lanes::centre(values, kWidth);
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
  // Normalized values are values * factor / 2^shift, to nearest; shift is 1 .. 26. As they are below 2^15, both
  // can be shifted up until the division is one by 2^32.
  const int shift = 28 - kNormBits + exponent;
  const int of_factor = shift < 17 ? 15 : 32 - shift;
  lanes::scale(values, 32 - shift - of_factor, factor << of_factor, norm.gain, norm.bias, kWidth, outputs);
}

}  // namespace s4tp::satp
