#include "sim_host/world/nodes/vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::nodes {
namespace {

constexpr double kStep_s = 0.001;
constexpr double kGravity_mps2 = 9.81;
constexpr double kCreep_mps = 0.01;  // below it, without drive, the car holds

double side_force(double slip_rad, double stiffness_npr, double limit_n) {
  return limit_n * std::tanh(stiffness_npr * slip_rad / limit_n);
}

}  // namespace

void Vehicle::place(map::Vec2 box_centre, double heading_rad, double speed_mps, double yaw_rate_radps) {
  const VehicleParameters& p = parameters_;
  heading_rad_ = heading_rad;
  speed_mps_ = speed_mps;
  acceleration_mps2_ = drive_mps2_ = 0.0;
  // Slips of the linear single-track model in a steady turn, on either axle as much as its share of the weight asks for.
  const double rear_axle_m = p.wheelbase_m - p.front_axle_m;
  const double side_n = p.mass_kg * speed_mps * yaw_rate_radps;
  const double front_slip_rad = side_n * rear_axle_m / p.wheelbase_m / p.front_stiffness_npr;
  const double rear_slip_rad = side_n * p.front_axle_m / p.wheelbase_m / p.rear_stiffness_npr;
  yaw_rate_radps_ = yaw_rate_radps;
  side_speed_mps_ = rear_axle_m * yaw_rate_radps - speed_mps * rear_slip_rad;
  const double turn_rad = speed_mps > 0.0 ? std::atan(p.wheelbase_m * yaw_rate_radps / speed_mps) : 0.0;
  steering_rad_ =
      std::clamp(turn_rad + front_slip_rad - rear_slip_rad, -p.steering_max_rad, p.steering_max_rad);
  gravity_centre_ = {0.0, 0.0};
  const map::Vec2 offset = this->box_centre();
  gravity_centre_ = {box_centre.x - offset.x, box_centre.y - offset.y};
}

map::Vec2 Vehicle::ahead_of_gravity_centre(double along_m) const {
  return {gravity_centre_.x + along_m * std::cos(heading_rad_),
          gravity_centre_.y + along_m * std::sin(heading_rad_)};
}

map::Vec2 Vehicle::rear_axle() const {
  return ahead_of_gravity_centre(parameters_.front_axle_m - parameters_.wheelbase_m);
}

map::Vec2 Vehicle::box_centre() const {
  return ahead_of_gravity_centre(parameters_.front_axle_m - parameters_.wheelbase_m -
                                 parameters_.rear_overhang_m + 0.5 * parameters_.length_m);
}

void Vehicle::actuate(double acceleration_mps2, double steering_rad) {
  const VehicleParameters& p = parameters_;
  const double drive_wanted = std::clamp(acceleration_mps2, -p.braking_max_mps2, p.acceleration_max_mps2);
  drive_mps2_ +=
      kStep_s * std::clamp((drive_wanted - drive_mps2_) / p.drive_lag_s, -p.jerk_max_mps3, p.jerk_max_mps3);
  const double steering_wanted = std::clamp(steering_rad, -p.steering_max_rad, p.steering_max_rad);
  steering_rad_ += kStep_s * std::clamp((steering_wanted - steering_rad_) / p.steering_lag_s,
                                        -p.steering_rate_max_radps, p.steering_rate_max_radps);
}

void Vehicle::stand() {
  speed_mps_ = side_speed_mps_ = yaw_rate_radps_ = acceleration_mps2_ = 0.0;
}

void Vehicle::step(double acceleration_mps2, double steering_rad) {
  const VehicleParameters& p = parameters_;
  actuate(acceleration_mps2, steering_rad);
  if (speed_mps_ < kCreep_mps && drive_mps2_ <= 0.0) {
    stand();
    return;
  }
  const double rear_axle_m = p.wheelbase_m - p.front_axle_m;
  const double grip_mps2 = p.friction * kGravity_mps2;
  const double side_mps2 = std::min(std::abs(speed_mps_ * yaw_rate_radps_), 0.95 * grip_mps2);
  const double drive_limit_mps2 =
      std::sqrt(grip_mps2 * grip_mps2 - side_mps2 * side_mps2);  // friction circle
  double along_mps2 = std::clamp(drive_mps2_, -drive_limit_mps2, drive_limit_mps2);

  const double kinematic_yaw_radps = speed_mps_ * std::tan(steering_rad_) / p.wheelbase_m;
  const double dynamic = std::clamp(
      (speed_mps_ - p.kinematic_below_mps) / (p.dynamic_above_mps - p.kinematic_below_mps), 0.0, 1.0);
  if (dynamic > 0.0) {
    const double weight_n = p.mass_kg * kGravity_mps2;
    const double front_slip_rad =
        steering_rad_ - std::atan2(side_speed_mps_ + p.front_axle_m * yaw_rate_radps_, speed_mps_);
    const double rear_slip_rad = -std::atan2(side_speed_mps_ - rear_axle_m * yaw_rate_radps_, speed_mps_);
    const double front_n = side_force(front_slip_rad, p.front_stiffness_npr,
                                      p.friction * weight_n * rear_axle_m / p.wheelbase_m);
    const double rear_n = side_force(rear_slip_rad, p.rear_stiffness_npr,
                                     p.friction * weight_n * p.front_axle_m / p.wheelbase_m);
    const double turned_front_n = front_n * std::cos(steering_rad_);
    along_mps2 -= dynamic * front_n * std::sin(steering_rad_) / p.mass_kg;
    side_speed_mps_ += kStep_s * ((turned_front_n + rear_n) / p.mass_kg - speed_mps_ * yaw_rate_radps_);
    yaw_rate_radps_ +=
        kStep_s * (p.front_axle_m * turned_front_n - rear_axle_m * rear_n) / p.yaw_inertia_kgm2;
  }
  yaw_rate_radps_ += (1.0 - dynamic) * (kinematic_yaw_radps - yaw_rate_radps_);
  side_speed_mps_ += (1.0 - dynamic) * (rear_axle_m * kinematic_yaw_radps - side_speed_mps_);

  acceleration_mps2_ = along_mps2;
  speed_mps_ += kStep_s * along_mps2;
  if (speed_mps_ <= 0.0) {
    stand();
    return;
  }
  heading_rad_ = map::wrap_angle(heading_rad_ + kStep_s * yaw_rate_radps_);
  const double c = std::cos(heading_rad_);
  const double s = std::sin(heading_rad_);
  gravity_centre_.x += kStep_s * (speed_mps_ * c - side_speed_mps_ * s);
  gravity_centre_.y += kStep_s * (speed_mps_ * s + side_speed_mps_ * c);
}

}  // namespace s4tp::nodes
