// The ECU application without any device: it links, and refuses to start.

#include <cstdlib>

#include "algo/core/check.hpp"
#include "algo/planner/planner.hpp"
#include "firmware/ecu/ecu.hpp"

void s4tp::assertion_failed(const char*, const char*, int) {
  std::abort();
}

static s4tp::ecu::Ecu<s4tp::Planner> ecu;

int main() {
  return ecu.init(s4tp::Parameters{}, s4tp::ecu::Ports{}) == s4tp::Status::kInvalidInput ? 0 : 1;
}
