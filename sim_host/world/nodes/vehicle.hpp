#pragma once
/// The virtual car: a nonlinear single-track model with tyre forces behind actuators with lag, rate and
/// saturation.
///
/// \code
///      rear axle o------ b ------+--- a ---o front axle, at the road-wheel angle
///   |<- overhang ->|         centre of gravity
/// \endcode
/// Each axle's side force is mu Fz tanh(C alpha / (mu Fz)); load transfer is left out. At walking pace slip
/// angles lose their meaning, so there the kinematic single track takes over, blended in between.
/// Source: Rajamani, Vehicle Dynamics and Control, chapter 2 (single track); tanh saturation for the tyre.

#include "sim_host/world/map/polyline.hpp"

namespace s4tp::nodes {

struct VehicleParameters {
  double wheelbase_m = 2.9;
  double front_axle_m = 1.35;  ///< from the centre of gravity
  double length_m = 5.0;
  double width_m = 1.8;
  double rear_overhang_m = 1.0;  ///< rear bumper to rear axle
  double mass_kg = 1600.0;
  double yaw_inertia_kgm2 = 2600.0;
  double front_stiffness_npr = 90000.0;  ///< N/rad, the whole axle
  double rear_stiffness_npr = 90000.0;
  double friction = 0.9;
  double kinematic_below_mps = 1.0;  ///< purely kinematic
  double dynamic_above_mps = 3.0;    ///< purely dynamic
  double steering_max_rad = 0.55;
  double steering_rate_max_radps = 0.7;
  double steering_lag_s = 0.08;
  double acceleration_max_mps2 = 3.5;
  double braking_max_mps2 = 9.0;
  double drive_lag_s = 0.15;
  double jerk_max_mps3 = 40.0;  ///< of drive and brake together
};

class Vehicle {
 public:
  explicit Vehicle(const VehicleParameters& parameters = {}) : parameters_(parameters) {}

  /// Sets the car down with its box centre there, rolling along a circle at `yaw_rate_radps`, wheels turned for it.
  void place(map::Vec2 box_centre, double heading_rad, double speed_mps, double yaw_rate_radps = 0.0);

  /// WORLD-001 One millisecond towards the commanded acceleration and road-wheel angle. At a standstill the
  /// car stays exactly where it is until drive is applied; it never rolls backwards.
  void step(double acceleration_mps2, double steering_rad);

  [[nodiscard]] const VehicleParameters& parameters() const { return parameters_; }
  [[nodiscard]] map::Vec2 rear_axle() const;
  [[nodiscard]] map::Vec2 box_centre() const;
  [[nodiscard]] double heading_rad() const { return heading_rad_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }  ///< along the car, at the rear axle
  [[nodiscard]] double acceleration_mps2() const { return acceleration_mps2_; }
  [[nodiscard]] double yaw_rate_radps() const { return yaw_rate_radps_; }
  [[nodiscard]] double steering_rad() const { return steering_rad_; }

 private:
  void actuate(double acceleration_mps2, double steering_rad);
  void stand();
  [[nodiscard]] map::Vec2 ahead_of_gravity_centre(double along_m) const;

  VehicleParameters parameters_;
  map::Vec2 gravity_centre_;
  double heading_rad_ = 0.0;
  double speed_mps_ = 0.0;
  double side_speed_mps_ = 0.0;  ///< at the centre of gravity, left positive
  double yaw_rate_radps_ = 0.0;
  double acceleration_mps2_ = 0.0;
  double drive_mps2_ = 0.0;  ///< what drive and brake deliver
  double steering_rad_ = 0.0;
};

}  // namespace s4tp::nodes
