#pragma once
/// The trained network as a predictor to be judged.

#include <cstddef>
#include <vector>

#include "sim_host/train/forecast.hpp"
#include "sim_host/train/network.hpp"

namespace s4tp::train {

/// Forecasts of the network, with the plan driven or without any. \param temperature  of the modes' softmax
[[nodiscard]] Forecasts network_forecasts(Network& network, const SampleSet& set,
                                          const std::vector<std::size_t>& samples, bool with_plan,
                                          double temperature);

/// The temperature under which the nearest modes of these samples are the likeliest, plans shown; 0.2 .. 5.
[[nodiscard]] double calibrated_temperature(Network& network, const SampleSet& set,
                                            const std::vector<std::size_t>& samples);

}  // namespace s4tp::train
