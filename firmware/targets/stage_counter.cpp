#include "firmware/targets/stage_counter.hpp"

#include "firmware/targets/platform.hpp"
#include "firmware/targets/text.hpp"

namespace s4tp::targets {
namespace {

constexpr const char* kNames[kStageCount] = {"scene",      "candidates", "predict", "rank",
                                             "exact_risk", "optimize",   "check",   "explain"};

std::uint32_t mean(std::uint64_t sum, std::uint32_t count) {
  return count == 0 ? 0 : static_cast<std::uint32_t>(sum / count);
}

}  // namespace

void StageCounter::Row::close() {
  if (running == 0) return;
  ++cycles;
  sum += running;
  if (running > maximum) maximum = running;
  running = 0;
}

void StageCounter::stage_begin(Stage) {
  began_ = counts_now();
}

void StageCounter::stage_end(Stage stage) {
  const std::uint32_t counts = counts_now() - began_;
  stages_[static_cast<int>(stage)].running += counts;
  total_.running += counts;
}

void StageCounter::cycle_done(const Scene&, const PredictionSet&, const RiskProfile&) {
  for (Row& stage : stages_) stage.close();
  total_.close();
}

void StageCounter::print_table() const {
  for (int i = 0; i <= kStageCount; ++i) {
    const Row& row = i < kStageCount ? stages_[i] : total_;
    Text text;
    text << "stage " << (i < kStageCount ? kNames[i] : "all") << " cycles " << row.cycles << " mean "
         << mean(row.sum, row.cycles) << " max " << row.maximum << "\n";
    print(text.c_str());
  }
}

}  // namespace s4tp::targets
