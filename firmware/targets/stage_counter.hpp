#pragma once
/// Cost of each stage of a planning cycle in SysTick counts, for run_image.sh --count.

#include <cstdint>

#include "algo/planner/probe.hpp"

namespace s4tp::targets {

class StageCounter final : public Probe {
 public:
  void stage_begin(Stage stage) override;
  void stage_end(Stage stage) override;
  void cycle_done(const Scene& scene, const PredictionSet& prediction, const RiskProfile& risk) override;
  /// One line a stage: cycles it ran in, mean and maximum counts per cycle.
  void print_table() const;

 private:
  struct Row {
    std::uint32_t cycles = 0;
    std::uint32_t running = 0;  ///< counts so far in the cycle that is running
    std::uint32_t maximum = 0;
    std::uint64_t sum = 0;
    void close();
  };
  Row stages_[kStageCount];
  Row total_;
  std::uint32_t began_ = 0;
};

}  // namespace s4tp::targets
