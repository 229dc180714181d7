// What a risk costs, and what is left of it for less: the ranking level, and the exact one cut short.
#include <gtest/gtest.h>

#include <memory>

#include "algo/core/math.hpp"
#include "algo/sadrf/risk.hpp"
#include "tests/support/risk_stage.hpp"

namespace s4tp::sadrf {
namespace {

/// Sixteen cars on a circle of 12 m around a point 25 m ahead, all on their way to it at 8 m/s: in 1.5 s all are there.
std::unique_ptr<RiskStage> converging_crowd() {
  auto stage = stage_with_straight_drive(10.0F);
  two_way_road(*stage);
  for (int i = 0; i < kMaxTracks; ++i) {
    const float turn_rad = wrap_angle(kTwoPi * static_cast<float>(i) / static_cast<float>(kMaxTracks));
    const Pose centre = shift_ahead({25.0F, 0.0F, turn_rad}, -12.0F);
    stage->add_car(centre, 8.0F);
  }
  return stage;
}

struct Spent {
  RiskProfile profile;
  std::int32_t units;
};

Spent exact_within(const RiskStage& stage, std::int32_t units) {
  Spent spent{};
  WorkMeter work{units};
  exact_risk(stage.scene, stage.area, stage.prediction, stage.others, stage.trajectory, stage.parameters,
             spent.profile, work);
  spent.units = units - work.left;
  return spent;
}

// CORE-063: the ranking level is within 10 % of the exact one in ordinary traffic, so that it can order
// candidates.
TEST(Risk, RankIsNearTheExactIntegral) {
  for (const float offset_m : {-1.0F, 0.0F, 1.5F}) {
    const auto stage = stage_with_straight_drive(12.0F);
    stage->drive(12.0F, offset_m);
    two_way_road(*stage);
    stage->add_car({28.0F, 0.0F, 0.0F}, 10.0F);
    stage->add_car({-25.0F, 0.0F, 0.0F}, 13.0F);
    stage->add_car({80.0F, 3.2F, -3.14F}, 12.0F);
    const float exact = risk_integral(stage->exact(), stage->parameters);
    EXPECT_NEAR(stage->rank(), exact, 0.1F * exact) << offset_m;
  }
}

// CORE-074, CORE-075: a crowd on one place takes over twice what a risk may cost; cut to that it keeps within it, and
// is 20 % off at most; cut to a little over half of it, 25 %.
TEST(Risk, ACrowdCostsNoMoreThanIsAllowed) {
  const auto stage = converging_crowd();
  stage->parameters.risk.threshold = 20000.0F;  // nearer to what the crowd has, the excess is further off
  const Spent whole = exact_within(*stage, 10'000'000);
  EXPECT_GT(whole.units, 24'000);
  const float risk = risk_integral(whole.profile, stage->parameters);
  for (const std::int32_t units : {12'000, 7'000}) {
    const float share = units > 10'000 ? 0.2F : 0.25F;
    const Spent cut = exact_within(*stage, units);
    EXPECT_LE(cut.units, units);
    const float cut_risk = risk_integral(cut.profile, stage->parameters);
    EXPECT_NE(cut_risk, risk);
    EXPECT_NEAR(cut_risk, risk, share * risk) << units;
  }
}

// CORE-075: with as much work as it takes, the cut risk is the whole one to the bit, whatever the order of its steps.
TEST(Risk, EnoughWorkChangesNothing) {
  const auto stage = converging_crowd();
  const RiskProfile whole = stage->exact();
  const Spent enough = exact_within(*stage, 100'000);
  for (int i = 0; i < kHorizonSteps; ++i) {
    EXPECT_EQ(whole.obstacle[i], enough.profile.obstacle[i]);
    EXPECT_EQ(whole.social[i], enough.profile.social[i]);
    EXPECT_EQ(whole.road[i], enough.profile.road[i]);
  }
  EXPECT_EQ(whole.dominating_agent, enough.profile.dominating_agent);
  EXPECT_EQ(whole.dominating_step, enough.profile.dominating_step);
}

}  // namespace
}  // namespace s4tp::sadrf
