#pragma once
/// Vehicle time: 32 bits of milliseconds, which wrap after 49.7 days. Two instants are compared by what lies between them.

#include <cstdint>

namespace s4tp {

/// From `from_ms` to `to_ms`, negative where that comes first; right while less than 24.8 days lie between.
[[nodiscard]] constexpr std::int32_t elapsed_ms(std::uint32_t from_ms, std::uint32_t to_ms) {
  return static_cast<std::int32_t>(to_ms - from_ms);
}

}  // namespace s4tp
