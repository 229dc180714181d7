#include "algo/core/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace s4tp {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

/// The worst errors found over a range.
struct Error {
  double absolute = 0.0;
  double ulp = 0.0;  ///< in units of the right result's last place, where that is a normal float
  float worst_at = 0.0F;
};

/// Every 997th float bit pattern in [low, high], and 300,000 uniformly drawn values.
template <typename Ours, typename Right>
Error sweep(Ours ours, Right right, float low, float high) {
  Error error;
  const auto look = [&](float x) {
    const double expected = right(static_cast<double>(x));
    const double off = std::fabs(static_cast<double>(ours(x)) - expected);
    error.absolute = std::max(error.absolute, off);
    const float magnitude = static_cast<float>(std::fabs(expected));
    if (magnitude < std::numeric_limits<float>::min()) return;
    const double spacing = std::ldexp(1.0, std::ilogb(magnitude) - 23);
    if (off / spacing > error.ulp) {
      error.ulp = off / spacing;
      error.worst_at = x;
    }
  };
  for (std::uint64_t pattern = 0; pattern < (std::uint64_t{1} << 32); pattern += 997) {
    const float x = std::bit_cast<float>(static_cast<std::uint32_t>(pattern));
    if (x >= low && x <= high) look(x);
  }
  std::mt19937 random(20200917);
  std::uniform_real_distribution<float> uniform(std::max(low, -1e5F), std::min(high, 1e5F));
  for (int i = 0; i < 300000; ++i) look(uniform(random));
  return error;
}

#define EXPECT_WITHIN_ULP(function, low, high, bound)                                \
  do {                                                                               \
    const Error found = sweep([](float x) { return s4tp::function(x); },             \
                              [](double x) { return std::function(x); }, low, high); \
    EXPECT_LE(found.ulp, bound) << "worst at " << found.worst_at;                    \
  } while (false)

}  // namespace

// CORE-011: the square root is the correctly rounded one; below zero it is 0.
TEST(Math, SqrtIsCorrectlyRounded) {
  EXPECT_WITHIN_ULP(sqrt, 0.0F, kLargest, 0.5);
  EXPECT_EQ(s4tp::sqrt(-1.0F), 0.0F);
}

// CORE-011: exp to 1.1 ulp from e^-87.3 = 1.2e-38 to e^88.7 = 3.3e38, which are the ends of the normal
// floats.
TEST(Math, ExpToOneUlp) {
  EXPECT_WITHIN_ULP(exp, -87.3F, 88.7F, 1.1);
}

// CORE-011: beyond both ends exp saturates and never becomes infinite.
TEST(Math, ExpSaturates) {
  EXPECT_EQ(s4tp::exp(-88.0F), 0.0F);
  EXPECT_EQ(s4tp::exp(-kLargest), 0.0F);
  EXPECT_EQ(s4tp::exp(89.0F), kLargest);
  EXPECT_EQ(s4tp::exp(kLargest), kLargest);
}

// CORE-011: erf to 6e-7 absolute over all finite floats, and to 1.5 ulp while |x| < 0.9.
TEST(Math, ErfToSixInTenMillion) {
  const Error error =
      sweep([](float x) { return s4tp::erf(x); }, [](double x) { return std::erf(x); }, -kLargest, kLargest);
  EXPECT_LE(error.absolute, 6e-7);
  const Error middle =
      sweep([](float x) { return s4tp::erf(x); }, [](double x) { return std::erf(x); }, -5.0F, 5.0F);
  EXPECT_LE(middle.absolute, 6e-7);
  EXPECT_WITHIN_ULP(erf, -0.9F, 0.9F, 1.5);
}

// CORE-011: sine and cosine to 1e-7 absolute up to 1e4 rad. Near their zeros the error in ulp is larger: the
// angle itself is known to 5e-4 of a radian only out there.
TEST(Math, SineAndCosineToOneInTenMillion) {
  const auto sine =
      sweep([](float x) { return s4tp::sin(x); }, [](double x) { return std::sin(x); }, -1e4F, 1e4F);
  const auto cosine =
      sweep([](float x) { return s4tp::cos(x); }, [](double x) { return std::cos(x); }, -1e4F, 1e4F);
  EXPECT_LE(sine.absolute, 1e-7);
  EXPECT_LE(cosine.absolute, 1e-7);
}

// CORE-011: within one turn sine is good to 2 ulp, so that small angles keep their relative accuracy.
TEST(Math, SineOfSmallAnglesToTwoUlp) {
  EXPECT_WITHIN_ULP(sin, -3.0F, 3.0F, 2.0);
}

// CORE-011: the pair is the same as its halves, bit for bit.
TEST(Math, SinCosIsSinAndCos) {
  for (float angle = -20.0F; angle < 20.0F; angle += 0.037F) {
    EXPECT_EQ(s4tp::sin_cos(angle).sin, s4tp::sin(angle));
    EXPECT_EQ(s4tp::sin_cos(angle).cos, s4tp::cos(angle));
  }
}

