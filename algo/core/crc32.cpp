#include "algo/core/crc32.hpp"

namespace s4tp {

std::uint32_t crc32_byte(std::uint32_t crc, std::uint32_t byte) {
  crc ^= byte & 0xFFU;
  for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0U ? 0xEDB88320U : 0U);
  return crc;
}

std::uint32_t crc32(const void* data, std::uint32_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint32_t crc = kCrc32Start;
  for (std::uint32_t i = 0; i < size; ++i) crc = crc32_byte(crc, bytes[i]);
  return crc ^ 0xFFFFFFFFU;
}

}  // namespace s4tp
