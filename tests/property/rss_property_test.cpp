// RSS as a promise: whatever the leader does, who follows the response does not touch it.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "algo/safety/rss.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// `low` .. `high` in hundredths.
float uniform(int low, int high) {
  return 0.01F * static_cast<float>(*rc::gen::inRange(low, high + 1));
}

// RSS-004 From any gap at or above the part needed at once plus what 0.2 s of delay take, the follower
// accelerates as fast as it is let, 0.2 s late; the leader may accelerate, then brakes with b_max at any
// moment. They never touch.
TEST(RssProperty, ResponseKeepsClearOfTheWorstLeader) {
  EXPECT_TRUE(rc::check([] {
    const Parameters parameters;
    const LaneMap map = straight_road(1, 2000.0F);
    Scene scene;
    add_way(scene, map, path_of(map, {0}));
    float rear_s_m = 10.0F;  // our rear axle; the front is 4 m ahead
    float rear_mps = uniform(0, 3000);
    float front_mps = uniform(0, 3000);
    const float safe_m = safe_distance_m(rear_mps, front_mps, parameters);
    float front_s_m = rear_s_m + 4.0F + safe_m + uniform(1, 2000) + 2.5F;
    const int brakes_at = *rc::gen::inRange(0, 80);
    const float before_mps2 = uniform(-300, 200);
    float applied_mps2 = 0.0F;
    float asked_mps2 = 0.0F;
    for (int i = 0; i < 200; ++i) {
      scene.agents.clear();
      add_vehicle(scene, map, scene.ego_paths[0].path, front_s_m, front_mps);
      put_ego(scene, state_on(map, scene.ego_paths[0].path, rear_s_m, rear_mps));
      Trajectory in_lane;
      for (TrajectoryPoint& point : in_lane.points)
        point = state_on(map, scene.ego_paths[0].path, rear_s_m, rear_mps);
      applied_mps2 = asked_mps2;  // what was asked for a step ago takes effect now
      asked_mps2 = std::min(rss_envelope(scene, in_lane, parameters).acceleration_max_mps2,
                            parameters.rss.acceleration_mps2);
      const float front_next = std::max(0.0F, front_mps + (i < brakes_at ? before_mps2 : -8.0F) * kStepS);
      const float rear_next = std::max(0.0F, rear_mps + applied_mps2 * kStepS);
      front_s_m += 0.5F * (front_mps + front_next) * kStepS;
      rear_s_m += 0.5F * (rear_mps + rear_next) * kStepS;
      front_mps = front_next;
      rear_mps = rear_next;
      RC_ASSERT(front_s_m - 2.5F - (rear_s_m + 4.0F) > 0.0F);
    }
  }));
}

// RSS-001 The distance grows with the follower's speed, falls with the leader's, and is never negative.
TEST(RssProperty, SafeDistanceIsMonotone) {
  EXPECT_TRUE(rc::check([] {
    const Parameters parameters;
    const float rear = uniform(0, 6000);
    const float front = uniform(0, 6000);
    const float more = uniform(0, 1000);
    const float distance_m = safe_distance_m(rear, front, parameters);
    RC_ASSERT(distance_m >= 0.0F);
    RC_ASSERT(safe_distance_m(rear + more, front, parameters) >= distance_m);
    RC_ASSERT(safe_distance_m(rear, front + more, parameters) <= distance_m);
  }));
}

// RSS-007 Clipped or not: speeds stay in [0, old], the start stays, points stay within the old path's box.
TEST(RssProperty, ClippingOnlySlowsDown) {
  EXPECT_TRUE(rc::check([] {
    Trajectory trajectory;
    float speed_mps = uniform(0, 3000);
    trajectory.points[0].speed_mps = speed_mps;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      const float acceleration = uniform(-800, 350);
      const float next = std::max(0.0F, speed_mps + acceleration * kStepS);
      trajectory.points[i].rear_axle.x_m =
          trajectory.points[i - 1].rear_axle.x_m + 0.5F * (speed_mps + next) * kStepS;
      trajectory.points[i].speed_mps = speed_mps = next;
      trajectory.points[i].acceleration_mps2 = acceleration;
    }
    const Trajectory old = trajectory;
    RssEnvelope envelope{};
    envelope.active = true;
    envelope.acceleration_max_mps2 = uniform(-800, 350);
    const bool changed = clip_to_envelope(envelope, Parameters{}, trajectory);
    RC_ASSERT(trajectory.points[0].speed_mps == old.points[0].speed_mps);
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      RC_ASSERT(trajectory.points[i].speed_mps >= 0.0F);
      RC_ASSERT(trajectory.points[i].rear_axle.x_m <= old.points[i].rear_axle.x_m + 1e-3F);
      if (!changed) RC_ASSERT(trajectory.points[i].rear_axle.x_m == old.points[i].rear_axle.x_m);
    }
  }));
}

}  // namespace
}  // namespace s4tp
