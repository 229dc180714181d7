#define S4TP_INLINE  // the bodies in inline.hpp are emitted here
#include <cstring>

#include "algo/core/inline.hpp"

namespace s4tp {
namespace {

// Unless said otherwise polynomials interpolate the function at the Chebyshev nodes of the reduced range; the
// remainder of each is below 2e-8 relative, so that rounding sets the error. Split constants have so few bits
// in their leading parts that the product with the (small) integer is exact.

float from_bits(std::uint32_t bits) {
  float x = 0.0F;
  std::memcpy(&x, &bits, sizeof(x));
  return x;
}

/// Polynomial in x, highest power first.
template <typename... Coefficients>
float horner(float x, float highest, Coefficients... rest) {
  float value = highest;
  ((value = value * x + rest), ...);
  return value;
}

/// To the nearest integer, ties to even, while |x| < 2^22: adding 1.5 * 2^23 leaves no room for a fraction.
float round_to_even(float x) {
  constexpr float kNoFraction = 12582912.0F;
  return (x + kNoFraction) - kNoFraction;
}

/// An angle as quarter turns and a rest within +-pi/4.
struct Reduced {
  std::int32_t quarter;
  float rest_rad;
};

Reduced reduce(float angle_rad) {
  constexpr float kQuarterHigh = 1.5703125F;
  constexpr float kQuarterMiddle = 0.0004837512969970703125F;
  constexpr float kQuarterLow = 7.549790126404332e-08F;
  const float n = round_to_even(angle_rad * 0.636619772F);
  const float rest = ((angle_rad - n * kQuarterHigh) - n * kQuarterMiddle) - n * kQuarterLow;
  return {static_cast<std::int32_t>(n), rest};
}

float sin_of_rest(float r) {
  const float z = r * r;
  const float p = horner(z, 2.724378191e-06F, -1.984003902e-04F, 8.333331905e-03F, -0.1666666716F);
  return r + r * (z * p);
}

float cos_of_rest(float r) {
  const float z = r * r;
  const float p = horner(z, 2.454287096e-05F, -1.388827921e-03F, 4.166666418e-02F);
  return (1.0F - 0.5F * z) + (z * z) * p;
}

}  // namespace

float exp(float x) {
  if (x < -87.3F) return 0.0F;
  if (x > 88.7F) return 3.402823466e+38F;
  constexpr float kLn2High = 0.693145751953125F;
  constexpr float kLn2Low = 1.428606765e-06F;
  const float n = round_to_even(x * 1.442695041F);
  const float r = (x - n * kLn2High) - n * kLn2Low;
  const float p = horner(r, 1.392692677e-03F, 8.363774046e-03F, 4.166654870e-02F, 0.1666657329F, 0.5F);
  const float value = 1.0F + (r + (r * r) * p);
  const std::int32_t exponent = static_cast<std::int32_t>(n);
  // 2^128 is no float: the last doubling is done apart.
  if (exponent > 127) return (value * from_bits(254U << 23)) * 2.0F;
  return value * from_bits(static_cast<std::uint32_t>(exponent + 127) << 23);
}

float erf(float x) {
  const float t = abs(x);
  if (t < 0.92F) {
    const float z = x * x;
    const float p = horner(z, -6.003722082e-04F, 4.995951429e-03F, -2.676871046e-02F, 0.1128188074F,
                           -0.3761250079F, 0.1283791512F);
    return x + x * p;
  }
  float value = 1.0F;
  if (t < 4.0F) {
    // erfc(t)^(-1/16) is smooth: a minimax polynomial on [0.92, 4], error of erf 1.4e-7.
    const float root = horner(t, 7.384315250e-04F, -1.785547589e-03F, 1.338398736e-02F, 3.758446872e-02F,
                              7.327623665e-02F, 9.993495941e-01F);
    const float second = root * root;
    const float fourth = second * second;
    const float eighth = fourth * fourth;
    value = 1.0F - 1.0F / (eighth * eighth);
  }
  return x < 0.0F ? -value : value;
}

SinCos sin_cos(float angle_rad) {
  const Reduced angle = reduce(angle_rad);
  const float sine = sin_of_rest(angle.rest_rad);
  const float cosine = cos_of_rest(angle.rest_rad);
  switch (static_cast<std::uint32_t>(angle.quarter) & 3U) {
    case 0U:
      return {sine, cosine};
    case 1U:
      return {cosine, -sine};
    case 2U:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

float sin(float angle_rad) {
  return sin_cos(angle_rad).sin;
}

float cos(float angle_rad) {
  return sin_cos(angle_rad).cos;
}

float tan(float angle_rad) {
  const SinCos both = sin_cos(angle_rad);
  return both.sin / both.cos;
}

float atan(float x) {
  constexpr float kTanEighth = 0.414213562F;        // tan(pi / 8)
  constexpr float kTanThreeEighths = 2.414213562F;  // tan(3 pi / 8)
  const float t = abs(x);
  float offset = 0.0F;
  float r = t;
  if (t > kTanThreeEighths) {
    offset = 0.5F * kPi;
    r = -1.0F / t;
  } else if (t > kTanEighth) {
    offset = 0.25F * kPi;
    r = (t - 1.0F) / (t + 1.0F);
  }
  const float z = r * r;
  const float p = horner(z, -6.431038678e-02F, 0.1073739678F, -0.1426336617F, 0.1999952346F, -0.3333333135F);
  const float value = offset + (r + r * (z * p));
  return x < 0.0F ? -value : value;
}

float atan2(float y, float x) {
  const float ax = abs(x);
  const float ay = abs(y);
  if (ax == 0.0F && ay == 0.0F) return 0.0F;
  float value = ax >= ay ? atan(ay / ax) : 0.5F * kPi - atan(ax / ay);
  if (x < 0.0F) value = kPi - value;
  return y < 0.0F ? -value : value;
}

float tanh(float x) {
  const float t = abs(x);
  if (t < 0.625F) {
    const float z = x * x;
    const float p =
        horner(z, -6.096714176e-03F, 2.099717967e-02F, -5.385090783e-02F, 0.1333276927F, -0.3333332837F);
    return x + x * (z * p);
  }
  const float value = t < 10.0F ? 1.0F - 2.0F / (exp(2.0F * t) + 1.0F) : 1.0F;
  return x < 0.0F ? -value : value;
}

float floor(float x) {
  if (abs(x) >= 8388608.0F) return x;
  const float truncated = static_cast<float>(static_cast<std::int32_t>(x));
  return truncated > x ? truncated - 1.0F : truncated;
}

float wrap_angle(float angle_rad) {
  constexpr float kTurnHigh = 6.28125F;
  constexpr float kTurnMiddle = 0.00193500518798828125F;
  constexpr float kTurnLow = 3.019916050561733e-07F;
  const float n = round_to_even(angle_rad * 0.159154943F);
  const float rest = ((angle_rad - n * kTurnHigh) - n * kTurnMiddle) - n * kTurnLow;
  if (rest >= kPi) return rest - kTwoPi;
  return rest < -kPi ? rest + kTwoPi : rest;
}

float lerp_angle(float a_rad, float b_rad, float t) {
  return wrap_angle(a_rad + wrap_angle(b_rad - a_rad) * t);
}

}  // namespace s4tp
