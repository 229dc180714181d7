// Responsibility-sensitive safety: distances by hand, responses to one vehicle, clipping.

#include "algo/safety/rss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "algo/trajectory/bicycle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// Three lanes, we in the middle at s = 100.
struct Road {
  LaneMap map = straight_road(3, 400.0F);
  Scene scene;
  Parameters parameters;
  explicit Road(float speed_mps) {
    add_way(scene, map, path_of(map, {1}));
    put_ego(scene, state_on(map, scene.ego_paths[0].path, 100.0F, speed_mps));
  }
  /// `gap_m` > 0 ahead of our front (s = 104), < 0 behind our rear (s = 99).
  Agent& vehicle(int lane, float gap_m, float speed_mps, float d_m = 0.0F) {
    const float s_m = gap_m > 0.0F ? 104.0F + gap_m + 2.5F : 99.0F + gap_m - 2.5F;
    return add_vehicle(scene, map, path_of(map, {static_cast<LaneIndex>(lane)}), s_m, speed_mps, d_m);
  }
  /// Ours, at constant speed and straight on, or into the lane on the left within 2.8 s.
  [[nodiscard]] Trajectory plan(float end_d_m) const {
    Trajectory trajectory;
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      const float time_s = kStepS * static_cast<float>(i);
      const float u = std::min(time_s / 2.8F, 1.0F);
      const float d_m = end_d_m * u * u * u * (10.0F - 15.0F * u + 6.0F * u * u);
      const float s_m = 100.0F + scene.ego.speed_mps * time_s;
      trajectory.points[i] = state_on(map, scene.ego_paths[0].path, s_m, scene.ego.speed_mps, d_m);
    }
    return trajectory;
  }
  [[nodiscard]] RssEnvelope envelope(float end_d_m = 0.0F) const {
    return rss_envelope(scene, plan(end_d_m), parameters);
  }
};

// RSS-001 At 13.9 m/s both: 13.9 * 0.5 + 0.5 * 2 * 0.25 + 14.9^2 / 10 - 13.9^2 / 16 = 6.95 + 0.25 + 22.20
// - 12.08.
TEST(Rss, SafeDistanceByHand) {
  EXPECT_NEAR(safe_distance_m(13.9F, 13.9F, {}), 17.325F, 0.01F);
  EXPECT_NEAR(safe_distance_m(0.0F, 0.0F, {}), 0.35F, 1e-5F);  // 0.25 + 1 / 10
  EXPECT_EQ(safe_distance_m(5.0F, 20.0F, {}), 0.0F);           // it cannot be caught
}

// RSS-002 Both at rest sideways: each may gain 0.4 m/s in 0.5 s (0.1 m) and brake (0.16 / 2 = 0.08 m): 0.36 +
// 0.1 m. Apart at 2 m/s, neither comes near: mu alone.
TEST(Rss, SafeLateralByHand) {
  EXPECT_NEAR(safe_lateral_m(0.0F, 0.0F, {}), 0.46F, 1e-5F);
  EXPECT_NEAR(safe_lateral_m(1.0F, 0.0F, {}), 0.1F + 0.6F + 0.98F + 0.18F, 1e-5F);
  EXPECT_NEAR(safe_lateral_m(-2.0F, -2.0F, {}), 0.1F, 1e-5F);
}

// RSS-008 Nobody, a leader beyond the safe distance, cars beside in their lanes: no restriction, nothing
// clipped.
TEST(Rss, OrdinaryTrafficIsUnrestricted) {
  Road road(13.9F);
  road.vehicle(1, 18.0F, 13.9F);
  road.vehicle(2, 1.0F, 13.9F);
  road.vehicle(0, -1.0F, 13.9F);
  const RssEnvelope envelope = road.envelope();
  EXPECT_FALSE(envelope.active);
  EXPECT_FLOAT_EQ(envelope.acceleration_max_mps2, 3.5F);
  Trajectory trajectory;
  trajectory.points[3].acceleration_mps2 = 3.0F;
  EXPECT_FALSE(clip_to_envelope(envelope, road.parameters, trajectory));
}

// RSS-003 Whoever comes from behind, however near and fast, is obliged himself; so is crossing traffic
// elsewhere.
TEST(Rss, FollowersAreObligedThemselves) {
  Road road(10.0F);
  road.vehicle(1, -1.0F, 20.0F);
  Agent& crossing = road.vehicle(1, 6.0F, 8.0F);
  crossing.track.centre.heading_rad = 1.57F;
  EXPECT_FALSE(road.envelope().active);
}

// RSS-004 At 13.9 m/s both, the distance 17.325 m and the part needed at once, 19.32 - 12.08 = 7.24 m: half
// way, at 12.28 m, half of b_min. At the distance itself nothing; at 7.24 m all of it.
TEST(Rss, ResponseGrowsWithTheNeed) {
  const float gaps[] = {17.3F, 13.03F, 8.735F};
  const float responses[] = {-0.014F, -2.5F, -5.0F};
  for (int i = 0; i < 3; ++i) {
    Road road(13.9F);
    road.vehicle(1, gaps[i], 13.9F);
    const RssEnvelope envelope = road.envelope();
    EXPECT_TRUE(envelope.active);
    EXPECT_EQ(envelope.agent, 0);
    EXPECT_NEAR(envelope.acceleration_max_mps2, responses[i], 0.02F) << gaps[i];
  }
}

// RSS-004 Nearer than b_min can answer, 13.9 m/s towards a standing car 15 m ahead: 13.9^2 / 2 (15 - 1.49)
// = 7.15 m/s^2.
TEST(Rss, HarderThanMinimumWhenTooLate) {
  Road road(13.9F);
  road.vehicle(1, 15.0F, 0.0F);
  EXPECT_NEAR(road.envelope().acceleration_max_mps2, -7.15F, 0.01F);
}

