#pragma once
/// Where the manoeuvres of a plan stand: what was decided, carried with the plan that does it (method.md 4.4). The
/// transitions stand in algo/behavior.

#include <cstdint>

namespace s4tp {

/// A change to a lane beside ours.
enum class LaneChange : std::uint8_t {
  kKeep = 0,      ///< none
  kPrepare = 1,   ///< the plan leads over, our box is still in its lane
  kCrossing = 2,  ///< our box is over the line; it may still go back
  kFinish = 3,    ///< the lane it leads to is under us
  kSettle = 4,    ///< made or given up, others get used to us
};

/// A change that the route asks for.
enum class RequiredChange : std::uint8_t {
  kNone = 0,
  kApproaching = 1,
  kWaiting = 2,  ///< at rest in front of the last place for it
};

/// The way through the next group of conflict zones.
enum class ZoneClaim : std::uint8_t {
  kConsidered = 0,  ///< the plan stays out, or there is no group ahead
  kClaimed = 1,     ///< the plan leads in, its fail-safe still stops before
  kCommitted = 2,   ///< the fail-safe in force passes the group
  kCleared = 3,     ///< we have passed it
  kWithdrawn = 4,   ///< claimed, and given up
};

/// CORE-078 What was decided travels with the plan that does it, and is taken back with it: how all manoeuvres stand, and
/// for how long they have.
struct ManoeuvreState {
  LaneChange lane_change = LaneChange::kKeep;
  std::int8_t side = 0;  ///< 1: the change leads to the left, -1: to the right, 0: there is none
  RequiredChange required_change = RequiredChange::kNone;
  ZoneClaim zone_claim = ZoneClaim::kConsidered;
  std::uint16_t lane_change_ms = 0;  ///< since that became so; at most a minute
  std::uint16_t required_change_ms = 0;
  std::uint16_t zone_claim_ms = 0;
  std::int16_t zone_lane = 0;  ///< slot of the lane crossed last in the group claimed
};

/// Whether every part is one of the states above.
[[nodiscard]] constexpr bool is_known(const ManoeuvreState& state) {
  return state.lane_change <= LaneChange::kSettle && state.side >= -1 && state.side <= 1 &&
         state.required_change <= RequiredChange::kWaiting && state.zone_claim <= ZoneClaim::kWithdrawn;
}

}  // namespace s4tp
