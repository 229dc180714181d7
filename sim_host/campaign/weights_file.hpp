#pragma once
/// A weight image in a file as an ECU finds it in a flash bank, and what became of it.

#include <filesystem>
#include <memory>
#include <string>

#include "algo/satp/weight_image.hpp"
#include "hal/sim/memory_flash_bank.hpp"

namespace s4tp::campaign {

/// Written to an erased bank as it is: whether it is sound the ECU says.
/// \throws std::runtime_error when it cannot be read, or is larger than a bank
[[nodiscard]] std::unique_ptr<hal::sim::MemoryFlashBank> bank_with(const std::filesystem::path& file);

/// Empty unless an image was refused.
[[nodiscard]] std::string refused_weights_words(satp::WeightStatus status);

}  // namespace s4tp::campaign
