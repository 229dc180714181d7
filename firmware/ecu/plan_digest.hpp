#pragma once
/// One number a plan is compared by, across processors.

#include <cstdint>

#include "algo/core/trajectory.hpp"

namespace s4tp::ecu {

/// ECU-064 CRC-32 (IEEE 802.3, reflected) over kind, start and the bits of every field of every point, of
/// the fail-safe and of what was decided, in the order of their declaration, little endian; never over padding.
[[nodiscard]] std::uint32_t plan_digest(const Plan& plan);

/// Whether every number of the plan is finite.
[[nodiscard]] bool is_finite(const Plan& plan);

}  // namespace s4tp::ecu
