// The tracker where a plan ends, where its fail-safe begins, and without one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware/ecu/tracker.hpp"
#include "tests/support/tracked_drive.hpp"

namespace s4tp::ecu {
namespace {

/// At 10 m/s.
EgoState on_the_road(float x_m) {
  EgoState ego;
  ego.rear_axle.x_m = x_m;
  ego.speed_mps = 10.0F;
  return ego;
}

/// Straight on at 10 m/s from x = 0; its fail-safe branches after 0.35 s and brakes with 6 m/s^2.
Plan plan_with_a_branch() {
  Plan plan = plan_of(straight(10.0), 0);
  plan.fail_safe = {0.35F, 6.0F};
  return plan;
}

// ECU-052 ECU-053: past its end of 3 s a plan is braked along with 4 m/s^2.
TEST(Tracker, StopsPastThePlansEnd) {
  const EgoState ego = on_the_road(30.0F);
  Tracker tracker;
  const Plan plan = plan_of(straight(10.0), 0);
  EXPECT_NEAR(tracker.follow(plan, 3000, ego, {}).acceleration_mps2, 0.0F, 0.2F);
  EXPECT_EQ(tracker.follow(plan, 3010, ego, {}).acceleration_mps2, -4.0F);
  EXPECT_EQ(tracker.error().distance_m, 0.0F);
}

// ECU-095 ECU-053: a plan to drive whose fail-safe branches after 0.35 s is braked along with 6 m/s^2 from
// then on; one that is a stop itself is followed.
TEST(Tracker, DrivesTheFailSafePastItsBranch) {
  const EgoState ego = on_the_road(3.6F);
  Plan plan = plan_with_a_branch();
  Tracker tracker;
  EXPECT_GT(tracker.follow(plan, 350, ego, {}).acceleration_mps2, -1.0F);
  EXPECT_EQ(tracker.follow(plan, 360, ego, {}).acceleration_mps2, -6.0F);
  plan.kind = PlanKind::kMinimumRisk;
  EXPECT_GT(Tracker().follow(plan, 360, ego, {}).acceleration_mps2, -1.0F);
}

// ECU-106: a fail-safe that branches after 0.35 s is driven as planned up to there, and braked with 6 m/s^2 from there on, of a
// plan to drive and of one that is a stop itself; one that branches at once is braked at once.
TEST(Tracker, DrivesTheFailSafeUpToItsBranch) {
  const EgoState ego = on_the_road(3.5F);
  Plan plan = plan_with_a_branch();
  for (const PlanKind kind : {PlanKind::kDrive, PlanKind::kMinimumRisk}) {
    plan.kind = kind;
    EXPECT_GT(Tracker().drive_fail_safe(plan, 340, ego, {}).acceleration_mps2, -1.0F);
    EXPECT_EQ(Tracker().drive_fail_safe(plan, 350, ego, {}).acceleration_mps2, -6.0F);
  }
  plan.fail_safe.branch_s = 0.0F;
  EXPECT_EQ(Tracker().drive_fail_safe(plan, 0, ego, {}).acceleration_mps2, -6.0F);
}

// ECU-053: stopping out of the turn's middle stays on the turn; and brakes as hard as the plan where that is
// harder.
TEST(Tracker, StopsAlongThePlansPath) {
  const DriveScript script = left_turn(5.0);
  TrackedDrive drive(script);
  drive.plant.speed_mps = 5.0;
  drive.run(4.0);
  const Plan last = drive.plan;
  double worst_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    EgoState ego;
    ego.rear_axle = {static_cast<float>(drive.plant.x_m), static_cast<float>(drive.plant.y_m),
                     static_cast<float>(drive.plant.heading_rad)};
    ego.speed_mps = static_cast<float>(drive.plant.speed_mps);
    drive.plant.step(drive.tracker.stop(last, ego, drive.parameters));
    if (i % 50 != 0) continue;
    double nearest_m = 1e9;
    for (double t = 4.0; t < 5.5; t += 0.01) {
      const Pose path = script(t).rear_axle;
      nearest_m = std::min(nearest_m, std::hypot(static_cast<double>(path.x_m) - drive.plant.x_m,
                                                 static_cast<double>(path.y_m) - drive.plant.y_m));
    }
    worst_m = std::max(worst_m, nearest_m);
  }
  EXPECT_EQ(drive.plant.speed_mps, 0.0);
  EXPECT_LT(worst_m, 0.1);

  Plan hard = plan_of(straight(10.0), 0);
  for (TrajectoryPoint& point : hard.trajectory.points) point.acceleration_mps2 = -7.0F;
  EgoState ego;
  ego.speed_mps = 10.0F;
  EXPECT_EQ(Tracker().stop(hard, ego, {}).acceleration_mps2, -7.0F);
}

// ECU-054: the same braking, whatever the speed told; a sensor that says 0 at 14 m/s does not let the car
// roll on.
TEST(Tracker, StopsWhateverTheSpeedSensorSays) {
  EgoState ego;
  EXPECT_EQ(Tracker().stop(Plan{}, ego, {}).acceleration_mps2, -4.0F);
  EXPECT_EQ(Tracker().stop(plan_of(straight(10.0), 0), ego, {}).acceleration_mps2, -4.0F);
}

// ECU-053: without a plan, or 4 m beside it, the wheels stay where they are.
TEST(Tracker, StopsWithoutAPlan) {
  EgoState ego;
  ego.speed_mps = 10.0F;
  ego.steering_rad = 0.123F;
  EXPECT_EQ(Tracker().stop(Plan{}, ego, {}).steering_rad, 0.123F);
  EXPECT_EQ(Tracker().follow(Plan{}, 0, ego, {}).acceleration_mps2, -4.0F);
  ego.rear_axle.y_m = 4.0F;
  EXPECT_EQ(Tracker().stop(plan_of(straight(10.0), 0), ego, {}).steering_rad, 0.123F);
}

}  // namespace
}  // namespace s4tp::ecu
