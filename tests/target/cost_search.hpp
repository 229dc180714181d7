#pragma once
/// Looks for the scenes that cost the most, and for those that cost most beyond what they were charged: for each stage
/// and for the whole cycle the worst few are kept and changed a little, again and again. The same seed and the same
/// beginning give the same search.

#include "algo/planner/explanation.hpp"
#include "tests/target/cost_scene.hpp"

namespace s4tp::test {

inline constexpr int kCostStages = planner::kStageCount + 1;  ///< the last is the whole cycle
inline constexpr int kCostRows = 2 * kCostStages;
/// What is added to a cost less its charge, so that it is a count.
inline constexpr std::uint32_t kNothingShort = 1U << 30U;

/// The most of any of a scene's cycles, in counts of platform.hpp: of each stage, then of each what it took beyond its
/// charge, kNothingShort added.
struct Cost {
  std::uint32_t rows[kCostRows] = {};
};

class CostSearch {
 public:
  explicit CostSearch(std::uint32_t seed) { this->seed(seed); }
  void seed(std::uint32_t seed) { random_ = seed * 2654435761U + 1U; }
  /// What to measure next.
  [[nodiscard]] Genome propose();
  /// Keeps it where it is among the worst of a row.
  void take(const Genome& genome, const Cost& cost);

  struct Elite {
    Genome genome;
    std::uint32_t count = 0;
  };
  /// The worst of a row. \pre one was taken
  [[nodiscard]] const Elite& best(int row) const { return elites_[row][0]; }

 private:
  static constexpr int kElites = 6;

  std::uint32_t below(std::uint32_t bound);
  const Genome& parent();
  void mutate(Genome& genome);

  std::uint32_t random_ = 1;
  Elite elites_[kCostRows][kElites];  ///< the worst first
  std::uint32_t taken_ = 0;
};

}  // namespace s4tp::test
