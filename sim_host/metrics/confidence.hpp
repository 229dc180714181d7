#pragma once
/// The one level at which results are told.

namespace s4tp::metrics {

inline constexpr double kZ = 1.959963984540054;  ///< standard normal quantile: two-sided 95 %

}  // namespace s4tp::metrics
