// The risk of a trajectory: the field times the cost of what is in it.
#include "algo/sadrf/risk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "algo/core/math.hpp"
#include "algo/sadrf/field.hpp"
#include "tests/support/risk_stage.hpp"

namespace s4tp::sadrf {
namespace {

// CORE-062: nobody there and no road known: no risk at all.
TEST(Risk, EmptyWorldHasNone) {
  const auto stage = stage_with_straight_drive(13.89F);
  const RiskProfile& profile = stage->exact();
  for (int i = 0; i < kHorizonSteps; ++i) {
    EXPECT_EQ(profile.obstacle[i] + profile.road[i] + profile.social[i], 0.0F);
  }
  EXPECT_EQ(profile.dominating_agent, 255);
  EXPECT_EQ(risk_integral(profile, stage->parameters), 0.0F);
  EXPECT_EQ(stage->rank(), 0.0F);
}

// CORE-062, method.md: an empty road in its centre costs about 170 with the full look-ahead of 3.5 s at 13.89
// m/s.
TEST(Risk, EmptyRoadInLaneCentreCostsLittle) {
  const auto stage = stage_with_straight_drive(13.89F);
  stage->parameters.risk.look_ahead_shrinks = 0.0F;
  two_way_road(*stage);
  const float road = stage->exact().road[0];
  EXPECT_GT(road, 20.0F);
  EXPECT_LT(road, 200.0F);
}

// CORE-062: with half of the field off the road, R = C_off p d^3 / 3 sqrt(pi / 2) sigma; at 10 m/s and 2 s
// look-ahead d = 20 m, sigma = 0.45 + 0.001 * 5 (its mean under the weight (d - s)^2): 500 * 17.07 * 1.2533 *
// 0.455 = 4,867.
TEST(Risk, RoadEdgeUnderTheCar) {
  const auto stage = stage_with_straight_drive(10.0F);
  stage->parameters.risk.look_ahead_s = 2.0F;
  stage->parameters.risk.look_ahead_shrinks = 0.0F;
  stage->add_lane(0, LaneKind::kOurs, {-50.0F, -2.0F}, {250.0F, -2.0F}, 4.0F);
  stage->know_the_road();
  EXPECT_NEAR(stage->exact().road[0], 4867.0F, 0.01F * 4867.0F);
}

// CORE-062: wholly on the opposite lane (8 m wide), R = C_opp p d^3 / 3 sqrt(2 pi) sigma = 4,867: half the
// cost, twice the width of the test above.
TEST(Risk, OppositeLaneUnderTheCar) {
  const auto stage = stage_with_straight_drive(10.0F);
  stage->parameters.risk.look_ahead_s = 2.0F;
  stage->parameters.risk.look_ahead_shrinks = 0.0F;
  stage->add_lane(0, LaneKind::kOpposite, {-50.0F, 0.0F}, {250.0F, 0.0F}, 8.0F);
  stage->know_the_road();
  EXPECT_NEAR(stage->exact().road[0], 4867.0F, 0.01F * 4867.0F);
}

// CORE-062: a circle driven in the middle of its own lane costs as little as a straight: the field follows
// the path.
TEST(Risk, TurningInLaneCentreCostsLittle) {
  auto stage = std::make_unique<RiskStage>();
  const float radius = 30.0F;
  for (int lane = 0; lane < 12; ++lane) {
    Lane& piece = stage->map.lanes[lane];
    piece.present = true;
    piece.width_m = 3.2F;
    piece.point_count = 7;
    for (int i = 0; i < 7; ++i) {
      const float angle = kTwoPi * static_cast<float>(6 * lane + i) / 72.0F;
      piece.points[i] = {radius * std::sin(angle), radius * (1.0F - std::cos(angle))};
    }
  }
  stage->know_the_road();
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    const float angle = 8.0F * kStepS * static_cast<float>(i) / radius;
    TrajectoryPoint& point = stage->trajectory.points[i];
    point.rear_axle = {radius * std::sin(angle), radius * (1.0F - std::cos(angle)), wrap_angle(angle)};
    point.speed_mps = 8.0F;
    point.curvature_1pm = 1.0F / radius;
  }
  for (const float road : stage->exact().road) EXPECT_LT(road, 200.0F);
}

// method.md: a car followed at 2 s headway, bumper to bumper, is 20,000 to 30,000 with fixed t_la: at 13.89
// m/s its box lies 27.8 m ahead of our front bumper (4 m ahead of the rear axle).
TEST(Risk, FollowingAtTwoSecondsHeadway) {
  const auto stage = stage_with_straight_drive(13.89F);
  stage->parameters.risk.look_ahead_shrinks = 0.0F;
  stage->add_car({4.0F + 2.0F * 13.89F + 2.5F, 0.0F, 0.0F}, 13.89F);
  const RiskProfile& profile = stage->exact();
  for (int i = 0; i < kHorizonSteps; ++i) {
    EXPECT_GE(profile.obstacle[i], 20000.0F);
    EXPECT_LE(profile.obstacle[i], 30000.0F);
    EXPECT_EQ(profile.social[i], 0.0F);  // it does not see us: we are behind it
  }
}

// CORE-062: the car behind us at 2 s headway perceives us as we perceive the one ahead: the same number, on
// the other side. Its box's own width sets c, its length its rear axle: equal cars are chosen.
TEST(Risk, SocialSideIsTheFollowersView) {
  const auto stage = stage_with_straight_drive(13.89F);
  // Our box centre is 1.5 m ahead of our rear axle; its rear axle 1.5 m behind its centre.
  stage->add_car({1.5F - 5.0F - 2.0F * 13.89F, 0.0F, 0.0F}, 13.89F);
  const RiskProfile behind = stage->exact();
  const auto other = stage_with_straight_drive(13.89F);
  other->add_car({1.5F + 5.0F + 2.0F * 13.89F, 0.0F, 0.0F}, 13.89F);
  const RiskProfile ahead = other->exact();
  EXPECT_EQ(behind.obstacle[5], 0.0F);
  EXPECT_GT(behind.social[5], 1000.0F);
  EXPECT_NEAR(behind.social[5], ahead.obstacle[5], 1e-3F * ahead.obstacle[5]);
}

// CORE-062: modes of one vehicle add by probability: 0.5 + 0.5 in the same place is the vehicle itself; a
// second vehicle's box in the very same place is covered and adds nothing.
TEST(Risk, ModesAddAndVehiclesCover) {
  const Pose there = {25.0F, 0.5F, 0.1F};
  const auto alone = stage_with_straight_drive(12.0F);
  alone->add_car(there, 12.0F);
  const float once = alone->exact().obstacle[3];

  const auto split = stage_with_straight_drive(12.0F);
  const int car = split->add_car(there, 0.0F);
  const satp::Mode half = RiskStage::straight(there, 12.0F, 0.5F);
  split->predict(car, half, half);
  EXPECT_NEAR(split->exact().obstacle[3], once, 1e-4F * once);

  const auto twice = stage_with_straight_drive(12.0F);
  twice->add_car(there, 12.0F);
  twice->add_car(there, 12.0F);
  EXPECT_NEAR(twice->exact().obstacle[3], once, 1e-4F * once);
}

// CORE-062: a car whose rear half is covered by another adds only what sticks out: as one car of 7.5 m.
TEST(Risk, HalfCoveredCarAddsItsOwnHalf) {
  const auto overlapping = stage_with_straight_drive(12.0F);
  overlapping->add_car({25.0F, 0.0F, 0.0F}, 12.0F);
  overlapping->add_car({27.5F, 0.0F, 0.0F}, 12.0F);
  const auto longer = stage_with_straight_drive(12.0F);
  longer->add_car({26.25F, 0.0F, 0.0F}, 12.0F);
  longer->scene.agents[0].track.length_m = 7.5F;
  const float expected = longer->exact().obstacle[3];
  EXPECT_NEAR(overlapping->exact().obstacle[3], expected, 0.01F * expected);
}

// CORE-062: the profile is the field times the cost, summed: checked at one step against a 0.05 m grid of the
// whole scene, largest presence per cell.
TEST(Risk, AgreesWithTheGridOfTheWholeScene) {
  const auto stage = stage_with_straight_drive(12.0F);
  stage->add_car({24.0F, 0.4F, 0.2F}, 9.0F);
  stage->add_car({26.0F, 1.2F, -0.3F}, 9.0F);
  const int watched = stage->add_car({22.0F, -2.5F, 0.0F}, 9.0F);
  stage->predict(watched, RiskStage::straight({22.0F, -2.5F, 0.3F}, 9.0F, 0.4F),
                 RiskStage::straight({22.0F, -2.5F, 0.0F}, 9.0F, 0.6F));
  constexpr int kStep = 4;
  const TrajectoryPoint& ego = stage->trajectory.points[kStep + 1];
  FieldParams params = field_params(stage->parameters, 1.8F);
  params.look_ahead_s = look_ahead_at(params.look_ahead_s, true, 0.5F);
  const DriverState driver = {ego.rear_axle, ego.speed_mps, 0.0F, 2.9F};
  const auto in_box = [](const Pose& centre, Point point) {
    const Point local = to_local(centre, point);
    return std::fabs(local.x_m) <= 2.5F && std::fabs(local.y_m) <= 0.9F;
  };
  constexpr float kCell = 0.05F;
  double sum = 0.0;
  for (float x = 10.0F; x < 50.0F; x += kCell) {
    for (float y = -8.0F; y < 8.0F; y += kCell) {
      const Point point = {x, y};
      float presence = 0.0F;
      for (int agent = 0; agent < 2; ++agent) {
        if (in_box(stage->others.agents[agent].steps[kStep], point)) presence = 1.0F;
      }
      float third = 0.0F;
      for (const satp::Mode& mode : stage->prediction.agents[0].modes) {
        if (in_box(mode.steps[kStep], point)) third += mode.probability;
      }
      presence = std::max(presence, third);
      if (presence > 0.0F) sum += static_cast<double>(2500.0F * presence * field_at(params, driver, point));
    }
  }
  const float expected = static_cast<float>(sum) * kCell * kCell;
  EXPECT_NEAR(stage->exact().obstacle[kStep], expected, 0.02F * expected);
}

// The nearer of two leaders in our lane dominates, when the gap is smallest: it drives slower, so at the last
// step at which the growing risk outweighs the shrinking look-ahead.
TEST(Risk, NamesTheDominatingVehicle) {
  const auto stage = stage_with_straight_drive(12.0F);
  stage->add_car({60.0F, 0.0F, 0.0F}, 12.0F);
  stage->add_car({20.0F, 0.0F, 0.0F}, 12.0F);
  EXPECT_EQ(stage->exact().dominating_agent, 1);
  // At equal speeds the gap stays and the look-ahead shrinks: the first step is the worst.
  EXPECT_EQ(stage->profile.dominating_step, 0);
}

// dt * sum: 30 steps of R_obs 30,000, road 100, social 2,000, C_t 20,000: 0.1 * 30 * (30,000 + 100 + 0.5 * 2,000 + 2 *
// 10,000).
TEST(Risk, IntegralWeighsItsParts) {
  const auto stage = std::make_unique<RiskStage>();
  stage->parameters.risk.threshold = 20000.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    stage->profile.obstacle[i] = 30000.0F;
    stage->profile.road[i] = 100.0F;
    stage->profile.social[i] = 2000.0F;
  }
  EXPECT_NEAR(risk_integral(stage->profile, stage->parameters),
              3.0F * (30000.0F + 100.0F + 1000.0F + 20000.0F), 1.0F);
}

}  // namespace
}  // namespace s4tp::sadrf
