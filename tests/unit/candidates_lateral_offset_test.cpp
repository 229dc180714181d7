// Candidates beside the centre of the lane.

#include <gtest/gtest.h>

#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/roll_out.hpp"
#include "tests/support/candidate_roads.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {
namespace {

// CAND-018 0.35 m to the left at 8 m/s: a drive settles there within its 3 s, the plan it becomes goes on
// there a second later, and who is steered comes there too.
TEST(Candidates, SettleAtTheLateralOffset) {
  Roads roads(100.0F, 8.0F);
  roads.scene.ego_paths[0].lateral_offset_m = 0.35F;
  Candidate drive = *find(generate(roads.scene, roads.start), 0, Intent::kAccelerate);
  Plan running;
  running.kind = PlanKind::kDrive;
  running.trajectory = rolled(roads.scene, drive, roads.start);
  EXPECT_NEAR(end_of(running.trajectory).rear_axle.y_m, kLaneWidthM + 0.35F, 0.01F);
  drive.steered = true;
  EXPECT_NEAR(end_of(rolled(roads.scene, drive, roads.start)).rear_axle.y_m, kLaneWidthM + 0.35F, 0.1F);

  running.start_ms = kNow - 1000;
  const TrajectoryPoint later = running.trajectory.points[10];
  put_ego(roads.scene, later);
  const CandidateList list = generate(roads.scene, later, running);
  const Candidate* on = find(list, 0, Intent::kPrevious);
  ASSERT_NE(on, nullptr);
  const Trajectory going_on = rolled(roads.scene, *on, later, running);
  EXPECT_NEAR(end_of(going_on).rear_axle.y_m, kLaneWidthM + 0.35F, 0.01F);
}

// CAND-017 Wheels turned by 0.1 / m to the right, 3.2 m to go to the left: 14 m of quintic turn them back in
// time; 40 m swing 0.05 * 40^2 * 0.035 - 1 = 1.8 m to the right before.
TEST(Candidates, ALongQuinticSwingsOut) {
  Roads roads(50.0F, 1.0F);
  roads.start.curvature_1pm = -0.1F;
  ReferenceLine line;
  build_reference(roads.map, roads.scene.ego_paths[1].path, 50.0F, 1.0F, Parameters{}, line);
  const ReferenceCoordinates where = locate_on(line, position(roads.start.rear_axle), 50.0F);
  Candidate candidate;
  shape_lateral(line, roads.start, where, 14.0F, candidate);
  EXPECT_FALSE(overshoots(candidate));
  shape_lateral(line, roads.start, where, 40.0F, candidate);
  EXPECT_TRUE(overshoots(candidate));
}

// CAND-017 However our wheels and we are turned when we set off: no candidate swings out, some are steered.
TEST(Candidates, NobodySwingsOutToTheOtherSide) {
  int steered = 0;
  for (const float speed_mps : {0.5F, 2.0F, 6.0F}) {
    for (const float curvature_1pm : {-0.15F, -0.05F, 0.1F}) {
      for (const float heading_rad : {-0.15F, 0.0F, 0.1F}) {
        Roads roads(50.0F, speed_mps);
        roads.start.curvature_1pm = curvature_1pm;
        roads.start.rear_axle.heading_rad = heading_rad;
        put_ego(roads.scene, roads.start);
        for (const Candidate& candidate : generate(roads.scene, roads.start)) {
          EXPECT_TRUE(candidate.steered || !overshoots(candidate));
          steered += candidate.steered ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(steered, 0);
}

// CAND-009 Standing 0.3 rad askew and 0.5 m off the centre there still is a feasible way to drive off.
TEST(Candidates, AskewInTheLane) {
  Roads roads(50.0F, 3.0F);
  roads.start.rear_axle.y_m += 0.5F;
  roads.start.rear_axle.heading_rad = 0.3F;
  put_ego(roads.scene, roads.start);
  const CandidateList list = generate(roads.scene, roads.start);
  EXPECT_NE(find(list, 0, Intent::kAccelerate, 2.0F), nullptr);
  EXPECT_NE(find(list, 0, Intent::kAccelerate, -3.0F), nullptr);
}

}  // namespace
}  // namespace s4tp::trajectory
