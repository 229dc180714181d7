#pragma once
/// The row of a weight image by which each future says how likely it lets us pass: fitted to an image as it stands.

#include <cstdint>
#include <vector>

#include "sim_host/train/sample_file.hpp"

namespace s4tp::train {

/// TRAIN-013 Poses and probabilities of the result are the image's to the bit. The row is a logistic regression on the
/// integer network's states: of the futures near what happened, on vehicles of `samples` whose order with us was
/// settled; then rescaled so that p(yields | we go) of `calibration` is likeliest.
/// \throws std::runtime_error when the image is refused, or nothing was settled in either
[[nodiscard]] std::vector<std::uint32_t> fit_yields_row(std::vector<std::uint32_t> image,
                                                        const SampleSet& set,
                                                        const std::vector<std::size_t>& samples,
                                                        const std::vector<std::size_t>& calibration);

}  // namespace s4tp::train
