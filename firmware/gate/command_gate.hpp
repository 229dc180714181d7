#pragma once
/// Last instance before the actuators: limits as data, denied by default, its own reading of the motion
/// frame. Knows nothing of the planner. Every limit has an id.
///
///   not permitted, or NaN     brake gently, hold the steering
///   motion unknown too long   the same; harder braking passes
///   else                      the command, brought inside the limits
///
/// All limits hold for every output; where two disagree (lateral acceleration asks for less steering than the
/// wheels may turn in one tick) the rate wins and the steering moves towards the other limit.

#include <cstdint>

#include "firmware/wire/frame.hpp"

namespace s4tp::gate {

/// What the actuators may be asked for. The values here are those of the default vehicle.
struct Limits {
  float acceleration_max_mps2 = 3.5F;          ///< GATE-001 drive
  float braking_max_mps2 = 9.0F;               ///< GATE-002 braking, positive; full braking on dry road
  float jerk_up_max_mps3 = 20.0F;              ///< GATE-003 rise of acceleration; braking is not limited
  float steering_max_rad = 0.55F;              ///< GATE-004
  float steering_rate_max_radps = 0.7F;        ///< GATE-005
  float lateral_acceleration_max_mps2 = 6.0F;  ///< GATE-006 v^2 tan(steering) / wheelbase, at its own v
  float wheelbase_m = 2.9F;                    ///< of the vehicle the gate guards
  float speed_max_mps = 40.0F;                 ///< GATE-007 no drive above it
  std::uint8_t motion_age_max_ticks = 10;      ///< GATE-008 without a valid motion frame for longer: brake
  float gentle_braking_mps2 = 3.0F;  ///< what is sent when denied, positive; below skidding on wet road
};

struct Command {
  float acceleration_mps2 = 0.0F;
  float steering_rad = 0.0F;  ///< road-wheel angle, left positive
};

/// Which limits changed the command: bit i set means GATE-(i + 1). Bit 8: denied (GATE-009).
using Violations = std::uint16_t;
inline constexpr Violations kAccelerationLimited = 1U << 0;
inline constexpr Violations kBrakingLimited = 1U << 1;
inline constexpr Violations kJerkLimited = 1U << 2;
inline constexpr Violations kSteeringLimited = 1U << 3;
inline constexpr Violations kSteeringRateLimited = 1U << 4;
inline constexpr Violations kLateralLimited = 1U << 5;
inline constexpr Violations kSpeedLimited = 1U << 6;
inline constexpr Violations kMotionStale = 1U << 7;
inline constexpr Violations kDenied = 1U << 8;     ///< GATE-009 not permitted: gentle braking, steering held
inline constexpr Violations kNotFinite = 1U << 9;  ///< GATE-010 NaN or infinite: treated as denied

class CommandGate {
 public:
  explicit CommandGate(const Limits& limits) : limits_(limits) {}

  /// GATE-013 Another vehicle's limits from now on, if each is in the range of road vehicles
  /// (command_gate.cpp); else nothing changes. \return whether they are in force
  [[nodiscard]] bool set_limits(const Limits& limits);

  /// GATE-011 Shows the gate a raw frame from the bus; it picks and verifies the motion frame by itself: a
  /// wrong CRC or a repeated counter is no news.
  void observe(const wire::Frame& frame);

  /// One call per control tick. \param permitted  the ECU's mode allows driving
  /// \param command  in: asked for; out: what may be sent
  [[nodiscard]] Violations apply(bool permitted, Command& command);

  /// GATE-012 Limits of rise and rate count from here on from the steering that is physically there and the
  /// acceleration the gate has read itself.
  void reset(float steering_rad);

 private:
  Limits limits_;
  Command last_;
  float speed_mps_ = 0.0F;
  float acceleration_mps2_ = 0.0F;
  std::uint16_t motion_age_ticks_ = 0xFFFF;  ///< of the newest motion frame; saturates
  std::uint8_t last_counter_ = 0xFF;
};

}  // namespace s4tp::gate
