#pragma once
/// Deterministic mathematics: the same bits on x86-64, Cortex-M7, M55, R52 and aarch64 (CORE-010).
/// Only + - * / and sqrt of IEEE-754 binary32, in a fixed order; no library call, no fused multiply-add.
/// Error bounds, in units of the last place or absolute, hold over the whole stated range and are tested
/// against the C library's double result (CORE-011).

#include <cstdint>

namespace s4tp {

inline constexpr float kPi = 3.14159265358979F;
inline constexpr float kTwoPi = 6.28318530717959F;

struct SinCos {
  float sin;
  float cos;
};

[[nodiscard]] float sqrt(float x);         ///< correctly rounded; x < 0 gives 0
[[nodiscard]] float exp(float x);          ///< any finite x; 1.1 ulp; 0 below -87.3, largest float above 88.7
[[nodiscard]] float erf(float x);          ///< any finite x; 6e-7, and 1.5 ulp while |x| < 0.9
[[nodiscard]] float sin(float angle_rad);  ///< |angle| <= 1e4; 1e-7, and 2 ulp while |angle| <= 3
[[nodiscard]] float cos(float angle_rad);  ///< |angle| <= 1e4; 1e-7
[[nodiscard]] SinCos sin_cos(float angle_rad);  ///< both, for little more than the price of one
[[nodiscard]] float tan(float angle_rad);       ///< |angle| <= 1.5; 4 ulp
[[nodiscard]] float atan(float x);              ///< any finite x; 3 ulp
[[nodiscard]] float atan2(float y, float x);    ///< any finite pair; 5e-7; (0, 0) gives 0; [-pi, pi]
[[nodiscard]] float tanh(float x);              ///< any finite x; 1.5 ulp
[[nodiscard]] float floor(float x);             ///< |x| < 2^31
[[nodiscard]] float abs(float x);
[[nodiscard]] float min(float a, float b);
[[nodiscard]] float max(float a, float b);
[[nodiscard]] float clamp(float x, float low, float high);  ///< \pre low <= high
[[nodiscard]] float square(float x);
[[nodiscard]] float lerp(float a, float b, float t);                ///< a + (b - a) t
[[nodiscard]] float wrap_angle(float angle_rad);                    ///< to [-pi, pi); |angle| <= 1e4
[[nodiscard]] float lerp_angle(float a_rad, float b_rad, float t);  ///< along the shorter way, wrapped

[[nodiscard]] bool is_finite(float x);
/// Nearest integer (ties to even), clamped to [low, high]: the only way from float to integer in the core.
[[nodiscard]] std::int32_t to_int(float x, std::int32_t low, std::int32_t high);

}  // namespace s4tp
