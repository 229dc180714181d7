#pragma once
/// The car on the bus: publishes its motion, steering and pose, and obeys command frames.

#include <cstdint>
#include <deque>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "firmware/wire/frame.hpp"
#include "sim_host/world/nodes/vehicle.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::nodes {

/// Errors of the car's own sensors, as standard deviations; the wire quantises in any case.
struct SensorOptions {
  double speed_noise_mps = 0.0;
  double acceleration_noise_mps2 = 0.0;
  double yaw_rate_noise_radps = 0.0;
  double steering_noise_rad = 0.0;
  double position_noise_m = 0.0;
  double heading_noise_rad = 0.0;
  int pose_latency_ticks = 0;  ///< 0 .. 7, shown in the frame's age
};

class VehicleNode {
 public:
  /// \param origin  of the odometry frame, network coordinates
  VehicleNode(const SensorOptions& sensors, map::Vec2 origin, std::uint64_t seed);

  [[nodiscard]] Vehicle& vehicle() { return vehicle_; }
  [[nodiscard]] const Vehicle& vehicle() const { return vehicle_; }

  /// WORLD-002 A command counts only while its end-to-end state is trusted; anything else changes nothing.
  void receive(const wire::Frame& frame);
  /// 10 ms of driving as commanded. WORLD-003 Without a valid command for 100 ms the car brakes by itself
  /// with 4 m/s^2 and holds its steering.
  void drive();
  /// Ends a tick in which the car was moved by other means.
  void idle();

  /// Appends Motion and Steering, and Pose in every second tick. WORLD-004
  void publish(std::uint32_t vehicle_time_ms, bool engaged, std::vector<wire::Frame>& frames);

  /// Ticks since the last frame that looked like a command, whatever its protection said.
  [[nodiscard]] int silent_ticks() const { return silent_ticks_; }

 private:
  void end_of_tick();

  struct TimedPose {
    map::Vec2 rear_axle;
    double heading_rad = 0.0;
  };
  Vehicle vehicle_;
  SensorOptions sensors_;
  map::Vec2 origin_;
  traffic::Random random_;
  std::deque<TimedPose> poses_;  ///< oldest first, as many as the latency asks for
  wire::E2eReceiver command_receiver_;
  wire::E2eSender motion_sender_;
  wire::E2eSender steering_sender_;
  wire::E2eSender pose_sender_;
  double acceleration_mps2_ = 0.0;
  double steering_rad_ = 0.0;
  bool arrived_ = false;
  int silent_ticks_ = 0;
  int command_age_ticks_ = 0;
};

}  // namespace s4tp::nodes
