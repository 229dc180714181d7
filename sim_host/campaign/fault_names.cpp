#include "sim_host/campaign/fault_names.hpp"

namespace s4tp::campaign {

std::string fault_names(ecu::Faults faults) {
  std::string names;
  for (int bit = 0; bit < ecu::kFaultCount; ++bit) {
    if ((faults >> bit & 1U) != 0) names += (names.empty() ? "" : ", ") + std::string(ecu::fault_name(bit));
  }
  return names;
}

}  // namespace s4tp::campaign
