#include "sim_host/faults/lies.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "sim_host/faults/sender_faults.hpp"

namespace s4tp::faults {
namespace {

constexpr float kTick_s = 0.01F;
constexpr float kDrift_mps = 1.0F;
constexpr float kHeadingDrift_radps = 0.05F;
constexpr float kJump_m = 1.4F;

void tell(Lie lie, float, wire::Motion& motion) {
  switch (lie) {
    case Lie::kYawRate:
      motion.yaw_rate_radps = std::min(2.0F, motion.yaw_rate_radps + 0.5F);
      break;
    case Lie::kAcceleration:
      motion.acceleration_mps2 = std::min(20.0F, motion.acceleration_mps2 + 20.0F);
      break;
    case Lie::kBraking:
      motion.acceleration_mps2 = std::max(-20.0F, motion.acceleration_mps2 - 20.0F);
      break;
    case Lie::kSpeedLow:
      motion.speed_mps *= 0.9F;
      break;
    case Lie::kSpeedHigh:
      motion.speed_mps *= 1.2F;
      break;
    case Lie::kSpeedZero:
      motion.speed_mps = 0.0F;
      motion.acceleration_mps2 = 0.0F;
      break;
    default:
      break;
  }
}

void tell(Lie lie, float, wire::Steering& steering) {
  if (lie == Lie::kSteeringFar) steering.steering_rad = 3.0F;
  if (lie == Lie::kSteeringOff) steering.steering_rad = std::min(3.0F, steering.steering_rad + 0.1F);
}

void tell(Lie lie, float since_s, wire::Pose& pose) {
  float ahead_m = 0.0F;
  float left_m = 0.0F;
  if (lie == Lie::kDriftAlong) ahead_m = kDrift_mps * since_s;
  if (lie == Lie::kDriftAcross) left_m = kDrift_mps * since_s;
  if (lie == Lie::kJumpAlong) ahead_m = kJump_m;
  if (lie == Lie::kJumpAcross) left_m = kJump_m;
  const float c = std::cos(pose.heading_rad);
  const float s = std::sin(pose.heading_rad);
  pose.x_m = std::clamp(pose.x_m + ahead_m * c - left_m * s, -1310.0F, 1310.0F);
  pose.y_m = std::clamp(pose.y_m + ahead_m * s + left_m * c, -1310.0F, 1310.0F);
  if (lie == Lie::kHeadingDrift) {
    const float turned_rad = pose.heading_rad + kHeadingDrift_radps * since_s;
    pose.heading_rad = std::clamp(std::remainder(turned_rad, 6.2831853F), -3.1412F, 3.1412F);
  }
}

template <class Message>
void tell_in(Lie lie, float since_s, wire::Frame& frame) {
  Message message;
  if (!wire::decode(frame, message)) return;
  tell(lie, since_s, message);
  const std::uint8_t counter = frame.data[1] & 0x0FU;
  if (!wire::encode(message, frame)) return;
  frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) | counter);
  wire::e2e_seal(frame);
}

}  // namespace

const char* lie_name(Lie lie) {
  constexpr std::array<const char*, kLies> kNames{"pose drifts ahead, 1 m/s",
                                                  "pose drifts aside, 1 m/s",
                                                  "heading drifts, 0.05 rad/s",
                                                  "pose jumps ahead, 1.4 m",
                                                  "pose jumps aside, 1.4 m",
                                                  "yaw rate + 0.5 rad/s",
                                                  "acceleration + 20 m/s^2",
                                                  "acceleration - 20 m/s^2",
                                                  "steering 3 rad",
                                                  "steering + 0.1 rad",
                                                  "speed x 0.9",
                                                  "speed x 1.2",
                                                  "speed and acceleration 0",
                                                  "clock 10 % fast"};
  return kNames.at(static_cast<std::size_t>(lie));
}

void tell_lie(const Fault& fault, int tick, wire::Frame& frame) {
  const auto lie = static_cast<Lie>(fault.intensity);
  if (lie == Lie::kFastClock) {
    Fault late = fault;
    late.kind = FaultKind::kLateMotion;
    late.intensity = 1;
    shift_clock(late, tick, frame);
    return;
  }
  const float since_s = kTick_s * static_cast<float>(tick - fault.from_tick + 1);
  if (frame.id == wire::kMotionId) tell_in<wire::Motion>(lie, since_s, frame);
  if (frame.id == wire::kSteeringId) tell_in<wire::Steering>(lie, since_s, frame);
  if (frame.id == wire::kPoseId) tell_in<wire::Pose>(lie, since_s, frame);
}

}  // namespace s4tp::faults
