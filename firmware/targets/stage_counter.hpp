#pragma once
/// Cost of each stage of a planning cycle, in SysTick counts: with run_image.sh --count, instructions.

#include <cstdint>

#include "algo/planner/probe.hpp"

namespace s4tp::targets {

class StageCounter final : public planner::Probe {
 public:
  void stage_begin(planner::Stage stage) override;
  void stage_end(planner::Stage stage) override;
  void cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                  const sadrf::RiskProfile& risk) override;

  struct Row {
    std::uint32_t cycles = 0;  ///< it ran in
    std::uint32_t last = 0;    ///< counts of the last cycle; 0: it did not run in it
    std::uint32_t maximum = 0;
    std::uint64_t sum = 0;
    std::uint32_t running = 0;  ///< counts so far in the cycle that is running
    void close();
  };
  static constexpr int kRows =
      planner::kStageCount + 1;  ///< the last is the whole cycle, what is between stages too
  [[nodiscard]] static const char* name(int row);
  /// \pre 0 <= index < kRows
  [[nodiscard]] const Row& row(int index) const { return rows_[index]; }

 private:
  Row rows_[kRows];
  std::uint32_t began_ = 0;
  std::uint32_t cycle_began_ = 0;
  bool in_cycle_ = false;
};

}  // namespace s4tp::targets
