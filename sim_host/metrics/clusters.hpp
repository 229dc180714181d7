#pragma once
/// Means over episodes that come in clusters: those of one road are more alike than those of several, so that
/// they tell less than as many independent ones.

#include <vector>

#include "sim_host/metrics/summary.hpp"

namespace s4tp::metrics {

/// The values of one road's episodes. A failure counts 1, a goal 0; a pair of episodes the difference of
/// both.
struct Cluster {
  int episodes = 0;
  double sum = 0.0;
  double squares = 0.0;
  void add(double value);
};

/// By how much the variance of the mean over all episodes is larger than with as many independent ones; 1 and
/// more. Source: Kish 1965, the ratio estimator's variance over the simple one's. One more road of mean size
/// is counted on which every second episode fails: with few failures nothing else says whether they gather on
/// some roads, and without any there would be no estimate at all. \pre clusters not empty, none without
/// episodes
[[nodiscard]] double design_effect(const std::vector<Cluster>& clusters);

/// 95 % Wilson interval of the share of failures, clustered by road: with as many effective episodes as there
/// are, divided by design_effect(). Source: Korn and Graubard 1998, for the effective number.
[[nodiscard]] Interval clustered_wilson(const std::vector<Cluster>& failures);

}  // namespace s4tp::metrics
