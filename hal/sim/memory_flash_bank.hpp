#pragma once
/// A flash bank in memory that behaves like one: erased to 0xFF, writing only clears bits.

#include <cstdint>

#include "hal/flash_bank.hpp"

namespace s4tp::hal::sim {

class MemoryFlashBank final : public FlashBank {
 public:
  static constexpr std::uint32_t kSize = 192U * 1024U;

  MemoryFlashBank();
  [[nodiscard]] std::uint32_t size() const override { return kSize; }
  [[nodiscard]] const void* mapped() const override { return bytes_; }
  /// HAL-030 Reading and writing beyond the end change nothing and answer false.
  [[nodiscard]] bool read(std::uint32_t offset, void* destination, std::uint32_t size) const override;
  [[nodiscard]] bool erase() override;
  /// HAL-031 As on the device, a bit once written to 0 stays 0 until erased; false when data would need it.
  [[nodiscard]] bool write(std::uint32_t offset, const void* source, std::uint32_t size) override;

 private:
  alignas(4) std::uint8_t bytes_[kSize];
};

}  // namespace s4tp::hal::sim
