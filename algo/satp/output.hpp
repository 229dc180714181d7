#pragma once
/// What becomes of a layer's sums. Internal: for algo/satp's own sources.

#include <cstdint>
#include <cstring>

#include "algo/satp/requantize.hpp"

namespace s4tp::satp {

/// The sums themselves.
struct Sums {
  using Type = std::int32_t;
  static constexpr bool kRescaled = false;
  static Type of(std::int32_t sum, std::int32_t /*multiplier*/) { return sum; }
};

/// Real numbers: sums times the layer's scales.
struct Real {
  using Type = float;
  static constexpr bool kRescaled = false;
  static Type of(std::int32_t sum, std::int32_t multiplier) {
    float scale = 0.0F;
    std::memcpy(&scale, &multiplier, sizeof scale);
    return scale * static_cast<float>(sum);
  }
};

/// Rescaled by the layer's multipliers, then saturated; ReLU where the name says so.
struct Signed8 {
  using Type = std::int8_t;
  static constexpr bool kRescaled = true;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate8(q)); }
};

struct Relu8 {
  using Type = std::int8_t;
  static constexpr bool kRescaled = true;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate_unsigned8(q) - 128); }
};

struct Signed16 {
  using Type = std::int16_t;
  static constexpr bool kRescaled = true;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate16(q)); }
};

struct Relu16 {
  using Type = std::int16_t;
  static constexpr bool kRescaled = true;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate16(q < 0 ? 0 : q)); }
};

}  // namespace s4tp::satp
