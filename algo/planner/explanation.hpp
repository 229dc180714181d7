#pragma once
/// Why a plan was chosen: carried with every plan, logged, shown.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/core/status.hpp"
#include "algo/sadrf/risk.hpp"
#include "algo/safety/guard.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp::planner {

/// Terms of one candidate's score; the score is the sum, lower is better.
struct CostBreakdown {
  float progress = 0.0F;  ///< negative: a reward
  float speed = 0.0F;
  float jerk = 0.0F;
  float lateral = 0.0F;
  float lane = 0.0F;  ///< offset, distance from the route's lane, lane change
  float risk = 0.0F;
  [[nodiscard]] float total() const;
};

/// The motion that would have gone furthest, had the guard not refused it.
struct BlockingReason {
  safety::Verdict verdict;   ///< why it was; safe: nothing was refused
  std::uint8_t track = 255;  ///< track id of who is in its way; 255: nobody that has one
  scene::Manoeuvre manoeuvre = scene::Manoeuvre::kKeep;
  float way_m = 0.0F;  ///< it would have driven within the horizon
  /// CORE-037 Whether in its way is somebody we are not told of, but have to reckon with.
  [[nodiscard]] bool unseen() const { return verdict.agent == safety::kUnseen; }
};

/// The stages of a cycle, in the order the data flows.
enum class Stage : std::uint8_t {
  kScene = 0,
  kCandidates,
  kPredict,
  kRank,
  kExactRisk,
  kOptimize,
  kCheck,
  kExplain,
  kCount
};
inline constexpr int kStageCount = static_cast<int>(Stage::kCount);

/// What the vehicle whose risk is largest is expected to do, our plan known to it.
struct ExpectedFuture {
  bool yields = false;       ///< the likeliest future brakes for us
  float probability = 0.0F;  ///< of all that do the same; 0: nothing was predicted of it
  float trust = 1.0F;        ///< in the network about it (PredictionTrust); the rest is the kinematic model's
};

/// \param agent  index into Scene::agents; 255: nobody
[[nodiscard]] ExpectedFuture expected_future(const satp::PredictionSet& prediction, int agent);

struct Explanation {
  Status status = Status::kOk;
  std::uint8_t candidate_count = 0;
  std::uint8_t left_out = 0;
  trajectory::Candidate chosen;
  trajectory::Candidate runner_up;
  scene::Manoeuvre manoeuvre = scene::Manoeuvre::kKeep;  ///< of `chosen`
  scene::Manoeuvre runner_up_manoeuvre = scene::Manoeuvre::kKeep;
  CostBreakdown chosen_cost;
  CostBreakdown runner_up_cost;
  trajectory::Rejection rejections[kMaxCandidates] = {};
  bool learned = false;        ///< the network predicted, not the kinematic model alone
  std::uint8_t decisions = 0;  ///< how many were predicted with our plan
  /// CORE-072 Of the plan as it is given, a minimum-risk manoeuvre's too; zeros where nothing was predicted
  /// (no lane, broken input), and of the plan before its last changes where no allowance was left.
  sadrf::RiskProfile risk{};
  std::uint8_t dominating_track = 255;  ///< track id of the vehicle whose risk is largest; 255: nobody
  std::uint8_t dominating_step = 0;
  ExpectedFuture rests_on;           ///< CORE-077 of the vehicle of dominating_track: what the plan rests on
  BlockingReason blocking;           ///< in our lane
  BlockingReason beside;             ///< in the lanes beside
  std::uint8_t leader_track = 255;   ///< track id of who drives ahead on the way chosen; 255: nobody
  float leader_gap_m = 0.0F;         ///< bumper to bumper
  std::uint8_t id_clashes = 0;       ///< vehicles whose ids were not their own (CORE-035)
  std::uint8_t tracks_left_out = 0;  ///< vehicles known to be about that neither list nor scene has room for
  std::uint8_t lanes_left_out = 0;   ///< of the map
  std::uint16_t work[kStageCount] = {};  ///< units used per stage
  std::uint32_t parameters_crc = 0;
};

}  // namespace s4tp::planner
