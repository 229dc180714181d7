#pragma once
/// From a trained network to what an ECU takes, and that judged like any other predictor.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim_host/train/forecast.hpp"
#include "sim_host/train/quantizer.hpp"

namespace s4tp::train {

/// What the training leaves to be exported.
struct Trained {
  Tensors tensors;
  std::optional<Ranges> ranges;  ///< it was trained with; else those of the samples
  float temperature = 1.0F;
  std::uint32_t steps = 0;
  std::uint32_t seed = 0;
};

/// Samples of the calibration part that an export takes its scales from.
[[nodiscard]] std::vector<std::size_t> export_samples(const SampleSet& set);

/// Of the outputs of all layers, plans shown and not.
[[nodiscard]] Ranges calibrated_ranges(const Tensors& tensors, const SampleSet& set,
                                       const std::vector<std::size_t>& samples);

/// TRAIN-005 The weight image of the deployed size, with scales from these samples, with and without their
/// plans: the same network and samples give the same words.
/// \param samples  some hundreds; more cost 20 ms each \throws std::runtime_error what cannot be quantized
[[nodiscard]] std::vector<std::uint32_t> export_image(const Trained& trained, const SampleSet& set,
                                                      const std::vector<std::size_t>& samples);

/// As a flash bank's content, and as the words a build links (algo/satp/shipped_weights.hpp).
/// \throws std::runtime_error when a file cannot be written
void write_image(const std::vector<std::uint32_t>& image, const std::filesystem::path& file);
void write_image_words(const std::vector<std::uint32_t>& image, const std::filesystem::path& file);
/// \throws std::runtime_error when there is no such file or it is not of words
[[nodiscard]] std::vector<std::uint32_t> read_image(const std::filesystem::path& file);

/// Forecasts of the integer network, as the ECU computes them. \throws std::runtime_error for what an ECU
/// would refuse, with its reason
[[nodiscard]] Forecasts image_forecasts(const std::vector<std::uint32_t>& image, const SampleSet& set,
                                        const std::vector<std::size_t>& samples, bool with_plan);

}  // namespace s4tp::train
