#include "sim_host/metrics/gap_acceptance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace s4tp::metrics {
namespace {

constexpr int kDriversMin = 5;
constexpr int kSteps = 20;        // of a grid over mean and deviation
constexpr int kRefinements = 12;  // each grid a quarter as wide as the one before

struct LogNormal {
  double mu = 0.0;
  double sigma = 1.0;
};

double share_below(const LogNormal& law, double gap_s) {
  if (gap_s <= 0.0) {
    return 0.0;
  }
  if (std::isinf(gap_s)) {
    return 1.0;
  }
  return 0.5 * std::erfc(-(std::log(gap_s) - law.mu) / (law.sigma * std::numbers::sqrt2));
}

double log_likelihood(const LogNormal& law, const std::vector<GapChoice>& choices) {
  double sum = 0.0;
  for (const GapChoice& choice : choices) {
    const double p = share_below(law, choice.accepted_s) - share_below(law, choice.largest_rejected_s);
    sum += std::log(std::max(p, 1e-12));
  }
  return sum;
}

}  // namespace

CriticalGap critical_gap(const std::vector<GapChoice>& choices) {
  CriticalGap result;
  std::vector<GapChoice> counting;
  for (const GapChoice& choice : choices) {
    if (choice.accepted_s > choice.largest_rejected_s) {
      counting.push_back(choice);  // who took the first gap counts, too: left out, the hasty would be missing
      result.drivers += choice.largest_rejected_s > 0.0 ? 1 : 0;
    } else {
      ++result.inconsistent;
    }
  }
  if (result.drivers < kDriversMin) {
    return result;
  }
  LogNormal best{std::log(4.0), 0.8};
  double best_value = log_likelihood(best, counting);
  double mu_width = 2.5;
  double sigma_width = 0.75;
  for (int round = 0; round < kRefinements; ++round) {
    const LogNormal centre = best;
    for (int i = -kSteps / 2; i <= kSteps / 2; ++i) {
      for (int j = -kSteps / 2; j <= kSteps / 2; ++j) {
        const LogNormal law{centre.mu + mu_width * 2.0 * i / kSteps,
                            std::max(0.05, centre.sigma + sigma_width * 2.0 * j / kSteps)};
        const double value = log_likelihood(law, counting);
        if (value > best_value) {
          best = law;
          best_value = value;
        }
      }
    }
    mu_width *= 0.25;
    sigma_width *= 0.25;
  }
  const double variance = best.sigma * best.sigma;
  result.mean_s = std::exp(best.mu + 0.5 * variance);
  result.deviation_s = result.mean_s * std::sqrt(std::exp(variance) - 1.0);
  return result;
}

}  // namespace s4tp::metrics
