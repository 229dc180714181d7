#pragma once
/// A bank of non-volatile memory: parameters and weights, two banks each, so that a broken write loses
/// nothing.

#include <cstdint>

namespace s4tp::hal {

class FlashBank {
 public:
  [[nodiscard]] virtual std::uint32_t size() const = 0;
  /// Where it can be read in place, aligned to 4 bytes; null: by read() only.
  [[nodiscard]] virtual const void* mapped() const = 0;
  [[nodiscard]] virtual bool read(std::uint32_t offset, void* destination, std::uint32_t size) const = 0;
  [[nodiscard]] virtual bool erase() = 0;
  [[nodiscard]] virtual bool write(std::uint32_t offset, const void* source, std::uint32_t size) = 0;

 protected:
  ~FlashBank() = default;
};

}  // namespace s4tp::hal
