#pragma once
/// From a trained network to the weight image an ECU links or loads (docs/satp.md, quantization).

#include <cstdint>
#include <vector>

#include "sim_host/train/float_network.hpp"

namespace s4tp::train {

struct ImageFacts {
  float temperature = 1.0F;
  float usual_residual_m = 0.5F;
  std::uint32_t trained_steps = 0;
  std::uint32_t seed = 0;
};

/// Throws std::runtime_error that names the layer that cannot be quantized: a range that was never seen, a
/// multiplier that does not fit. TRAIN-016 The result passes satp::Weights::check, and the same network and
/// ranges give the same bytes. \param ranges  of calibration scenes \return words: header and payload
[[nodiscard]] std::vector<std::uint32_t> quantize(const FloatNetwork& network, const Ranges& ranges,
                                                  const ImageFacts& facts);

}  // namespace s4tp::train
