#include "firmware/targets/platform.hpp"

namespace s4tp::targets {

void start_counting() {}
std::uint32_t counts_now() {
  return 0;
}

}  // namespace s4tp::targets