// RSS-005 Somebody as fast as we cuts in 14 m ahead: 0.39 of b_min, and the plan is not clipped to a stop:
// after 3 s it still drives at 10 m/s or more.
TEST(Rss, CutInAsksForBrakingNotForAStop) {
  Road road(13.9F);
  road.vehicle(1, 14.0F, 13.9F);
  const RssEnvelope envelope = road.envelope();
  EXPECT_LT(envelope.acceleration_max_mps2, -1.0F);
  EXPECT_GT(envelope.acceleration_max_mps2, -2.5F);
  Trajectory trajectory;
  trajectory.points[0] = state_on(road.map, road.scene.ego_paths[0].path, 100.0F, 13.9F);
  for (int i = 1; i < kTrajectoryPoints; ++i)
    trajectory.points[i] = bicycle_step(trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
  EXPECT_TRUE(clip_to_envelope(envelope, road.parameters, trajectory));
  EXPECT_GT(trajectory.points[kHorizonSteps].speed_mps, 10.0F);
}

// RSS-009 25 m behind one at 5.8 m/s, 27.3 m being safe: he brakes and stands 2.1 m on, where our front is
// after 1.95 s. By then a plan to the left has moved 2.4 m, and 0.9 + 0.9 + 0.1 m and the 0.18 m he may come
// over are enough: no braking. Straight on it is due; so it is 15 m behind him, reached after 1.23 s and
// 1.2 m; and when he comes over with 1 m/s, 1.58 m, of which the plan leaves him 3.2 - 1.9 m.
TEST(Rss, WhoLeavesTheStripInTimeNeedNotBrake) {
  Road road(13.9F);
  Agent& leader = road.vehicle(1, 25.0F, 5.8F);
  EXPECT_LT(road.envelope().acceleration_max_mps2, 0.0F);
  EXPECT_FALSE(road.envelope(3.2F).active);
  leader.track.centre.heading_rad = std::asin(1.0F / 5.8F);
  EXPECT_LT(road.envelope(3.2F).acceleration_max_mps2, 0.0F);

  Road near(13.9F);
  near.vehicle(1, 15.0F, 5.8F);
  EXPECT_LT(near.envelope(3.2F).acceleration_max_mps2, -5.0F);
}

// RSS-006 Beside us on the left, 1.4 m away (lanes 3.2 m, widths 1.8 m), which is safe while both keep their
// lanes; when we move left with 1 m/s (1.86 m needed) there is to be no speed to the left, and to the right
// as ever.
TEST(Rss, NoMoveTowardsSomebodyBeside) {
  Road road(10.0F);
  Agent& agent = road.vehicle(2, 1.0F, 10.0F);
  EXPECT_FALSE(road.envelope().active);
  road.scene.ego.rear_axle.heading_rad = 0.1F;
  const RssEnvelope envelope = road.envelope();
  EXPECT_TRUE(envelope.active);
  EXPECT_EQ(envelope.lateral_left_max_mps, 0.0F);
  EXPECT_GT(envelope.lateral_right_max_mps, 5.0F);
  EXPECT_FLOAT_EQ(envelope.acceleration_max_mps2, 3.5F);
  // The same when it is he who comes over.
  road.scene.ego.rear_axle.heading_rad = 0.0F;
  agent.track.centre.heading_rad = -0.1F;
  EXPECT_EQ(road.envelope().lateral_left_max_mps, 0.0F);
}

// RSS-007 On a circle of radius 20 m, clipped to -3 m/s^2 for 1 s: every point still lies on the circle, 10
// m/s become 7, and the way is 0.5 * (10 + 7) * 1 = 8.5 m after 1 s, then 7 m a second.
TEST(Rss, ClippingKeepsThePath) {
  const Parameters parameters;
  Trajectory trajectory;
  trajectory.points[0].speed_mps = 10.0F;
  trajectory.points[0].curvature_1pm = 0.05F;
  for (int i = 1; i < kTrajectoryPoints; ++i)
    trajectory.points[i] = bicycle_step(trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
  RssEnvelope envelope{};
  envelope.active = true;
  envelope.acceleration_max_mps2 = -3.0F;
  ASSERT_TRUE(clip_to_envelope(envelope, parameters, trajectory));
  for (const TrajectoryPoint& point : trajectory.points)
    EXPECT_NEAR(std::hypot(point.rear_axle.x_m, point.rear_axle.y_m - 20.0F), 20.0F, 0.01F);
  EXPECT_NEAR(trajectory.points[10].speed_mps, 7.0F, 1e-3F);
  EXPECT_NEAR(trajectory.points[10].rear_axle.heading_rad, 8.5F / 20.0F, 1e-3F);
  EXPECT_NEAR(trajectory.points[30].rear_axle.heading_rad, 22.5F / 20.0F, 1e-3F);
}

// RSS-007 Braking already harder than asked for is left alone.
TEST(Rss, ClippingLeavesHarderBraking) {
  Trajectory trajectory;
  trajectory.points[0].speed_mps = 10.0F;
  for (int i = 1; i < kTrajectoryPoints; ++i)
    trajectory.points[i] = bicycle_step(trajectory.points[i - 1], -3.2F, 0.0F, kStepS);
  RssEnvelope envelope{};
  envelope.active = true;
  envelope.acceleration_max_mps2 = -3.0F;
  EXPECT_FALSE(clip_to_envelope(envelope, Parameters{}, trajectory));
}

}  // namespace
}  // namespace s4tp
