#include "hal/sim/memory_flash_bank.hpp"

#include <cstring>

namespace s4tp::hal::sim {
namespace {

bool inside(std::uint32_t offset, std::uint32_t size) {
  return offset <= MemoryFlashBank::kSize && size <= MemoryFlashBank::kSize - offset;
}

}  // namespace

MemoryFlashBank::MemoryFlashBank() {
  std::memset(bytes_, 0xFF, kSize);
}

bool MemoryFlashBank::read(std::uint32_t offset, void* destination, std::uint32_t size) const {
  if (!inside(offset, size)) return false;
  std::memcpy(destination, bytes_ + offset, size);
  return true;
}

bool MemoryFlashBank::erase() {
  std::memset(bytes_, 0xFF, kSize);
  return true;
}

bool MemoryFlashBank::write(std::uint32_t offset, const void* source, std::uint32_t size) {
  if (!inside(offset, size)) return false;
  const auto* data = static_cast<const std::uint8_t*>(source);
  for (std::uint32_t i = 0; i < size; ++i) {
    if ((data[i] & ~bytes_[offset + i]) != 0) return false;
  }
  std::memcpy(bytes_ + offset, data, size);
  return true;
}

}  // namespace s4tp::hal::sim
