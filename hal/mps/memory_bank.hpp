#pragma once
/// A flash bank that the processor reads in place, as the boards of QEMU have it: it is filled from outside, like a
/// flasher does, before the image starts. There is no flash controller, so nothing erases or writes it.

#include <cstdint>
#include <cstring>

#include "hal/flash_bank.hpp"

namespace s4tp::hal::mps {

class MemoryBank final : public FlashBank {
 public:
  /// \param begin  aligned to 4 bytes \param end  behind its last byte
  MemoryBank(const std::uint8_t* begin, const std::uint8_t* end)
      : begin_(begin), size_(static_cast<std::uint32_t>(end - begin)) {}

  [[nodiscard]] std::uint32_t size() const override { return size_; }
  [[nodiscard]] const void* mapped() const override { return begin_; }
  [[nodiscard]] bool read(std::uint32_t offset, void* destination, std::uint32_t size) const override {
    if (offset > size_ || size > size_ - offset) return false;
    std::memcpy(destination, begin_ + offset, size);
    return true;
  }
  [[nodiscard]] bool erase() override { return false; }
  [[nodiscard]] bool write(std::uint32_t, const void*, std::uint32_t) override { return false; }

 private:
  const std::uint8_t* begin_;
  std::uint32_t size_;
};

}  // namespace s4tp::hal::mps
