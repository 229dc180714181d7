#pragma once
/// CRC-32 (IEEE 802.3, reflected): of parameters, weights, plans and recorded drives.

#include <cstdint>

namespace s4tp {

inline constexpr std::uint32_t kCrc32Start = 0xFFFFFFFFU;

/// `crc` after the low 8 bits of `byte`; the first call takes kCrc32Start, the result is inverted at the end.
[[nodiscard]] std::uint32_t crc32_byte(std::uint32_t crc, std::uint32_t byte);

/// The same after the four bytes of `word`, lowest first.
[[nodiscard]] std::uint32_t crc32_word(std::uint32_t crc, std::uint32_t word);

/// Of `size` bytes, whole: start and inversion included. \param data  may be null when size is 0
[[nodiscard]] std::uint32_t crc32(const void* data, std::uint32_t size);

}  // namespace s4tp
