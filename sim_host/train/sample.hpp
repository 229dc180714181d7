#pragma once
/// One instant of one drive as the training sees it: what the network is given, what the others then did, and
/// what the kinematic predictor had expected, for comparison.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "algo/core/config.hpp"
#include "algo/satp/network_input.hpp"

namespace s4tp::train {

/// Seeds and road numbers from here on are for reporting.
inline constexpr std::uint64_t kBlocksBegin = 10'000;

/// Scenarios of a sample, in the order of the tables.
enum class SampleScenario : std::uint8_t {
  kLeftTurn,
  kLeftTurnT,
  kMerge,
  kCruise,
  kOvertake,
  kCutIn,
  kGenerated,
  kOther = 255
};

/// Bits of Sample::flags.
enum SampleFlag : std::uint8_t {
  kForked = 1,      ///< one of several branches of the same instant
  kCollided = 2,    ///< the ego collided in this branch
  kUnsettled = 4,   ///< who went first was not settled when the branch ended
  kEgoGoes = 8,     ///< the plan passes the first shared zone without waiting
  kNoPlan = 16,     ///< nobody knows what the ego planned: never shown to the network
  kReporting = 32,  ///< of a seed or road for reporting: never learned from
};

/// Right of way, seen from the other vehicle.
enum class SampleRule : std::uint8_t { kNoZone, kYields, kHasPriority, kFirstCome };

/// What the kinematic predictor expected of one vehicle without our plan, in the vehicle's own frame.
struct KinematicFuture {
  float probability[kMaxModes] = {};  ///< 0: no such mode
  std::uint8_t yields[kMaxModes] = {};
  std::uint8_t reserved = 0;
  std::int16_t position_cm[kMaxModes][kHorizonSteps][2] = {};  ///< x, y at (i + 1) * kStepS
};

struct Sample {
  std::uint64_t road = 0;     ///< what splits and intervals go by: one number a road, or a scenario's seed
  std::uint64_t fork = 0;     ///< shared by all branches of one instant
  std::uint32_t time_ms = 0;  ///< vehicle time of the scene
  std::uint8_t branch = 0;    ///< 0: the plan that was driven anyway
  SampleScenario scenario = SampleScenario::kOther;
  std::uint8_t flags = 0;
  std::uint8_t reserved = 0;
  std::uint8_t interacts[kMaxAgents] = {};  ///< 0 or 1: shares a lane or zone with one of the fork's plans
  std::int8_t yields[kMaxAgents] = {};      ///< in this branch: 1 let us go first, 0 went first, -1 neither
  std::int8_t route[kMaxAgents] = {};       ///< lane path its true last position is nearest to; -1: none
  SampleRule rule[kMaxAgents] = {};         ///< at the first zone it shares with our way
  std::uint16_t episode = 0;                ///< seed of the drive on that road
  std::uint16_t reserved_2 = 0;
  satp::NetworkInput input;
  satp::PlanInput plan;  ///< the motion driven in this branch
  satp::TargetPoses target;
  KinematicFuture kinematic[kMaxAgents];
};
static_assert(std::is_trivially_copyable_v<Sample>, "written as it stands");
static_assert(offsetof(Sample, input) == 48, "nothing between its members that has no name");

}  // namespace s4tp::train
