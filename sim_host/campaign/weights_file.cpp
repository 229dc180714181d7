#include "sim_host/campaign/weights_file.hpp"

#include <cstdint>
#include <stdexcept>

#include "sim_host/world/scenario/whole_file.hpp"

namespace s4tp::campaign {

std::unique_ptr<hal::sim::MemoryFlashBank> bank_with(const std::filesystem::path& file) {
  const std::string bytes = scenario::whole_file(file, hal::sim::MemoryFlashBank::kSize);
  auto bank = std::make_unique<hal::sim::MemoryFlashBank>();
  if (!bank->write(0, bytes.data(), static_cast<std::uint32_t>(bytes.size()))) {
    throw std::runtime_error(file.string() + ": does not fit a flash bank");
  }
  return bank;
}

std::string refused_weights_words(satp::WeightStatus status) {
  if (status == satp::WeightStatus::kOk || status == satp::WeightStatus::kAbsent) return "";
  return std::string("the ECU refuses its weights (") + satp::weight_status_name(status) +
         "): it predicts with the kinematic model";
}

}  // namespace s4tp::campaign
