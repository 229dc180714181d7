#pragma once
/// The VERSION frames: a mismatch of wire version or layout hash keeps the ECU in standby (WIRE-050).

#include <cstdint>

namespace s4tp::wire {

/// VERSION of the DBC, and FNV-1a over every message and signal layout; both made by the generator.
[[nodiscard]] std::uint8_t wire_version();
[[nodiscard]] std::uint32_t layout_hash();

}  // namespace s4tp::wire
