// Where a plan begins, and how the running one goes on.

#include <gtest/gtest.h>

#include <cmath>

#include "algo/core/math.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/roll_out.hpp"
#include "tests/support/candidate_roads.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {
namespace {

// CAND-007 0.4 m beside and 0.8 m behind the running plan we still go on from it, so that nothing jumps.
TEST(PlanStart, GoesOnFromTheRunningPlan) {
  Plan running;
  running.kind = PlanKind::kDrive;
  running.start_ms = kNow;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    running.trajectory.points[i].rear_axle.x_m = static_cast<float>(i);
    running.trajectory.points[i].speed_mps = 10.0F;
  }
  EgoState ego;
  ego.rear_axle = {-0.8F, 0.4F, 0.01F};
  ego.speed_mps = 9.5F;
  const TrajectoryPoint start = plan_start(ego, kNow, running, kNow + 100, Parameters{});
  EXPECT_EQ(start.rear_axle.x_m, 1.0F);
  EXPECT_EQ(start.rear_axle.y_m, 0.0F);
  EXPECT_EQ(start.speed_mps, 10.0F);
}

// CAND-008 Too far from the plan, without one, or past its end: the measured state, 0.1 s and 1 m later.
TEST(PlanStart, ElseTheMeasuredStateBroughtForward) {
  Plan running;
  running.kind = PlanKind::kDrive;
  running.start_ms = kNow;
  EgoState ego;
  ego.rear_axle = {20.0F, 0.6F, 0.0F};
  ego.speed_mps = 10.0F;
  for (const Plan& plan : {running, Plan{}}) {
    const TrajectoryPoint start = plan_start(ego, kNow, plan, kNow + 100, Parameters{});
    EXPECT_NEAR(start.rear_axle.x_m, 21.0F, 1e-4F);
    EXPECT_EQ(start.rear_axle.y_m, 0.6F);
  }
  ego.rear_axle = {};
  ego.speed_mps = 0.0F;
  EXPECT_FALSE(plan_covers(running, kNow + 3000));
  EXPECT_FALSE(plan_covers(running, kNow - 100));
  EXPECT_TRUE(plan_covers(running, kNow + 2900));
}

// CAND-008 At rest with the brake on nothing is brought forward.
TEST(PlanStart, StandstillStaysWhereItIs) {
  EgoState ego;
  ego.rear_axle = {3.0F, 4.0F, 1.0F};
  ego.acceleration_mps2 = -2.0F;
  const TrajectoryPoint start = plan_start(ego, kNow, Plan{}, kNow + 200, Parameters{});
  EXPECT_EQ(start.rear_axle.x_m, 3.0F);
  EXPECT_EQ(start.speed_mps, 0.0F);
  EXPECT_EQ(start.acceleration_mps2, 0.0F);
}

// CAND-010 Half way through a lane change, the fresh candidate goes on with it: it is there within half its 3
// s.
TEST(Candidates, LaneChangeUnderWayGoesOn) {
  Roads roads(50.0F, 10.0F);
  const CandidateList first = generate(roads.scene, roads.start);
  const Trajectory begun = rolled(roads.scene, *find(first, 1, Intent::kAccelerate, 0.0F), roads.start);
  const TrajectoryPoint half = begun.points[15];
  put_ego(roads.scene, half);
  const CandidateList second = generate(roads.scene, half);
  const Candidate* left = find(second, 1, Intent::kAccelerate, 0.0F);
  ASSERT_NE(left, nullptr);
  const Trajectory trajectory = rolled(roads.scene, *left, half);
  EXPECT_NEAR(trajectory.points[18].rear_axle.y_m, 2.0F * kLaneWidthM, 0.1F);
}

// CAND-010 The running plan, shifted by one step, is a candidate: its old points to the bit, and one more.
TEST(Candidates, RunningPlanGoesOn) {
  Roads roads(50.0F, 10.0F);
  const CandidateList first = generate(roads.scene, roads.start);
  Plan running;
  running.kind = PlanKind::kDrive;
  running.start_ms = kNow - 100;
  running.trajectory = rolled(roads.scene, *find(first, 1, Intent::kAccelerate, 0.0F), roads.start);
  running.manoeuvre.lane_change = LaneChange::kPrepare;
  running.manoeuvre.side = 1;
  const TrajectoryPoint start = sample(running, kNow);
  put_ego(roads.scene, start);
  const CandidateList list = generate(roads.scene, start, running);
  const Candidate* previous = find(list, 1, Intent::kPrevious);
  ASSERT_NE(previous, nullptr);
  EXPECT_EQ(find(list, 0, Intent::kPrevious), nullptr);  // it leads to the left lane
  const Trajectory trajectory = rolled(roads.scene, *previous, start, running);
  for (int i = 1; i < kHorizonSteps; ++i) {
    EXPECT_EQ(trajectory.points[i].rear_axle.y_m, running.trajectory.points[i + 1].rear_axle.y_m);
  }
  EXPECT_NEAR(end_of(trajectory).rear_axle.x_m, running.trajectory.points[kHorizonSteps].rear_axle.x_m + 1.0F,
              0.05F);
  EXPECT_TRUE(feasible(trajectory, Parameters{}));
}

// CAND-016 A plan at 5 m/s heads for the left lane by 0.2 rad and ends 1.2 m short of its centre. Each cycle
// adds a step, and a refinement makes it as straight as the one before: 1 m to the side within ten cycles. It
// comes to the centre all the same, and not past it.
TEST(Candidates, APlanIsNotCarriedAcrossItsLine) {
  Roads roads(50.0F, 5.0F);
  const float line_y_m = roads.start.rear_axle.y_m + kLaneWidthM;
  Plan running;
  running.kind = PlanKind::kDrive;
  running.start_ms = kNow - 100;
  TrajectoryPoint point = roads.start;
  point.rear_axle.heading_rad = 0.2F;
  point.rear_axle.y_m = line_y_m - 1.2F - 15.0F * std::sin(0.2F);
  for (TrajectoryPoint& planned : running.trajectory.points) {
    planned = point;
    point = bicycle_step(point, 0.0F, 0.0F, kStepS);
  }
  for (int cycle = 0; cycle < 40; ++cycle) {
    const TrajectoryPoint start = running.trajectory.points[1];
    put_ego(roads.scene, start);
    Candidate previous;
    previous.path = 1;
    previous.intent = Intent::kPrevious;
    previous.start_s_m = start.rear_axle.x_m;
    previous.lateral_length_m = 14.0F;
    running.trajectory = rolled(roads.scene, previous, start, running);
    TrajectoryPoint* points = running.trajectory.points;
    points[kHorizonSteps] = bicycle_step(points[kHorizonSteps - 1], 0.0F, 0.0F, kStepS);
    EXPECT_LT(points[kHorizonSteps].rear_axle.y_m, line_y_m + 0.3F) << cycle;
  }
  EXPECT_NEAR(end_of(running.trajectory).rear_axle.y_m, line_y_m, 0.3F);
}

}  // namespace
}  // namespace s4tp::trajectory
