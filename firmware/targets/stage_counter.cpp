#include "firmware/targets/stage_counter.hpp"

#include "firmware/targets/platform.hpp"

namespace s4tp::targets {

const char* StageCounter::name(int row) {
  static constexpr const char* kNames[kRows] = {"scene",    "candidates", "predict", "rank", "exact_risk",
                                                "optimize", "check",      "explain", "all"};
  return kNames[row];
}

void StageCounter::Row::close() {
  last = running;
  running = 0;
  if (last == 0) return;
  ++cycles;
  sum += last;
  if (last > maximum) maximum = last;
}

void StageCounter::stage_begin(planner::Stage) {
  began_ = counts_now();
  if (in_cycle_) return;
  in_cycle_ = true;
  cycle_began_ = began_;
}

void StageCounter::stage_end(planner::Stage stage) {
  rows_[static_cast<int>(stage)].running += counts_now() - began_;
}

void StageCounter::cycle_done(const scene::Scene&, const satp::PredictionSet&, const sadrf::RiskProfile&) {
  if (in_cycle_) rows_[planner::kStageCount].running = counts_now() - cycle_began_;
  in_cycle_ = false;
  for (Row& row : rows_) row.close();
}

}  // namespace s4tp::targets
