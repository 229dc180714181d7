#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/driven_lines.hpp"
#include "tests/support/shared_ground.hpp"

namespace s4tp::trajectory {
namespace {

using test::SharedGround;

/// Where we drive, 20 m before the crossing, past one who stands there with its front `front_m` left of our
/// centre line.
struct Bystander : SharedGround {
  explicit Bystander(float front_m) : SharedGround(Priority::kFirstYields) {
    test::put_ego(scene, test::state_on(map, ours, 80.0F, 5.0F));
    other(100.0F + front_m - 2.5F, 0.0F);
  }
  float lateral_offset_m() {
    const TrajectoryPoint start = test::state_on(map, ours, scene.ego_paths[0].frenet.s_m, 5.0F);
    (void)build_lines(start, 0.0F, parameters, scene, lines);
    return scene.ego_paths[0].lateral_offset_m;
  }
  ReferenceLines lines;
};

// CAND-018 Our side is 0.9 m from the centre line. With its front 1.2 m to the right of it one leaves 0.3 m:
// 0.35 more to the left are enough, and 0.7 from 0.8 m (-0.1 + 0.7). At 1.4 m nothing is needed, and at 0.4 m
// nothing helps (-0.5 + 0.7 < 0.4).
TEST(LateralOffset, TheLeastThatIsEnough) {
  EXPECT_FLOAT_EQ(Bystander(-1.2F).lateral_offset_m(), 0.35F);
  EXPECT_FLOAT_EQ(Bystander(-0.8F).lateral_offset_m(), 0.7F);
  EXPECT_FLOAT_EQ(Bystander(-1.4F).lateral_offset_m(), 0.0F);
  EXPECT_FLOAT_EQ(Bystander(-0.4F).lateral_offset_m(), 0.0F);
}

// CAND-018 Who reaches in from the left is passed on the right: its rear, 1.2 m left of the line, leaves 0.3
// m.
TEST(LateralOffset, ToTheOtherSide) {
  EXPECT_FLOAT_EQ(Bystander(1.2F + 5.0F).lateral_offset_m(), -0.35F);
}

// CAND-018 Our lane is our limit: in one of 2.6 m a car of 1.8 m has 0.4 m on each side.
TEST(LateralOffset, NotBeyondTheLane) {
  for (const float front_m : {-1.2F, -0.8F}) {
    Bystander narrow(front_m);
    narrow.map.lanes[0].width_m = 2.6F;
    EXPECT_FLOAT_EQ(narrow.lateral_offset_m(), front_m < -1.0F ? 0.35F : 0.0F);
  }
}

// CAND-018 To the last centimetre: 0.7 m beside the centre, a car of 1.8 m fills a lane of 3.2 m.
TEST(LateralOffset, AllOfTheLane) {
  Bystander narrow(-0.8F);
  narrow.map.lanes[0].width_m = 3.2F;
  EXPECT_FLOAT_EQ(narrow.lateral_offset_m(), 0.7F);
}

// CAND-018 Whom we pass at an offset does not lead us: its front, 0.8 m right of the line, is in the strip we need
// on the line (0.9 + 0.2 m), and 0.6 m from our side when we drive 0.7 m to the left. (It is in no lane of
// its own.)
TEST(LateralOffset, WhomWePassDoesNotLeadUs) {
  Bystander passed(-0.8F);
  passed.scene.agents[0].lane = kNoLaneIndex;
  const scene::EgoPath& path = passed.scene.ego_paths[0];
  EXPECT_EQ(find_leader(passed.scene, path, path.frenet.s_m, passed.parameters).agent, 0);
  EXPECT_FLOAT_EQ(passed.lateral_offset_m(), 0.7F);
  EXPECT_EQ(find_leader(passed.scene, path, path.frenet.s_m, passed.parameters).agent, -1);
}

// CAND-018 At 0.5 m/s it does not stand; along our way it is who leads us; and from 35 m away it is not
// minded.
TEST(LateralOffset, OnlyWhoStandsAcross) {
  Bystander moving(-1.2F);
  moving.scene.agents[0].track.speed_mps = 0.5F;
  EXPECT_FLOAT_EQ(moving.lateral_offset_m(), 0.0F);
  Bystander along(-1.2F);
  along.scene.agents[0].track.centre = {0.0F, -2.1F, 0.0F};
  EXPECT_FLOAT_EQ(along.lateral_offset_m(), 0.0F);
  Bystander far(-1.2F);
  test::put_ego(far.scene, test::state_on(far.map, far.ours, 58.0F, 5.0F));
  EXPECT_FLOAT_EQ(far.lateral_offset_m(), 0.0F);
}

// CAND-018 Wherever one stands, however it is turned: at the offset we take there is room, and on
// the centre line there was none.
TEST(LateralOffset, LeavesRoom) {
  EXPECT_TRUE(rc::check([] {
    const auto between = [](int low, int high) {
      return 0.01F * static_cast<float>(*rc::gen::inRange(low, high));
    };
    Bystander bystander(0.0F);
    scene::Agent& agent = bystander.scene.agents[0];
    agent.track.centre = {between(-1500, 500), between(-500, 500), between(-314, 315)};
    agent.track.length_m = between(300, 1200);
    const float lateral_offset_m = bystander.lateral_offset_m();
    scene::EgoPath& path = bystander.scene.ego_paths[0];
    const auto room = [&] {
      const Box other{agent.track.centre, agent.track.length_m, agent.track.width_m};
      for (float s_m = path.frenet.s_m; s_m < path.frenet.s_m + 30.0F; s_m += 0.5F) {
        const Pose line = scene::path_point(bystander.map, path.path, s_m).pose;
        const Point at = offset_point(line, 0.0F, path.lateral_offset_m);
        const Pose rear_axle{at.x_m, at.y_m, line.heading_rad};
        if (separation(ego_box(rear_axle, bystander.parameters), other) < kBystanderGapM) return false;
      }
      return true;
    };
    RC_TAG(lateral_offset_m != 0.0F);
    if (lateral_offset_m == 0.0F) return;
    RC_ASSERT(room());
    path.lateral_offset_m = 0.0F;
    RC_ASSERT(!room());
  }));
}

}  // namespace
}  // namespace s4tp::trajectory
