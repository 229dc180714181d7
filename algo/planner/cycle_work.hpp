#pragma once
/// The work of one cycle, whoever does it: what is spent in the stages that must be done is missing in those that can be
/// cut (docs/budget.md).

#include <cstdint>

#include "algo/core/work_meter.hpp"
#include "algo/planner/explanation.hpp"

namespace s4tp::planner {

/// A cycle: 15.4 million instructions, with 1.3 % for what is charged too little (docs/budget.md).
inline constexpr std::int32_t kCycleWork = 152'000;
inline constexpr std::int32_t kRankWork = 14'000;       ///< of it, at most, for the risks of the ranking
inline constexpr std::int32_t kExactWork = 12'000;      ///< for one exact risk, and ...
inline constexpr std::int32_t kLeastExactWork = 7'000;  ///< ... at least; fewer decisions before less
inline constexpr std::int32_t kPassWork = 1'400;        ///< for a pass of the optimizer

/// What is charged for steps that are not cut.
namespace work {
inline constexpr std::int32_t kScene = 1'000;
inline constexpr std::int32_t kSceneAgent = 350;
inline constexpr std::int32_t kOffsetTried = 4;        ///< a place of our box tried (lateral_offset.hpp)
inline constexpr std::int32_t kEncode = 2'100;         ///< by the network, ...
inline constexpr std::int32_t kEncodeWatched = 1'900;  ///< ... of each vehicle it watches, and ...
inline constexpr std::int32_t kEncodePath = 1'100;     ///< ... of each way that one may take
inline constexpr std::int32_t kGoesOn = 150;           ///< of any vehicle, that it keeps its speed
inline constexpr std::int32_t kDecode = 100;           ///< of all vehicles, and ...
inline constexpr std::int32_t kDecodeAgent = 3'260;    ///< ... of each by the network
inline constexpr std::int32_t kDecodeStep = 7;  ///< of the network's modes and the kinematic predictor's
inline constexpr std::int32_t kCandidates = 700;
inline constexpr std::int32_t kCandidatesAgent = 230;
inline constexpr std::int32_t kRollOut = 200;
inline constexpr std::int32_t kScore = 160;
inline constexpr std::int32_t kTouches = 900;       ///< to count them with one exact risk, at most
inline constexpr std::int32_t kRefinement = 3'800;  ///< to state the optimizer's problem
inline constexpr std::int32_t kEnd = 1'500;         ///< the explanation
inline constexpr std::int32_t kGuardAgent = 190;
inline constexpr std::int32_t kAgentPath = 150;  ///< where a vehicle is along one of our paths, whoever asks
}  // namespace work

class CycleWork {
 public:
  void begin(std::int32_t units) {
    left_ = units - work::kEnd;
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
