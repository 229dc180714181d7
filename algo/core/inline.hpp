#pragma once
/// Bodies of the smallest functions of math.hpp and geometry.hpp, for the core's own .cpp files: a call costs
/// several times what they do. Internal: not for an installed header, because whoever includes that may
/// compile floating point with other flags. gnu_inline: never emitted from here but only by math.cpp, which
/// sets S4TP_INLINE to nothing.

#include <cstring>

#include "algo/core/geometry.hpp"
#include "algo/core/math.hpp"

#ifndef S4TP_INLINE
#define S4TP_INLINE [[gnu::gnu_inline]] extern inline
#endif

namespace s4tp {
// NOLINTBEGIN(misc-definitions-in-headers): math.cpp alone emits them

S4TP_INLINE float sqrt(float x) {
  return x > 0.0F ? __builtin_sqrtf(x) : 0.0F;
}
S4TP_INLINE float abs(float x) {
  return __builtin_fabsf(x);
}
S4TP_INLINE float min(float a, float b) {
  return b < a ? b : a;
}
S4TP_INLINE float max(float a, float b) {
  return a < b ? b : a;
}
S4TP_INLINE float clamp(float x, float low, float high) {
  return x < low ? low : (x > high ? high : x);
}
S4TP_INLINE float square(float x) {
  return x * x;
}
S4TP_INLINE float lerp(float a, float b, float t) {
  return a + (b - a) * t;
}

S4TP_INLINE bool is_finite(float x) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  return (bits & 0x7F800000U) != 0x7F800000U;
}
S4TP_INLINE std::int32_t to_int(float x, std::int32_t low, std::int32_t high) {
  constexpr float kBeyond = 2147483648.0F;
  if (!(x > -kBeyond)) return low;  // not a number as well
  if (x >= kBeyond) return high;
  constexpr float kNoHalves = 8388608.0F;
  float whole = x;
  if (abs(x) < kNoHalves) {
    const float rounded = (abs(x) + kNoHalves) - kNoHalves;
    whole = x < 0.0F ? -rounded : rounded;
  }
  const std::int32_t value = static_cast<std::int32_t>(whole);
  return value < low ? low : (value > high ? high : value);
}

S4TP_INLINE Point operator+(Point a, Point b) {
  return {a.x_m + b.x_m, a.y_m + b.y_m};
}
S4TP_INLINE Point operator-(Point a, Point b) {
  return {a.x_m - b.x_m, a.y_m - b.y_m};
}
S4TP_INLINE Point operator*(float k, Point a) {
  return {k * a.x_m, k * a.y_m};
}
S4TP_INLINE float dot(Point a, Point b) {
  return a.x_m * b.x_m + a.y_m * b.y_m;
}
S4TP_INLINE float cross(Point a, Point b) {
  return a.x_m * b.y_m - a.y_m * b.x_m;
}
S4TP_INLINE float norm(Point a) {
  return sqrt(dot(a, a));
}
S4TP_INLINE float distance(Point a, Point b) {
  return norm(a - b);
}
S4TP_INLINE Point position(const Pose& pose) {
  return {pose.x_m, pose.y_m};
}
// NOLINTEND(misc-definitions-in-headers)

}  // namespace s4tp
