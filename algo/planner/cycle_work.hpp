#pragma once
/// The work of one cycle, whoever does it: what is spent in the stages that must be done is missing in those that can be
/// cut (docs/budget.md).

#include <cstdint>

#include "algo/core/work_meter.hpp"
#include "algo/planner/explanation.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp::planner {

inline constexpr std::int32_t kCycleWork = 154'000;      ///< 15.4 million instructions
inline constexpr std::int32_t kCandidatesWork = 23'000;  ///< of it, at most, for the candidates, ...
inline constexpr std::int32_t kRankWork = 16'000;        ///< ... for the risks of the ranking, ...
inline constexpr std::int32_t kExactWork = 12'000;       ///< ... for one exact risk, and ...
inline constexpr std::int32_t kLeastExactWork = 7'000;   ///< ... at least; fewer decisions before less
inline constexpr std::int32_t kFieldWork = 15'000;       ///< ... for the field in the optimizer, ...
inline constexpr std::int32_t kPassWork = 1'400;         ///< and for a pass of it

/// What is charged for steps whose work is known by sizes; others tell what they took.
namespace work {
inline constexpr std::int32_t kBetween = 400;  ///< the start, and the minimum-risk manoeuvre
inline constexpr std::int32_t kExplain = 30;
inline constexpr std::int32_t kEncode = 2'550;         ///< by the network, ...
inline constexpr std::int32_t kEncodeWatched = 1'950;  ///< ... of each vehicle it watches, and ...
inline constexpr std::int32_t kEncodePath = 1'100;     ///< ... of each path that one may take
inline constexpr std::int32_t kGoesOn = 180;           ///< of any vehicle, that it keeps its speed
inline constexpr std::int32_t kDecode = 150;           ///< of all vehicles, and ...
inline constexpr std::int32_t kDecodeAgent = 3'300;    ///< ... of each by the network
inline constexpr std::int32_t kDecodeStep = 8;  ///< of the network's modes and the kinematic predictor's
inline constexpr std::int32_t kCandidates = 60;
inline constexpr std::int32_t kVisit = 60;          ///< to see which decision a candidate is
inline constexpr std::int32_t kMostScore = 1'500;   ///< to judge and score it
inline constexpr std::int32_t kTouches = 900;       ///< to count them with one exact risk, at most
inline constexpr std::int32_t kRefinement = 6'700;  ///< to state the optimizer's problem

/// What a decode takes beyond kDecode. \param steps  of agents' modes, the network's among them
[[nodiscard]] constexpr std::int32_t of_decode(int agents, int steps) {
  return kDecodeAgent * agents + kDecodeStep * steps;
}
}  // namespace work

class CycleWork {
 public:
  void begin(std::int32_t units) {
    left_ = units - work::kBetween;
    for (std::int32_t& spent : spent_) spent = 0;
  }
  void spend(Stage stage, std::int32_t units) {
    left_ -= units;
    spent_[static_cast<int>(stage)] += units;
  }
  [[nodiscard]] std::int32_t left() const { return left_; }
  [[nodiscard]] std::int32_t spent(Stage stage) const { return spent_[static_cast<int>(stage)]; }

 private:
  std::int32_t left_ = 0;
  std::int32_t spent_[kStageCount] = {};
};

}  // namespace s4tp::planner
