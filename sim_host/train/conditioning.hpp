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
/// - "phantom": vehicles that share nothing with either plan, share whose mean moves by less than 0.3 m;
///   "untouched": those that share something and truly differ by less than 0.2 m, share below 0.5 m
/// Each with "pairs" and a 95 % interval clustered by road where it is a share.
/// \param forecasts  of each sample under its own plan
[[nodiscard]] nlohmann::ordered_json conditioning_figures(const SampleSet& set,
                                                          const std::vector<std::size_t>& samples,
                                                          const Forecasts& forecasts, double sigma_m);

/// p(yields | our plan): probability of the modes that are before the shared zone when we leave it, at the
/// last speeds beyond the horizon. \pre the vehicle's rule is not kNoZone
[[nodiscard]] double yield_probability(const Sample& sample, int vehicle, const Forecast& forecast);

/// How well it is kept, over forks that go and were settled or collided: ten bins of expected and happened,
/// their mean distance weighted by count ("error"), and the Brier skill over the base rate by right-of-way
/// class.
[[nodiscard]] nlohmann::ordered_json yield_figures(const SampleSet& set,
                                                   const std::vector<std::size_t>& samples,
                                                   const Forecasts& forecasts);

}  // namespace s4tp::train
