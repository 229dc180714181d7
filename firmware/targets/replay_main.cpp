/// The replay image: proves on this processor that the same frames give the same plans and commands.
///   replay                    the arithmetic self-test alone
///   replay LOG [--stages]     with the cost of each stage at the end
/// Exit code: 0 identical, 1 something differs, 2 the log cannot be judged, 3 a fault of the core.

#include "algo/core/self_test.hpp"
#include "firmware/targets/platform.hpp"
#include "firmware/targets/replay.hpp"
#include "firmware/targets/stage_counter.hpp"
#include "firmware/targets/text.hpp"

namespace s4tp::targets {
namespace {

constexpr int kIdentical = 0;
constexpr int kDifferent = 1;
constexpr int kNotJudged = 2;

Replay replay;
StageCounter stage_counter;

bool self_test() {
  const ArithmeticProbes probes = probe_arithmetic();
  const bool passed = status_of(probes) == Status::kOk;
  Text line;
  line << "arithmetic self-test " << (passed ? "passed" : "FAILED") << ", functions hash ";
  line.hex(probes.functions_hash, 8) << "\n";
  print(line.c_str());
  return passed;
}

/// Cuts a file into lines. \return false when it cannot be read or a line is too long
bool feed(int handle) {
  static char chunk[512];
  static char line[160];
  int size = 0;
  for (;;) {
    const int got = read(handle, chunk, sizeof chunk);
    if (got < 0) return false;
    if (got == 0) break;
    for (int i = 0; i < got; ++i) {
      if (chunk[i] == '\n') {
        replay.line(line, size);
        size = 0;
      } else if (size == static_cast<int>(sizeof line)) {
        return false;
      } else {
        line[size++] = chunk[i];
      }
    }
  }
  if (size > 0) replay.line(line, size);
  return true;
}

/// One line a stage: cycles it ran in, mean and maximum counts per cycle.
void print_stages() {
  for (int i = 0; i < StageCounter::kRows; ++i) {
    const StageCounter::Row& row = stage_counter.row(i);
    const std::uint64_t mean = row.cycles == 0 ? 0 : row.sum / row.cycles;
    Text text;
    text << "stage " << StageCounter::name(i) << " cycles " << row.cycles << " mean "
         << static_cast<std::uint32_t>(mean) << " max " << row.maximum << "\n";
    print(text.c_str());
  }
}

}  // namespace

int run(const char* log, bool stages) {
  if (!self_test()) return kDifferent;
  if (log == nullptr) return kIdentical;
  const int handle = open_for_reading(log);
  if (handle < 0) {
    print("cannot open the log\n");
    return kNotJudged;
  }
  if (!replay.init(Parameters{})) {
    print("the ECU refuses to start\n");
    return kNotJudged;
  }
  if (stages) replay.planner().probe = &stage_counter;
  if (!feed(handle)) {
    print("cannot read the log\n");
    return kNotJudged;
  }
  replay.finish();
  if (stages) print_stages();
  replay.print_summary();
  if (!replay.valid()) return kNotJudged;
  return replay.identical() ? kIdentical : kDifferent;
}

}  // namespace s4tp::targets
