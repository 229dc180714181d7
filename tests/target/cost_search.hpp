#pragma once
/// Looks for the scenes that cost the most: for each stage and for the whole cycle the dearest few are kept and
/// changed a little, again and again. The same seed and the same beginning give the same search.

#include "algo/planner/explanation.hpp"
#include "tests/target/cost_scene.hpp"

namespace s4tp::test {

inline constexpr int kCostRows = planner::kStageCount + 1;  ///< the last is the whole cycle

/// The most of any of a scene's cycles, in counts of platform.hpp.
struct Cost {
  std::uint32_t rows[kCostRows] = {};
};

class CostSearch {
 public:
  explicit CostSearch(std::uint32_t seed) { this->seed(seed); }
  void seed(std::uint32_t seed) { random_ = seed * 2654435761U + 1U; }
  /// What to measure next.
  [[nodiscard]] Genome propose();
  /// \return bit i: it costs more in row i than all before it
  std::uint32_t take(const Genome& genome, const Cost& cost);

  struct Elite {
    Genome genome;
    std::uint32_t count = 0;
  };
  /// The dearest of a row. \pre one was taken
  [[nodiscard]] const Elite& best(int row) const { return elites_[row][0]; }

 private:
  static constexpr int kElites = 8;

  std::uint32_t below(std::uint32_t bound);
  const Genome& parent();
  void mutate(Genome& genome);

  std::uint32_t random_ = 1;
  Elite elites_[kCostRows][kElites];  ///< the dearest first
  std::uint32_t taken_ = 0;
};

}  // namespace s4tp::test
