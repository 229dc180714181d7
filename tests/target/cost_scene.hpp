#pragma once
/// Scenes made of bytes, for whoever looks for what a planning cycle costs at most: every genome is a valid input, and
/// near genomes are near scenes.
///
/// \code
///   road     lanes side by side, cut into segments, opposite lanes, ramps that join them
///   star     arms of several lanes that meet in a junction, every lane linked with up to three exits
/// \endcode

#include <cstdint>

#include "algo/planner/planner.hpp"

namespace s4tp::test {

inline constexpr int kMapGenes = 16;
inline constexpr int kEgoGenes = 10;
inline constexpr int kTrackGenes = 10;
inline constexpr int kMissingGenes = 2;  ///< whether vehicles and lanes are left out
inline constexpr int kGenes = kMapGenes + kEgoGenes + kMaxTracks * kTrackGenes + kMissingGenes;
inline constexpr int kSceneCycles = 2;  ///< the second has histories, beliefs and a running plan

struct Genome {
  std::uint8_t genes[kGenes] = {};
};

/// The world of one genome, and how it goes on from cycle to cycle.
class CostScene {
 public:
  /// Anew, of other genes.
  void make(const Genome& genome);
  /// What the planner is given next; the pointers are valid as long as the scene is.
  [[nodiscard]] const planner::PlannerInput& input() const { return input_; }
  /// One period on: the others keep their speed, the ego is where its plan has it.
  void advance(const Plan& plan);

 private:
  LaneMap map_;
  Plan running_;
  planner::PlannerInput input_;
};

}  // namespace s4tp::test
