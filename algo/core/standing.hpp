#pragma once
/// The one speed below which a vehicle counts as standing, whoever asks.

namespace s4tp {

inline constexpr float kStandingMps = 0.3F;  ///< all that a standing vehicle's measured speed may be

}  // namespace s4tp
