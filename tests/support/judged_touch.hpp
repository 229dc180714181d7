#pragma once
/// Touches of car 7 on the judged road, and what is said of them.

#include <utility>

#include "sim_host/world/judge/attribution.hpp"
#include "tests/support/judged_road.hpp"

namespace s4tp::test {

/// Of car 7, at the end of what was recorded.
inline judge::Verdict judged(const map::Network& network, double from_s, double until_s, const Drive& drive) {
  return judge::attribute(network, eastwards(network), recorded(from_s, until_s, drive), 7);
}

inline std::pair<traffic::Fault, traffic::Cause> pair(const judge::Verdict& verdict) {
  return {verdict.fault, verdict.cause};
}

/// The ego stands at x from t = -4 on (before it braked from 8 m/s), car 7 runs into its tail.
inline Drive rear_ended(double x, std::vector<traffic::CarState> further = {}) {
  return [=](double t) {
    std::vector<traffic::CarState> cars{
        eastbound(0, t < -4.0 ? x + 8.0 * (t + 4.0) : x, 0.0, t < -4.0 ? 8.0 : 0.0),
        eastbound(7, x - 4.9 + 8.0 * t, 0.0, 8.0)};
    cars.insert(cars.end(), further.begin(), further.end());
    return cars;
  };
}

}  // namespace s4tp::test
