#pragma once
/// Lies of the vehicle's own sensors: plausible values, wrong, and sealed. Each is one intensity of
/// FaultKind::kLie.

#include "firmware/wire/frame.hpp"
#include "sim_host/faults/script.hpp"

namespace s4tp::faults {

enum class Lie : std::uint8_t {
  kDriftAlong,    ///< pose runs ahead by 1 m/s
  kDriftAcross,   ///< pose runs to the left by 1 m/s
  kHeadingDrift,  ///< heading turns by 0.05 rad/s
  kJumpAlong,     ///< pose 1.4 m ahead, at once
  kJumpAcross,    ///< pose 1.4 m to the left, at once
  kYawRate,       ///< + 0.5 rad/s
  kAcceleration,  ///< + 20 m/s^2
  kBraking,       ///< - 20 m/s^2
  kSteeringFar,   ///< 3 rad
  kSteeringOff,   ///< + 0.1 rad
  kSpeedLow,      ///< 0.9 of it
  kSpeedHigh,     ///< 1.2 of it
  kSpeedZero,     ///< 0, acceleration too
  kFastClock,     ///< stamps run 10 % fast
};
inline constexpr int kLies = 14;
[[nodiscard]] const char* lie_name(Lie lie);

/// What becomes of a frame of Motion, Steering, Pose or TrackList; others stay as they are.
void tell_lie(const Fault& fault, int tick, wire::Frame& frame);

}  // namespace s4tp::faults
