#pragma once
/// Monotonic local time: when something arrived, when a tick is due. The application has vehicle time instead.

#include <cstdint>

namespace s4tp::hal {

class Clock {
 public:
  [[nodiscard]] virtual std::uint64_t now_us() const = 0;

 protected:
  ~Clock() = default;
};

}  // namespace s4tp::hal
