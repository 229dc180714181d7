#include "firmware/gate/command_gate.hpp"

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::gate {
namespace {

constexpr float kTickS = 0.01F;
constexpr std::uint16_t kNever = 0xFFFF;

/// What a limit may be; nothing is for NaN.
struct Range {
  float Limits::*limit;
  float least;
  float most;
};
constexpr Range kRoadVehicle[] = {
    {&Limits::acceleration_max_mps2, 0.5F, 8.0F},
    {&Limits::braking_max_mps2, 3.0F, 12.0F},
    {&Limits::jerk_up_max_mps3, 5.0F, 50.0F},
    {&Limits::steering_max_rad, 0.1F, 0.8F},
    {&Limits::steering_rate_max_radps, 0.05F, 2.5F},
    {&Limits::lateral_acceleration_max_mps2, 1.0F, 9.0F},
    {&Limits::wheelbase_m, 1.0F, 8.0F},
    {&Limits::speed_max_mps, 5.0F, 60.0F},
    {&Limits::gentle_braking_mps2, 1.0F, 5.0F},
};
constexpr std::uint8_t kMotionAgeMostTicks = 20;

/// False for NaN and infinity too: no command of a car comes near the bound.
bool is_finite(float x) {
  return x >= -1e6F && x <= 1e6F;
}

/// `value` brought down to `bound`; notes it.
float at_most(float value, float bound, Violations limit, Violations& violations) {
  if (value <= bound) return value;
  violations = static_cast<Violations>(violations | limit);
  return bound;
}

float at_least(float value, float bound, Violations limit, Violations& violations) {
  return -at_most(-value, -bound, limit, violations);
}

float within(float value, float bound, Violations limit, Violations& violations) {
  return at_most(at_least(value, -bound, limit, violations), bound, limit, violations);
}

/// Largest steering angle with v^2 tan(angle) / L <= limit, a little less in fact: 3m / (3 + m^2) < atan(m).
float lateral_bound(const Limits& limits, float speed_mps) {
  const float numerator = limits.lateral_acceleration_max_mps2 * limits.wheelbase_m;
  const float speed_squared = speed_mps * speed_mps;
  if (numerator >= 1.7F * speed_squared) return limits.steering_max_rad;  // the bound's top is at m = sqrt(3)
  const float slope = numerator / speed_squared;
  return 3.0F * slope / (3.0F + slope * slope);
}

}  // namespace

bool CommandGate::set_limits(const Limits& limits) {
  for (const Range& range : kRoadVehicle) {
    const float limit = limits.*range.limit;
    if (!(limit >= range.least && limit <= range.most)) return false;
  }
  if (limits.motion_age_max_ticks > kMotionAgeMostTicks) return false;
  limits_ = limits;
  return true;
}

void CommandGate::observe(const wire::Frame& frame) {
  if (frame.id != wire::kMotionId || !wire::e2e_crc_fits(frame)) return;
  wire::Motion motion;
  if (!wire::decode(frame, motion)) return;
  const auto counter = static_cast<std::uint8_t>(frame.data[1] & 0x0FU);
  if (counter == last_counter_) return;
  last_counter_ = counter;
  speed_mps_ = motion.speed_mps;
  acceleration_mps2_ = motion.acceleration_mps2;
  motion_age_ticks_ = 0;
}

Violations CommandGate::apply(bool permitted, Command& command) {
  Violations violations = 0;
  const bool finite = is_finite(command.acceleration_mps2) && is_finite(command.steering_rad);
  const bool stale = motion_age_ticks_ > limits_.motion_age_max_ticks;
  if (motion_age_ticks_ != kNever) ++motion_age_ticks_;

  if (!finite) violations = kNotFinite;
  if (stale) violations = static_cast<Violations>(violations | kMotionStale);
  if (!permitted || !finite) {
    violations = static_cast<Violations>(violations | kDenied);
    command = {-limits_.gentle_braking_mps2, last_.steering_rad};
  } else if (stale) {
    const bool harder = command.acceleration_mps2 < -limits_.gentle_braking_mps2;
    command = {harder ? command.acceleration_mps2 : -limits_.gentle_braking_mps2, last_.steering_rad};
  }

  float& acceleration = command.acceleration_mps2;
  acceleration = at_most(acceleration, limits_.acceleration_max_mps2, kAccelerationLimited, violations);
  acceleration = at_least(acceleration, -limits_.braking_max_mps2, kBrakingLimited, violations);
  if (speed_mps_ > limits_.speed_max_mps)
    acceleration = at_most(acceleration, 0.0F, kSpeedLimited, violations);
  acceleration = at_most(acceleration, last_.acceleration_mps2 + limits_.jerk_up_max_mps3 * kTickS,
                         kJerkLimited, violations);

  float& steering = command.steering_rad;
  steering = within(steering, limits_.steering_max_rad, kSteeringLimited, violations);
  steering = within(steering, lateral_bound(limits_, speed_mps_), kLateralLimited, violations);
  const float step = limits_.steering_rate_max_radps * kTickS;
  steering = at_most(steering, last_.steering_rad + step, kSteeringRateLimited, violations);
  steering = at_least(steering, last_.steering_rad - step, kSteeringRateLimited, violations);

  last_ = command;
  return violations;
}

void CommandGate::reset(float steering_rad) {
  Violations ignored = 0;
  last_.steering_rad =
      is_finite(steering_rad) ? within(steering_rad, limits_.steering_max_rad, 0, ignored) : 0.0F;
  last_.acceleration_mps2 = at_least(at_most(acceleration_mps2_, limits_.acceleration_max_mps2, 0, ignored),
                                     -limits_.braking_max_mps2, 0, ignored);
}

}  // namespace s4tp::gate