// CORE-011: tangent to 4 ulp up to 1.5 rad.
TEST(Math, TanToFourUlp) {
  EXPECT_WITHIN_ULP(tan, -1.5F, 1.5F, 4.0);
}

// CORE-011: arc tangent to 3 ulp over all finite floats.
TEST(Math, AtanToThreeUlp) {
  EXPECT_WITHIN_ULP(atan, -kLargest, kLargest, 3.0);
}

// CORE-011: tanh to 1.5 ulp over all finite floats.
TEST(Math, TanhToOneAndAHalfUlp) {
  EXPECT_WITHIN_ULP(tanh, -kLargest, kLargest, 1.5);
}

// CORE-011: atan2 to 5e-7 absolute in all quadrants, for magnitudes from 1e-30 to 1e30; at the origin 0.
TEST(Math, Atan2InAllQuadrants) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> mantissa(-1.0F, 1.0F);
  std::uniform_real_distribution<float> decade(-30.0F, 30.0F);
  for (int i = 0; i < 300000; ++i) {
    const float scale = std::pow(10.0F, decade(random));
    const float y = mantissa(random) * scale;
    const float x = mantissa(random) * scale;
    ASSERT_NEAR(s4tp::atan2(y, x), std::atan2(static_cast<double>(y), static_cast<double>(x)), 5e-7)
        << y << " " << x;
  }
  EXPECT_EQ(s4tp::atan2(0.0F, 0.0F), 0.0F);
  EXPECT_EQ(s4tp::atan2(0.0F, -1.0F), kPi);
  EXPECT_EQ(s4tp::atan2(1.0F, 0.0F), 0.5F * kPi);
}

// CORE-011: wrapped angles lie in [-pi, pi) and differ from the angle by whole turns, to 1e-6 rad.
TEST(Math, WrapAngleKeepsTheDirection) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> angle(-1e4F, 1e4F);
  for (int i = 0; i < 300000; ++i) {
    const float x = angle(random);
    const float wrapped = wrap_angle(x);
    ASSERT_GE(wrapped, -kPi);
    ASSERT_LT(wrapped, kPi);
    const double turns = (static_cast<double>(x) - wrapped) / (2.0 * M_PI);
    ASSERT_NEAR(turns, std::round(turns), 2e-7) << x;
  }
  EXPECT_EQ(wrap_angle(kPi), -kPi);
  EXPECT_EQ(wrap_angle(-kPi), -kPi);
  EXPECT_EQ(wrap_angle(1.25F), 1.25F);
}

// CORE-011: from 170 to -170 degrees the shorter way leads over 180: half of it is 180 degrees, written -pi.
TEST(Math, LerpAngleTakesTheShorterWay) {
  const float degree = kPi / 180.0F;
  EXPECT_NEAR(std::fabs(lerp_angle(170.0F * degree, -170.0F * degree, 0.5F)), kPi, 1e-6F);
  EXPECT_NEAR(lerp_angle(0.2F, 0.4F, 0.25F), 0.25F, 1e-7F);
}

// CORE-011: floor as the C library's, also for whole and negative numbers.
TEST(Math, FloorAsTheLibrary) {
  const Error error =
      sweep([](float x) { return s4tp::floor(x); }, [](double x) { return std::floor(x); }, -2.1e9F, 2.1e9F);
  EXPECT_EQ(error.absolute, 0.0);
}

// CORE-011: halves go to the even neighbour; what does not fit, and what is no number, is clamped.
TEST(Math, ToIntRoundsToEvenAndClamps) {
  constexpr std::int32_t kLow = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t kHigh = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(to_int(0.5F, kLow, kHigh), 0);
  EXPECT_EQ(to_int(1.5F, kLow, kHigh), 2);
  EXPECT_EQ(to_int(-2.5F, kLow, kHigh), -2);
  EXPECT_EQ(to_int(8388607.5F, kLow, kHigh), 8388608);
  EXPECT_EQ(to_int(1e30F, kLow, kHigh), kHigh);
  EXPECT_EQ(to_int(-1e30F, kLow, kHigh), kLow);
  EXPECT_EQ(to_int(300.0F, 0, 255), 255);
  EXPECT_EQ(to_int(-1.0F, 0, 255), 0);
  EXPECT_EQ(to_int(std::numeric_limits<float>::quiet_NaN(), 3, 9), 3);
}

// CORE-011: infinities and not-a-numbers are told from finite values.
TEST(Math, IsFinite) {
  EXPECT_TRUE(is_finite(kLargest));
  EXPECT_TRUE(is_finite(-0.0F));
  EXPECT_FALSE(is_finite(std::numeric_limits<float>::infinity()));
  EXPECT_FALSE(is_finite(std::numeric_limits<float>::quiet_NaN()));
}

}  // namespace s4tp
