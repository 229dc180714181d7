#include "sim_host/world/nodes/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace s4tp::nodes {
namespace {

void drive(Vehicle& vehicle, double seconds, double acceleration_mps2, double steering_rad) {
  for (int ms = 0; ms < static_cast<int>(std::lround(seconds * 1000.0)); ++ms) {
    vehicle.step(acceleration_mps2, steering_rad);
  }
}

Vehicle rolling(double speed_mps) {
  Vehicle vehicle;
  vehicle.place({0.0, 0.0}, 0.0, speed_mps);
  return vehicle;
}

/// Speed over yaw rate: the radius driven.
double radius_m(const Vehicle& vehicle) {
  return vehicle.speed_mps() / vehicle.yaw_rate_radps();
}

// Set down by its box centre; the rear axle lies 2.5 - 1.0 = 1.5 m behind it.
TEST(Vehicle, IsPlacedByItsBoxCentre) {
  Vehicle vehicle;
  vehicle.place({10.0, 20.0}, std::acos(0.0), 3.0);
  EXPECT_NEAR(vehicle.box_centre().x, 10.0, 1e-9);
  EXPECT_NEAR(vehicle.box_centre().y, 20.0, 1e-9);
  EXPECT_NEAR(vehicle.rear_axle().y, 18.5, 1e-9);
}

// Set down in a turn it goes on in it, wheels held: at 8 m/s and 0.3 rad/s, 2.4 m/s^2 across, on a circle of 8 / 0.3 = 26.7 m.
TEST(Vehicle, GoesOnInTheTurnItIsPlacedIn) {
  Vehicle vehicle;
  vehicle.place({0.0, 0.0}, 0.0, 8.0, 0.3);
  const double steering_rad = vehicle.steering_rad();
  EXPECT_NEAR(steering_rad, std::atan(2.9 / 26.7) + 0.001226 * 2.4, 0.001);
  for (int ms = 0; ms < 500; ++ms) {
    vehicle.step(0.4 * (8.0 - vehicle.speed_mps()), steering_rad);
    ASSERT_NEAR(vehicle.yaw_rate_radps(), 0.3, 0.01) << ms;
  }
}

// At walking pace the circle is the kinematic one: L / tan(0.3) = 2.9 / 0.30934 = 9.37 m.
TEST(Vehicle, CreepsOnTheKinematicCircle) {
  Vehicle vehicle = rolling(0.8);
  drive(vehicle, 2.0, 0.0, 0.3);
  EXPECT_NEAR(radius_m(vehicle), 9.37, 0.05);
}

// Faster it understeers: K = m / L (b / Cf - a / Cr) = 1600 / 2.9 * (1.55 - 1.35) / 90000 = 0.001226 s^2/m,
// so at 10 m/s and 0.1 rad the radius is about (2.9 + 0.1226) / tan(0.1) = 30.1 m, against 28.9 m kinematic.
TEST(Vehicle, UndersteersOnTheSteadyStateCircle) {
  Vehicle vehicle = rolling(10.0);
  drive(vehicle, 1.0, 0.0, 0.1);
  for (int ms = 0; ms < 3000; ++ms) {
    vehicle.step(0.4 * (10.0 - vehicle.speed_mps()) + 0.35, 0.1);
  }
  const double v = vehicle.speed_mps();
  EXPECT_NEAR(radius_m(vehicle), (2.9 + 0.001226 * v * v) / std::tan(0.1), 0.6);
  EXPECT_GT(radius_m(vehicle), 2.9 / std::tan(0.1));
}

// Tyres saturate: whatever the steering, v times yaw rate stays below mu g = 0.9 * 9.81 = 8.83 m/s^2 once
// settled.
TEST(Vehicle, CannotCornerBeyondItsGrip) {
  Vehicle vehicle = rolling(25.0);
  drive(vehicle, 1.5, 0.0, 0.4);
  EXPECT_LT(std::abs(vehicle.speed_mps() * vehicle.yaw_rate_radps()), 9.3);
}

// From 10 m/s at -5 m/s^2: 10 m, plus about 10 * 0.15 s = 1.5 m of lag.
TEST(Vehicle, BrakesInTheDistanceOfDecelerationAndLag) {
  Vehicle vehicle = rolling(10.0);
  const double from_m = vehicle.rear_axle().x;
  drive(vehicle, 5.0, -5.0, 0.0);
  EXPECT_EQ(vehicle.speed_mps(), 0.0);
  EXPECT_NEAR(vehicle.rear_axle().x - from_m, 11.5, 0.3);
}

// A first-order lag has done 1 - 1/e = 63 % after its time constant of 0.15 s.
TEST(Vehicle, DriveFollowsWithItsLag) {
  Vehicle vehicle = rolling(10.0);
  drive(vehicle, 0.15, 2.0, 0.0);
  EXPECT_NEAR(vehicle.acceleration_mps2(), 2.0 * 0.632, 0.03);
}

// 0.7 rad/s is the most: after 0.2 s of a 0.5 rad step the wheels stand at no more than 0.14 rad.
TEST(Vehicle, SteeringRateIsLimited) {
  Vehicle vehicle = rolling(5.0);
  drive(vehicle, 0.2, 0.0, 0.5);
  EXPECT_NEAR(vehicle.steering_rad(), 0.14, 1e-6);
  drive(vehicle, 3.0, 0.0, 2.0);
  EXPECT_NEAR(vehicle.steering_rad(), 0.55, 1e-3);
}

// Asked for more than it can, the car gives 3.5 m/s^2 of drive and, on dry road, mu g of braking at most.
TEST(Vehicle, DriveAndBrakeSaturate) {
  Vehicle vehicle = rolling(15.0);
  drive(vehicle, 1.5, 20.0, 0.0);
  EXPECT_NEAR(vehicle.acceleration_mps2(), 3.5, 0.01);
  drive(vehicle, 1.0, -20.0, 0.0);
  EXPECT_NEAR(vehicle.acceleration_mps2(), -0.9 * 9.81, 0.05);
}

// WORLD-001 Held by the brake the car does not move by a single bit, even with the wheels turned; drive
// restarts it.
TEST(Vehicle, StandsExactlyStillAndStartsAgain) {
  Vehicle vehicle = rolling(3.0);
  drive(vehicle, 3.0, -3.0, 0.0);
  const map::Vec2 stood = vehicle.rear_axle();
  drive(vehicle, 5.0, -1.0, 0.4);
  EXPECT_EQ(vehicle.rear_axle().x, stood.x);
  EXPECT_EQ(vehicle.rear_axle().y, stood.y);
  EXPECT_EQ(vehicle.speed_mps(), 0.0);
  EXPECT_EQ(vehicle.acceleration_mps2(), 0.0);
  drive(vehicle, 2.0, 1.0, 0.0);
  EXPECT_GT(vehicle.speed_mps(), 1.5);
}

// Through the blend from kinematic to dynamic nothing jumps: the yaw rate changes by less than 0.02 rad/s in
// a 1 ms step.
TEST(Vehicle, BlendsWithoutAJump) {
  Vehicle vehicle = rolling(0.5);
  double last = 0.0;
  for (int ms = 0; ms < 6000; ++ms) {
    vehicle.step(1.5, 0.2);
    EXPECT_LT(std::abs(vehicle.yaw_rate_radps() - last), 0.02);
    last = vehicle.yaw_rate_radps();
  }
}

}  // namespace
}  // namespace s4tp::nodes
