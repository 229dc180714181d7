#pragma once
/// What a trained network is worth beside the constant-velocity and the kinematic predictor: a table on standard
/// output, and files where they are asked for.

#include <filesystem>

#include "algo/satp/network_shape.hpp"

namespace s4tp::train {

/// An empty path: none.
struct EvaluationOptions {
  std::filesystem::path data;        ///< the samples it was trained on: their calibration part calibrates
  std::filesystem::path fresh;       ///< samples to judge it on; else the validation part of `data`
  std::filesystem::path checkpoint;  ///< of the network; none: the image is judged alone
  std::filesystem::path image;       ///< judged as well
  std::filesystem::path json;        ///< file for all figures
  std::filesystem::path plot;        ///< file for the reliability plot (SVG)
};

/// \throws std::runtime_error when a file cannot be read or written, or there is neither checkpoint nor image
void evaluate(const satp::NetworkShape& shape, const EvaluationOptions& options);

}  // namespace s4tp::train
