#pragma once
/// A free-running counter of processor cycles or instructions; wraps.

#include <cstdint>

namespace s4tp::hal {

class CycleCounter {
 public:
  [[nodiscard]] virtual std::uint32_t now() const = 0;

 protected:
  ~CycleCounter() = default;
};

}  // namespace s4tp::hal
