#include "sim_host/metrics/paired.hpp"

#include <algorithm>
#include <cmath>

#include "sim_host/metrics/confidence.hpp"

namespace s4tp::metrics {
namespace {

/// Tango's statistic: how many standard errors the data (pairs, only first fails, only second fails) lie
/// above a true difference `delta`.
double score(double n, double b, double c, double delta) {
  // Likeliest probability of "only the second fails" under that difference.
  const double qa = 2.0 * n;
  const double qb = -b - c + (2.0 * n - b + c) * delta;
  const double qc = -c * delta * (1.0 - delta);
  const double q = (std::sqrt(std::max(0.0, qb * qb - 4.0 * qa * qc)) - qb) / (2.0 * qa);
  const double variance = n * (2.0 * q + delta * (1.0 - delta));
  const double excess = b - c - n * delta;
  return variance > 0.0 ? excess / std::sqrt(variance) : std::copysign(1e9, excess);
}

}  // namespace

double mcnemar_p(const Paired& paired) {
  const int discordant = paired.only_first_fails + paired.only_second_fails;
  const int fewer = std::min(paired.only_first_fails, paired.only_second_fails);
  double tail = 0.0;
  for (int k = 0; k <= fewer; ++k) {
    const double log_ways =
        std::lgamma(discordant + 1.0) - std::lgamma(k + 1.0) - std::lgamma(discordant - k + 1.0);
    tail += std::exp(log_ways - discordant * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

double difference_upper(const Paired& paired, double design_effect) {
  if (paired.pairs == 0) return 1.0;
  const double n = paired.pairs / design_effect;
  const double b = paired.only_first_fails / design_effect;
  const double c = paired.only_second_fails / design_effect;
  double low = static_cast<double>(paired.only_first_fails - paired.only_second_fails) / paired.pairs;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (score(n, b, c, middle) > -kZ ? low : high) = middle;
  }
  return high;
}

bool first_is_better(const Paired& paired) {
  return paired.only_first_fails < paired.only_second_fails && mcnemar_p(paired) < 0.05;
}

bool first_is_no_worse(const Paired& paired) {
  return difference_upper(paired) < 0.01;
}

}  // namespace s4tp::metrics
