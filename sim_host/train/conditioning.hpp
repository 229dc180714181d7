#pragma once
/// Whether a forecast follows our plan as the others do: on forks, where all but the plan is equal.

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "sim_host/train/forecast.hpp"

namespace s4tp::train {

/// Figures over all pairs of branches of a fork, by vehicle seen at 3 s in both.
/// - "told_apart": where the true positions at 3 s differ by at least 2 m, the share of branches whose future
/// is
///   likelier under its own plan than under the other's (modes round Gaussians of `sigma_m`)
/// - "slope", "explained": of the true on the predicted difference of mean positions at 3 s, through zero
/// - "phantom": vehicles no path of which and of ours have anything in common (NetworkInput::paths_meet), share
///   whose mean moves by less than 0.3 m; "phantom_in_hindsight": those whose paths as driven had not;
///   "untouched": those that share something and truly differ by less than 0.2 m, share below 0.5 m
/// Each with "pairs" and a 95 % interval clustered by road where it is a share.
/// \param forecasts  of each sample under its own plan
[[nodiscard]] nlohmann::ordered_json conditioning_figures(const SampleSet& set,
                                                          const std::vector<std::size_t>& samples,
                                                          const Forecasts& forecasts, double sigma_m);

/// How strongly our plan enters the futures of vehicles whose ways and ours had something in common, of the
/// others, and the share for whom it is shut.
[[nodiscard]] nlohmann::ordered_json gate_figures(const SampleSet& set,
                                                  const std::vector<std::size_t>& samples,
                                                  const Forecasts& forecasts);

/// How well p(yields | we go) is kept, over forks that go, those with a collision among them; what was not
/// settled after 8 s is counted only. Ten bins of expected and happened, their mean distance weighted by
/// count ("error"), and the Brier skill over the base rate by right-of-way class.
[[nodiscard]] nlohmann::ordered_json yield_figures(const SampleSet& set,
                                                   const std::vector<std::size_t>& samples,
                                                   const Forecasts& forecasts);

}  // namespace s4tp::train
