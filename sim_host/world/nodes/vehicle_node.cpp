#include "sim_host/world/nodes/vehicle_node.hpp"

#include <algorithm>
#include <numbers>

#include "sim_host/world/nodes/append_frame.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::nodes {
namespace {

constexpr int kCommandAgeMax_ticks = 10;
constexpr double kFallbackBraking_mps2 = 4.0;

float clamped(double value, double low, double high) {
  return static_cast<float>(std::clamp(value, low, high));
}

}  // namespace

VehicleNode::VehicleNode(const SensorOptions& sensors, map::Vec2 origin, std::uint64_t seed)
    : sensors_(sensors), origin_(origin), random_(seed) {}

void VehicleNode::receive(const wire::Frame& frame) {
  if (frame.id != wire::kCommandId) {
    return;
  }
  arrived_ = true;
  wire::Command command;
  if (!wire::E2eReceiver::trusted(command_receiver_.check(frame)) || !wire::decode(frame, command)) {
    return;
  }
  command_age_ticks_ = 0;
  acceleration_mps2_ = static_cast<double>(command.acceleration_mps2);
  steering_rad_ = static_cast<double>(command.steering_rad);
}

void VehicleNode::drive() {
  const bool obeys = command_age_ticks_ < kCommandAgeMax_ticks;
  for (int millisecond = 0; millisecond < 10; ++millisecond) {
    vehicle_.step(obeys ? acceleration_mps2_ : -kFallbackBraking_mps2, steering_rad_);
  }
  end_of_tick();
}

void VehicleNode::idle() {
  end_of_tick();
}

void VehicleNode::end_of_tick() {
  if (!arrived_) {
    command_receiver_.nothing_arrived();
  }
  silent_ticks_ = arrived_ ? 0 : std::min(silent_ticks_ + 1, 1'000'000);
  arrived_ = false;
  command_age_ticks_ = std::min(command_age_ticks_ + 1, kCommandAgeMax_ticks);
}

void VehicleNode::publish(std::uint32_t vehicle_time_ms, bool engaged, std::vector<wire::Frame>& frames) {
  const auto noisy = [this](double value, double deviation) {
    return deviation > 0.0 ? random_.normal(value, deviation) : value;
  };
  wire::Motion motion;
  motion.vehicle_time_ms = static_cast<std::uint16_t>(vehicle_time_ms & 0xFFFFU);
  motion.speed_mps = clamped(noisy(vehicle_.speed_mps(), sensors_.speed_noise_mps), 0.0, 81.0);
  motion.acceleration_mps2 =
      clamped(noisy(vehicle_.acceleration_mps2(), sensors_.acceleration_noise_mps2), -20.0, 20.0);
  motion.yaw_rate_radps = clamped(noisy(vehicle_.yaw_rate_radps(), sensors_.yaw_rate_noise_radps), -2.0, 2.0);
  append(motion, motion_sender_, frames);

  wire::Steering steering;
  steering.steering_rad = clamped(noisy(vehicle_.steering_rad(), sensors_.steering_noise_rad), -3.0, 3.0);
  steering.engage = engaged;
  steering.driver_override = false;
  append(steering, steering_sender_, frames);

  poses_.push_back({vehicle_.rear_axle(), vehicle_.heading_rad()});
  while (static_cast<int>(poses_.size()) > std::clamp(sensors_.pose_latency_ticks, 0, 7) + 1) {
    poses_.pop_front();
  }
  if (vehicle_time_ms % 20 == 0) {
    wire::Pose pose;
    pose.x_m =
        clamped(noisy(poses_.front().rear_axle.x - origin_.x, sensors_.position_noise_m), -1310.0, 1310.0);
    pose.y_m =
        clamped(noisy(poses_.front().rear_axle.y - origin_.y, sensors_.position_noise_m), -1310.0, 1310.0);
    pose.heading_rad = clamped(map::wrap_angle(noisy(poses_.front().heading_rad, sensors_.heading_noise_rad)),
                               -3.1412, 3.1412);
    pose.age_10ms = static_cast<std::uint8_t>(poses_.size() - 1);
    append(pose, pose_sender_, frames);
  }
}

}  // namespace s4tp::nodes
