#pragma once
/// Critical gaps from what drivers accepted and rejected.

#include <limits>
#include <vector>

namespace s4tp::metrics {

/// The gaps one driver was offered until one was taken.
struct GapChoice {
  double largest_rejected_s = 0.0;                              ///< 0: took the first
  double accepted_s = std::numeric_limits<double>::infinity();  ///< infinity: nobody came any more
};

struct CriticalGap {
  double mean_s = 0.0;       ///< 0: too few drivers to say
  double deviation_s = 0.0;  ///< between drivers
  int drivers = 0;           ///< who rejected a gap before they took one
  int inconsistent = 0;      ///< left out: accepted a gap no larger than one rejected
};

/// Maximum likelihood with a log-normal distribution of critical gaps over drivers: each one's lies between
/// a driver's largest rejected and its accepted gap, L = product of F(accepted) - F(rejected).
/// Source: Troutbeck 1992, Estimating the critical acceptance gap from traffic movements; Brilon, Koenig,
/// Troutbeck 1999, Useful estimation procedures for critical gaps.
[[nodiscard]] CriticalGap critical_gap(const std::vector<GapChoice>& choices);

}  // namespace s4tp::metrics
