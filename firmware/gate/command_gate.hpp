#pragma once
/// Last instance before the actuators: limits as data, denied by default, its own reading of the motion
/// frame. Knows nothing of the planner. Pure functions on a small state; every limit has an id.

#include <cstdint>

#include "firmware/wire/frame.hpp"

namespace s4tp::gate {

/// What the actuators may be asked for. Sources stand beside the numbers.
struct Limits {
  float acceleration_max_mps2 = 3.5F;    ///< GATE-001 drive
  float braking_max_mps2 = 9.0F;         ///< GATE-002 braking, positive
  float jerk_up_max_mps3 = 20.0F;        ///< GATE-003 rise of acceleration; braking harder is not limited
  float steering_max_rad = 0.55F;        ///< GATE-004
  float steering_rate_max_radps = 0.7F;  ///< GATE-005
  float lateral_acceleration_max_mps2 =
      6.0F;  ///< GATE-006 v^2 tan(delta) / L, at the gate's own reading of v
  float wheelbase_m = 2.9F;
  float speed_max_mps = 40.0F;             ///< GATE-007 no drive above it
  std::uint8_t motion_age_max_ticks = 10;  ///< GATE-008 without a valid motion frame for longer: only braking
};

struct Command {
  float acceleration_mps2 = 0.0F;
  float steering_rad = 0.0F;
};

/// Which limits changed the command: bit i set means GATE-(i + 1). Bit 8: denied (GATE-009).
using Violations = std::uint16_t;
inline constexpr Violations kDenied = 1U << 8;     ///< GATE-009 not permitted: gentle braking, steering held
inline constexpr Violations kNotFinite = 1U << 9;  ///< GATE-010 NaN or infinite: treated as denied

class CommandGate {
 public:
  explicit CommandGate(const Limits& limits) : limits_(limits) {}

  /// Shows the gate a raw frame from the bus; it picks and verifies the motion frame by itself.
  void observe(const wire::Frame& frame);

  /// One call per control tick. \param permitted  the ECU's mode allows driving
  /// \param command  in: asked for; out: what may be sent
  Violations apply(bool permitted, Command& command);

  /// The steering that is physically there when the gate takes over.
  void reset(float steering_rad);

 private:
  Limits limits_;
  Command last_;
  float speed_mps_ = 0.0F;
  std::uint16_t motion_age_ticks_ = 0xFFFF;
  std::uint8_t last_counter_ = 0xFF;
};

}  // namespace s4tp::gate
