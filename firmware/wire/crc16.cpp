#include "firmware/wire/crc16.hpp"

namespace s4tp::wire {
namespace {

/// Remainders of the 16 nibbles.
constexpr std::uint16_t kTable[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50A5, 0x60C6, 0x70E7,
                                      0x8108, 0x9129, 0xA14A, 0xB16B, 0xC18C, 0xD1AD, 0xE1CE, 0xF1EF};

std::uint16_t add_nibble(std::uint16_t crc, unsigned nibble) {
  return static_cast<std::uint16_t>((crc << 4U) ^ kTable[((crc >> 12U) ^ nibble) & 0x0FU]);
}

}  // namespace

std::uint16_t crc16_add(std::uint16_t crc, std::uint8_t byte) {
  return add_nibble(add_nibble(crc, byte >> 4U), byte & 0x0FU);
}

std::uint16_t frame_check(const Frame& frame) {
  std::uint16_t crc = crc16_add(kCrc16Start, static_cast<std::uint8_t>(frame.id & 0xFFU));
  for (const std::uint8_t byte : frame.data) crc = crc16_add(crc, byte);
  return crc;
}

}  // namespace s4tp::wire
