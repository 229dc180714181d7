#pragma once
/// What some predictor expects of the vehicles of a sample, in one form for all predictors.

#include <array>
#include <cstddef>
#include <vector>

#include "sim_host/train/sample_file.hpp"

namespace s4tp::train {

/// Of one vehicle, in its own frame.
struct Forecast {
  float gate = 0.0F;                  ///< how strongly our plan entered it
  float probability[kMaxModes] = {};  ///< adds up to 1; 0: no such mode
  float yields[kMaxModes] = {};       ///< how likely each lets us pass first, if our ways meet
  float position_m[kMaxModes][kHorizonSteps][2] = {};

  /// How likely it lets us pass first.
  [[nodiscard]] double yield_probability() const;
  [[nodiscard]] int likeliest() const;
  /// Expected position at the horizon's end [m].
  [[nodiscard]] std::array<double, 2> mean_end() const;
};

/// By vehicle of a sample.
using SceneForecast = std::array<Forecast, kMaxAgents>;
/// By place in a list of samples.
using Forecasts = std::vector<SceneForecast>;

/// The kinematic predictor's, as the samples have them.
[[nodiscard]] Forecasts kinematic_forecasts(const SampleSet& set, const std::vector<std::size_t>& samples);
/// The same, its likeliest future at 0.8, 1 and 1.2 times its pace as three equally likely modes: where only
/// the nearest mode counts, one future would be no match for three.
[[nodiscard]] Forecasts kinematic_variants(const SampleSet& set, const std::vector<std::size_t>& samples);
/// Speed and heading kept.
[[nodiscard]] Forecasts steady_forecasts(const SampleSet& set, const std::vector<std::size_t>& samples);

}  // namespace s4tp::train
