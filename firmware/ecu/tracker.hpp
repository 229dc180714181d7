#pragma once
/// Tracking controller: makes the car do what the plan says, a hundred times a second.
///
/// \code
///   across   by place:  plan's curvature ahead by the steering's delay - feedback on offset and heading
///   along    by time:   plan's acceleration ahead by the drive's delay - feedback on station and speed
/// \endcode
/// Across, the error falls over a way, not a time, so the same law holds at walking pace and on the road:
/// with s along the path, offset'' = -offset / w^2 - 2 offset' / w, w = max(convergence_m, v convergence_s).

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/world_state.hpp"
#include "firmware/gate/command_gate.hpp"

namespace s4tp::ecu {

/// How far the car is from the plan's point of this instant, in that point's frame.
struct TrackingError {
  float along_m = 0.0F;  ///< ahead positive
  float cross_m = 0.0F;  ///< left positive
  float distance_m = 0.0F;
};

class Tracker {
 public:
  /// Forgets the past. \param acceleration_mps2  what the car does now: commands start from there
  void reset(float acceleration_mps2);

  /// Follows the plan. ECU-050 A plan that stands is held with the brake; leaving a standstill, and building up
  /// drive, acceleration rises by at most 10 m/s^3; on the way brakes are released by at most 20, as the gate
  /// lets through. ECU-051 Integrators learn a bias (a slope, a steering offset) only near the plan, and stop
  /// where the actuator or they themselves saturate. ECU-052 Past its end a plan is followed by stop(). ECU-095
  /// So is a plan to drive past its fail-safe's branch: by then a new one was to be there.
  [[nodiscard]] gate::Command follow(const Plan& plan, std::uint32_t now_ms, const EgoState& ego,
                                     const Parameters& parameters);

  /// ECU-053 Brakes to a standstill along the path of `last`, at least with safety.minimum_risk_braking, as
  /// hard as its fail-safe and as hard as the plan itself does; without a plan, or further than 3 m beside
  /// it, with the present steering. ECU-054 Does not ease off at a standstill: what says that the car stands
  /// may be what failed.
  [[nodiscard]] gate::Command stop(const Plan& last, const EgoState& ego, const Parameters& parameters);

  /// ECU-106 Drives the fail-safe of `plan`: follow() up to its branch, then stop().
  [[nodiscard]] gate::Command drive_fail_safe(const Plan& plan, std::uint32_t now_ms, const EgoState& ego,
                                              const Parameters& parameters);

  /// Of the last follow(); all zero after anything else.
  [[nodiscard]] const TrackingError& error() const { return error_; }

 private:
  [[nodiscard]] float steer(const Plan& plan, const EgoState& ego, const Parameters& parameters);
  [[nodiscard]] float drive(const Plan& plan, std::uint32_t now_ms, const EgoState& ego,
                            const Parameters& parameters);

  TrackingError error_;
  float curvature_trim_1pm_ = 0.0F;      ///< integrator across
  float acceleration_trim_mps2_ = 0.0F;  ///< integrator along
  float acceleration_mps2_ = 0.0F;       ///< asked for last
  bool holding_ = false;
};

}  // namespace s4tp::ecu
