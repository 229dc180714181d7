#pragma once
/// Monotonic local time, for ages and time-outs on a real target. In lock-step it follows vehicle time.

#include <cstdint>

namespace s4tp::hal {

class Clock {
 public:
  [[nodiscard]] virtual std::uint64_t now_us() const = 0;

 protected:
  ~Clock() = default;
};

}  // namespace s4tp::hal
