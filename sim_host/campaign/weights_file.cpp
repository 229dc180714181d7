#include "sim_host/campaign/weights_file.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace s4tp::campaign {

std::unique_ptr<hal::sim::MemoryFlashBank> bank_with(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  auto bank = std::make_unique<hal::sim::MemoryFlashBank>();
  if (!bank->write(0, bytes.data(), static_cast<std::uint32_t>(bytes.size()))) {
    throw std::runtime_error(file.string() + ": larger than a flash bank, " + std::to_string(bank->size()) +
                             " bytes");
  }
  return bank;
}

std::string refused_weights_words(satp::WeightStatus status) {
  if (status == satp::WeightStatus::kOk || status == satp::WeightStatus::kAbsent) return "";
  return std::string("the ECU refuses its weights (") + satp::weight_status_name(status) +
         "): it predicts with the kinematic model";
}

}  // namespace s4tp::campaign
