#pragma once
/// The generated codec: one struct a message of s4tp.dbc, in the CamelCase of the DBC, with its signals as
/// fields
/// (`crc` and `counter` left out where e2e.hpp supplies them), and for each
///
///     inline constexpr std::uint32_t kMotionId = 0x010;
///     struct Motion { std::uint16_t vehicle_time_ms; float speed_mps; ... };
///     [[nodiscard]] bool encode(const Motion& message, Frame& frame);   // false: a value outside [min, max]
///     or NaN
///     [[nodiscard]] bool decode(const Frame& frame, Motion& message);   // false: id, length or range wrong
///
/// Scaled signals are float (rounded to nearest on encoding, ties away from zero), unscaled ones integers of
/// their width. A failed call leaves its output untouched. WIRE-002 encode, WIRE-003 decode. `crc` and
/// `counter` are written as zero: e2e.hpp fills them in afterwards.

#include "firmware/wire/generated/s4tp_codec.hpp"  // IWYU pragma: export
