#pragma once
/// Yield beliefs (method.md 4.3): how a vehicle's driving speaks for "lets us go first" against "goes first".
/// Bayes filter on log-odds; the prior is the prediction's own, evidence comes on top of it.
/// BELIEF-001 Driving speaks for the hypothesis it is nearer to, with at most 1 a cycle and 7 in all; nothing
/// becomes certain. BELIEF-002 What is not told apart is no evidence, and what is known fades; who stands
/// first in line with the way open lets us go. BELIEF-003 Beliefs belong to tracks.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/satp/path_hypothesis.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::satp {

/// What a vehicle would do now under either hypothesis [m/s^2].
struct YieldHypotheses {
  bool differ = false;  ///< false: nothing can be learned from how it drives
  float goes_mps2 = 0.0F;
  float yields_mps2 = 0.0F;
};

class YieldBeliefs {
 public:
  void reset() { beliefs_.clear(); }
  /// Log-odds of the evidence that the track lets us go first; 0: none.
  [[nodiscard]] float evidence(std::uint8_t track) const;
  /// One cycle's observation of each watched vehicle. Tracks that are no longer watched are forgotten.
  void observe(const scene::Scene& scene, const YieldHypotheses (&hypotheses)[kMaxAgents]);

 private:
  struct Belief {
    std::uint8_t track = 255;
    float log_odds = 0.0F;
  };
  BoundedVector<Belief, kMaxAgents> beliefs_;
};

/// The probability `prior` with evidence taken into account, in 0.02 .. 0.98 of the prior's kind.
[[nodiscard]] float with_evidence(float prior, float log_odds);

}  // namespace s4tp::satp
