#include "algo/core/crc32.hpp"

namespace s4tp {
namespace {

/// Remainders of the 16 nibbles, polynomial 0xEDB88320: sixteen times as small as those of the bytes, and twice as slow.
constexpr std::uint32_t kRemainders[16] = {
    0x00000000U, 0x1DB71064U, 0x3B6E20C8U, 0x26D930ACU, 0x76DC4190U, 0x6B6B51F4U, 0x4DB26158U, 0x5005713CU,
    0xEDB88320U, 0xF00F9344U, 0xD6D6A3E8U, 0xCB61B38CU, 0x9B64C2B0U, 0x86D3D2D4U, 0xA00AE278U, 0xBDBDF21CU};

}  // namespace

std::uint32_t crc32_byte(std::uint32_t crc, std::uint32_t byte) {
  crc = (crc >> 4U) ^ kRemainders[(crc ^ byte) & 0xFU];
  return (crc >> 4U) ^ kRemainders[(crc ^ (byte >> 4U)) & 0xFU];
}

std::uint32_t crc32_word(std::uint32_t crc, std::uint32_t word) {
  for (unsigned shift = 0; shift < 32U; shift += 8U) crc = crc32_byte(crc, word >> shift);
  return crc;
}

std::uint32_t crc32(const void* data, std::uint32_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint32_t crc = kCrc32Start;
  for (std::uint32_t i = 0; i < size; ++i) crc = crc32_byte(crc, bytes[i]);
  return crc ^ 0xFFFFFFFFU;
}

}  // namespace s4tp
