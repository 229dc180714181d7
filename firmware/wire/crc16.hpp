#pragma once
/// CRC-16 (polynomial 0x1021, initial 0xFFFF, no final XOR): what whole lists are checked by.

#include <cstdint>

#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

inline constexpr std::uint16_t kCrc16Start = 0xFFFF;

[[nodiscard]] std::uint16_t crc16_add(std::uint16_t crc, std::uint8_t byte);

/// WIRE-004 Over id (low byte) and all bytes of a frame.
[[nodiscard]] std::uint16_t frame_check(const Frame& frame);

}  // namespace s4tp::wire
