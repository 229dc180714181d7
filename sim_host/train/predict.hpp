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

/// What log-odds are multiplied by, and what is added.
struct Rescale {
  double scale = 1.0;
  double shift = 0.0;
};
/// That makes the probabilities of yielding likeliest. \param log_odds, share  [N, K] \param yielded  [N] 0 or 1
[[nodiscard]] Rescale best_rescale(const torch::Tensor& log_odds, const torch::Tensor& share,
                                   const torch::Tensor& yielded);

/// Rescales the network's log-odds of yielding so that p(yields | we go) of these samples is likeliest.
void calibrate_yields(Network& network, const SampleSet& set, std::vector<std::size_t> samples,
                      double temperature);

}  // namespace s4tp::train
