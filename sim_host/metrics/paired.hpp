#pragma once
/// Two planners on the same episodes. What both fail or neither fails says nothing about the difference; the
/// discordant pairs do.

namespace s4tp::metrics {

/// Pairs of episodes, same cell and seed.
struct Paired {
  int pairs = 0;
  int only_first_fails = 0;
  int only_second_fails = 0;
};

/// McNemar's exact test, two-sided: how likely discordant pairs are to split so unevenly or more so when both
/// fail equally often; 1 without discordant pairs.
[[nodiscard]] double mcnemar_p(const Paired& paired);

/// Upper end of the 95 % interval of (failure rate of the first - of the second).
/// Source: Tango 1998, score interval of the difference of paired proportions; it also holds with no
/// discordant pair at all, where it is z^2 / (n + z^2), and where only one kind of them is, Wilson's.
/// \param design_effect  of pairs that come in clusters (clusters.hpp): each counts as 1 / design_effect
/// pairs
[[nodiscard]] double difference_upper(const Paired& paired, double design_effect = 1.0);

/// Better: McNemar p < 0.05 and fewer failures. No worse: difference_upper() < 1 %.
[[nodiscard]] bool first_is_better(const Paired& paired);
[[nodiscard]] bool first_is_no_worse(const Paired& paired);

}  // namespace s4tp::metrics
