#pragma once
/// Decisions: which candidates are worth a prediction conditioned on them (method.md 4.6). A decision is a
/// target lane and an order of passing; candidates that share both differ in comfort only.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::planner {

/// Target path in the low bits, then one bit a conflict zone (we enter it within the horizon), then one bit a
/// watched vehicle (we end ahead of it).
using DecisionKey = std::uint32_t;

[[nodiscard]] DecisionKey decision_key(const scene::Scene& scene, int path, const Trajectory& trajectory,
                                       const satp::PredictionSet& marginal);

[[nodiscard]] int path_of(DecisionKey key);

/// What a shortlist may not be without.
struct Reserved {
  DecisionKey plan = 0;     ///< the running plan's, where ...
  bool keeps_plan = false;  ///< ... it is among the candidates
  std::int8_t goes_on = 0;  ///< the path on which the manoeuvre in force goes on
  [[nodiscard]] bool holds(int path) const { return goes_on != 0 && (path == goes_on || path == 0); }
};

/// A candidate that stands for its decision.
struct Decision {
  DecisionKey key = 0;
  std::uint8_t candidate = 0;
  float score = 0.0F;
};

/// The best candidate of each decision, cheapest decisions first.
class DecisionList {
 public:
  /// False when a candidate of decision `key` that scores `least` or more can change nothing: its decision
  /// has a better one, or it would not be among the `count` best decisions.
  [[nodiscard]] bool open_to(DecisionKey key, float least, int count) const;
  /// Offers a candidate; kept when it is the best of its decision so far.
  void offer(DecisionKey key, int candidate, float score);
  /// Whether none that leads to `path` scores less.
  [[nodiscard]] bool leads_path(int path, float score) const;
  /// Keeps at most `count`, cheapest first, but never drops what is reserved: the running plan's decision, and, where a
  /// manoeuvre is in force, the cheapest that goes on with it and the cheapest in our own lane; in this order while there is room.
  void shortlist(int count, const Reserved& reserved);
  [[nodiscard]] int size() const { return decisions_.size(); }
  [[nodiscard]] const Decision& operator[](int index) const { return decisions_[index]; }
  void clear() { decisions_.clear(); }

 private:
  BoundedVector<Decision, kMaxCandidates> decisions_;
};

}  // namespace s4tp::planner
