// Kolekar's controller: the four cases by hand, and the risk they decide on.

#include "sim_host/baselines/drf_controller.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "algo/trajectory/bicycle.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::baselines {
namespace {

const DrfLaw kLaw;  // C_t = 20,000

/// Risk with its least value at 0.1 rad: least + 1e6 (steering - 0.1)^2.
std::function<float(float)> bowl(float least) {
  return [least](float steering_rad) { return least + 1e6F * (steering_rad - 0.1F) * (steering_rad - 0.1F); };
}

// Case 1: risk 10,000 at the heading control's 0.1 rad, 9 m/s of 10: on with 1/s * 1 m/s = 1 m/s^2.
TEST(DrfController, LowRiskAndSlowAccelerates) {
  const DrfCommand command = drf_command(kLaw, bowl(10000.0F), 0.1F, -0.3F, 0.3F, 9.0F, 10.0F);
  EXPECT_EQ(command.which, 1);
  EXPECT_FLOAT_EQ(command.steering_rad, 0.1F);
  EXPECT_FLOAT_EQ(command.acceleration_mps2, 1.0F);
}

// Case 2: straight on costs 10,000 + 1e6 * 0.04 = 50,000 at -0.1 rad. Least is 10,000, under C_t: steered is
// where 1e6 (x - 0.1)^2 = 10,000, the nearer root x = 0; speed is kept.
TEST(DrfController, HighRiskThatSteeringAvoidsKeepsSpeed) {
  const DrfCommand command = drf_command(kLaw, bowl(10000.0F), -0.1F, -0.3F, 0.3F, 9.0F, 10.0F);
  EXPECT_EQ(command.which, 2);
  EXPECT_NEAR(command.steering_rad, 0.0F, 0.005F);
  EXPECT_FLOAT_EQ(command.acceleration_mps2, 0.0F);
}

// Case 2: least is 30,000, 1.5 C_t: steered is 0.1 rad, braked 2.5 * 0.5 = 1.25 m/s^2.
TEST(DrfController, HighRiskThatSteeringDoesNotAvoidSlowsDown) {
  const DrfCommand command = drf_command(kLaw, bowl(30000.0F), -0.1F, -0.3F, 0.3F, 9.0F, 10.0F);
  EXPECT_EQ(command.which, 2);
  EXPECT_NEAR(command.steering_rad, 0.1F, 0.002F);
  EXPECT_NEAR(command.acceleration_mps2, -1.25F, 0.01F);
}

// Case 3: as case 1, at 12 m/s of 10: -2 m/s^2.
TEST(DrfController, LowRiskAndFastSlowsToTheSpeedWanted) {
  const DrfCommand command = drf_command(kLaw, bowl(10000.0F), 0.1F, -0.3F, 0.3F, 12.0F, 10.0F);
  EXPECT_EQ(command.which, 3);
  EXPECT_FLOAT_EQ(command.steering_rad, 0.1F);
  EXPECT_FLOAT_EQ(command.acceleration_mps2, -2.0F);
}

// Case 4: at 12 m/s of 10 the steering is that of least risk, though C_t would allow less. Least 10,000: -2
// m/s^2 for the speed; least 60,000, 3 C_t: 2.5 * 2 = 5 m/s^2.
TEST(DrfController, HighRiskAndFastSlowsDownAndSteersForTheLeast) {
  for (const auto& [least, braking] : {std::pair{10000.0F, -2.0F}, std::pair{60000.0F, -5.0F}}) {
    const DrfCommand command = drf_command(kLaw, bowl(least), -0.1F, -0.3F, 0.3F, 12.0F, 10.0F);
    EXPECT_EQ(command.which, 4);
    EXPECT_NEAR(command.steering_rad, 0.1F, 0.002F);
    EXPECT_NEAR(command.acceleration_mps2, braking, 0.02F);
  }
}

// The search stays within its bounds: the least of [-0.05, 0.05] is 0.05.
TEST(DrfController, TheSearchIsBounded) {
  const DrfCommand command = drf_command(kLaw, bowl(30000.0F), -0.05F, -0.05F, 0.05F, 9.0F, 10.0F);
  EXPECT_FLOAT_EQ(command.steering_rad, 0.05F);
}

struct Drive {
  explicit Drive(const LaneMap* map, const std::vector<Track>& tracks, float y_m = 0.0F) {
    EXPECT_EQ(planner->init(Parameters{}), Status::kOk);
    input.map = map;
    input.start_ms = 0;
    input.ego = test::ego_at(20.0F, y_m, 0.0F, 10.0F);
    input.tracks = test::track_list(tracks);
    planner::Explanation explanation;
    (void)planner->plan(input, plan, explanation);
    EXPECT_TRUE(trajectory::feasible(plan.trajectory, Parameters{}));
  }
  std::unique_ptr<DrfControllerPlanner> planner = std::make_unique<DrfControllerPlanner>();
  planner::PlannerInput input;
  Plan plan;
};

// A car from 20 to 25 m ahead of the rear axle, at 10 m/s and straight: the look-ahead is 35 m, along the
// integral is 0.0064 (15^3 - 10^3) / 3 = 5.067; across, sigma = 0.45 + 0.0225 m: 0.4725 sqrt(2 pi) erf(0.9 /
// (0.4725 sqrt 2)) = 1.117. Risk 2500 * 5.067 * 1.117 = 14,150.
TEST(DrfController, RiskIsTheFieldOnTheBox) {
  const Drive drive(nullptr, {test::car(1, 42.5F, 0.0F, 0.0F, 0.0F)});
  EXPECT_NEAR(drive.planner->risk_of(drive.plan.trajectory.points[0], 0.0F), 14150.0F, 300.0F);
}

// In the middle of a lane the road costs next to nothing; towards its edge it does, the more the more so
// steered.
TEST(DrfController, TheRoadsEdgeIsFelt) {
  const LaneMap map = test::straight_road(1, 300.0F);
  const Drive drive(&map, {});
  const TrajectoryPoint& start = drive.plan.trajectory.points[0];
  EXPECT_LT(drive.planner->risk_of(start, 0.0F), 500.0F);
  EXPECT_GT(drive.planner->risk_of(start, 0.02F), 2000.0F);
  EXPECT_GT(drive.planner->risk_of(start, -0.04F), drive.planner->risk_of(start, -0.02F));
}

// A car that stands in its lane: on a road of one lane the controller brakes, on one of two it steers round.
TEST(DrfController, BrakesOrSteersRound) {
  const LaneMap narrow = test::straight_road(1, 300.0F);
  const Drive brakes(&narrow, {test::car(1, 36.0F, 0.0F, 0.0F, 0.0F)});
  EXPECT_LT(brakes.plan.trajectory.points[10].speed_mps, 9.9F);
  const LaneMap wide = test::straight_road(3, 300.0F);
  const Drive steers(&wide, {test::car(1, 36.0F, 2.8F, 0.0F, 0.0F)}, 3.2F);
  float furthest_m = 0.0F;
  for (const TrajectoryPoint& point : steers.plan.trajectory.points)
    furthest_m = std::max(furthest_m, std::abs(point.rear_axle.y_m - 3.2F));
  EXPECT_GT(furthest_m, 0.5F);
}

}  // namespace
}  // namespace s4tp::baselines
