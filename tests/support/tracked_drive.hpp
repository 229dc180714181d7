#pragma once
/// The tracker on a plant, along plans that are pieces of a script.

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "firmware/ecu/tracker.hpp"
#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {

/// Where a scripted drive wants the car at a time.
using DriveScript = std::function<TrajectoryPoint(double time_s)>;

inline Plan plan_of(const DriveScript& script, std::uint32_t start_ms) {
  Plan plan;
  plan.kind = PlanKind::kDrive;
  plan.start_ms = start_ms;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    plan.trajectory.points[i] = script(0.001 * start_ms + 0.1 * i);
  }
  return plan;
}

/// Tracker, gate-less, on the plant; a new plan every 100 ms, each a piece of the script.
class TrackedDrive {
 public:
  explicit TrackedDrive(DriveScript script) : script_(std::move(script)) {
    parameters.tracking.understeer = parameters.tracking.rear_slip = 0.0F;  // the plant's tyres do not slip
  }

  void run(double duration_s) {
    for (int i = 0; i < static_cast<int>(duration_s * 100.0 + 0.5); ++i) {
      if (now_ms % 100 == 0) plan = plan_of(script_, now_ms);
      EgoState ego;
      ego.rear_axle = {static_cast<float>(plant.x_m), static_cast<float>(plant.y_m),
                       static_cast<float>(plant.heading_rad)};
      ego.speed_mps = static_cast<float>(plant.speed_mps);
      ego.acceleration_mps2 = static_cast<float>(plant.acceleration_mps2);
      ego.yaw_rate_radps = static_cast<float>(plant.yaw_rate_radps);
      ego.steering_rad = static_cast<float>(plant.steering_rad);
      const gate::Command last = command;
      command = tracker.follow(plan, now_ms, ego, parameters);
      worst_cross_m = std::max(worst_cross_m, std::abs(tracker.error().cross_m));
      worst_along_m = std::max(worst_along_m, std::abs(tracker.error().along_m));
      worst_rise_mps3 =
          std::max(worst_rise_mps3, 100.0F * (command.acceleration_mps2 - last.acceleration_mps2));
      plant.step(command);
      now_ms += 10;
    }
  }
  void forget() { worst_cross_m = worst_along_m = worst_rise_mps3 = 0.0F; }

  Plant plant;
  Tracker tracker;
  Parameters parameters;
  Plan plan;
  gate::Command command;
  std::uint32_t now_ms = 0;
  float worst_cross_m = 0.0F;
  float worst_along_m = 0.0F;
  float worst_rise_mps3 = 0.0F;

 private:
  DriveScript script_;
};

/// Straight ahead along x with the speed given, from x = 0.
inline DriveScript straight(double speed_mps) {
  return [speed_mps](double time_s) {
    TrajectoryPoint point;
    point.rear_axle.x_m = static_cast<float>(speed_mps * time_s);
    point.speed_mps = static_cast<float>(speed_mps);
    return point;
  };
}

/// 5 m/s: straight for 10 m, a left turn of 90 degrees at 10.7 m radius entered and left over 3 m (clothoid),
/// straight again. Integrated in small steps once.
inline DriveScript left_turn(double speed_mps) {
  const double turn_1pm = 1.0 / 10.7;
  const double ramp_m = 3.0;
  const double arc_m = 1.5707963 / turn_1pm - ramp_m;
  const auto curvature = [=](double s) {
    const double in = s - 10.0;
    if (in <= 0.0) return 0.0;
    if (in < ramp_m) return turn_1pm * in / ramp_m;
    if (in < ramp_m + arc_m) return turn_1pm;
    return std::max(0.0, turn_1pm * (2.0 * ramp_m + arc_m - in) / ramp_m);
  };
  return [=](double time_s) {
    TrajectoryPoint point;
    double x = 0.0;
    double y = 0.0;
    double heading = 0.0;
    const double length_m = speed_mps * time_s;
    const double step_m = 0.01;
    for (double s = 0.0; s < length_m; s += step_m) {
      const double piece_m = std::min(step_m, length_m - s);
      heading += piece_m * curvature(s + 0.5 * piece_m);
      x += piece_m * std::cos(heading);
      y += piece_m * std::sin(heading);
    }
    point.rear_axle = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(heading)};
    point.speed_mps = static_cast<float>(speed_mps);
    point.curvature_1pm = static_cast<float>(curvature(length_m));
    return point;
  };
}

}  // namespace s4tp::ecu
