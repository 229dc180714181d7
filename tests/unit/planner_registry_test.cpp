// Planners that register themselves, and the guard put around them.

#include "sim_host/baselines/planner_registry.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim_host/baselines/bare.hpp"
#include "sim_host/campaign/episode.hpp"

namespace s4tp::campaign {
namespace {

/// A planner that always asks for the same thing.
class Fixed {
 public:
  [[nodiscard]] Status init(const Parameters&) { return Status::kOk; }
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan, planner::Explanation&) {
    plan = wish;
    plan.start_ms = input.start_ms;
    return status;
  }
  Plan wish;
  Status status = Status::kOk;
};

/// Along +x at 10 m/s.
Plan straight() {
  Plan plan;
  plan.kind = PlanKind::kDrive;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    plan.trajectory.points[i].rear_axle.x_m = static_cast<float>(i);
    plan.trajectory.points[i].speed_mps = 10.0F;
  }
  return plan;
}

struct StraightRoad {
  StraightRoad() {
    Lane& lane = map.lanes[0];
    lane.present = lane.on_route = true;
    lane.length_m = lane.route_remaining_m = lane.goal_distance_m = 180.0F;
    lane.point_count = 10;
    for (int i = 0; i < lane.point_count; ++i) lane.points[i] = {20.0F * static_cast<float>(i) - 20.0F, 0.0F};
    input.map = &map;
    input.start_ms = 100;
    input.ego.speed_mps = 10.0F;
  }
  void add_standing_car(float x_m) {
    Track car;
    car.id = 1;
    car.centre.x_m = x_m;
    car.length_m = 5.0F;
    car.width_m = 1.8F;
    (void)input.tracks.push(car);
  }
  LaneMap map;
  planner::PlannerInput input;
};

struct Answer {
  Status status = Status::kOk;
  Plan plan;
};

Answer ask(const StraightRoad& road, const Plan& wish, Status status = Status::kOk) {
  auto guarded = std::make_unique<baselines::Guarded<Fixed>>();
  guarded->inner().wish = wish;
  guarded->inner().status = status;
  EXPECT_EQ(guarded->init(Parameters{}), Status::kOk);
  Answer answer;
  planner::Explanation explanation;
  answer.status = guarded->plan(road.input, answer.plan, explanation);
  return answer;
}

float last_speed_mps(const Answer& answer) {
  return answer.plan.trajectory.points[kHorizonSteps].speed_mps;
}

// Planners linked as objects are all there, s4tp first, and every name makes an ECU with and without guard.
TEST(PlannerRegistry, EveryPlannerIsThere) {
  const std::vector<std::string> names = baselines::planner_names();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "s4tp");
  for (const char* const name :
       {"blind", "constant_speed", "drf_controller", "idm_lane", "predictive_decision",
        "predictive_decision_kinematic", "s4tp_kinematic", "static_drf", "sumo_driver", "constant_margin"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
}

// A name can be taken once only: results could not be told apart.
TEST(PlannerRegistry, RefusesASecondOfTheSameName) {
  EXPECT_THROW(baselines::RegisterPlanner(baselines::planner<Fixed>("s4tp", "an impostor")),
               std::logic_error);
}

// On an empty road the guard changes nothing: the same points, bit by bit.
TEST(Guard, LetsASafePlanThrough) {
  const StraightRoad road;
  const Answer answer = ask(road, straight());
  EXPECT_EQ(answer.status, Status::kOk);
  EXPECT_EQ(answer.plan.kind, PlanKind::kDrive);
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    EXPECT_EQ(answer.plan.trajectory.points[i].rear_axle.x_m, static_cast<float>(i));
  }
}

// At 10 m/s a fail-safe from 0.35 s on stops within 3.5 + 100 / 12 = 11.8 m; a car stands 12 m ahead of our
// front, and 0.5 m are to be left: the minimum-risk manoeuvre takes over and ends at rest.
TEST(Guard, StopsAPlanThatWouldHit) {
  StraightRoad road;
  road.add_standing_car(18.5F);
  const Answer answer = ask(road, straight());
  EXPECT_EQ(answer.status, Status::kNoSafePlan);
  EXPECT_EQ(answer.plan.kind, PlanKind::kMinimumRisk);
  EXPECT_EQ(answer.plan.start_ms, road.input.start_ms);
  EXPECT_LT(last_speed_mps(answer), 0.5F);
}

// 70 m/s are beyond any car in 0.1 s: an infeasible plan is not driven either, nor one its planner disowns.
TEST(Guard, StopsWhatCannotBeDrivenOrWasGivenUp) {
  const StraightRoad road;
  Plan leap = straight();
  leap.trajectory.points[5].speed_mps = 70.0F;
  EXPECT_EQ(ask(road, leap).status, Status::kNoSafePlan);
  const Answer given_up = ask(road, straight(), Status::kNoLane);
  EXPECT_EQ(given_up.status, Status::kNoLane);
  EXPECT_EQ(given_up.plan.kind, PlanKind::kMinimumRisk);
}

// Without a lane under the car nothing is known of the plan's end.
TEST(Guard, WithoutAMapOnlyTheMinimumRiskManoeuvre) {
  StraightRoad road;
  road.input.map = nullptr;
  EXPECT_EQ(ask(road, straight()).plan.kind, PlanKind::kMinimumRisk);
}

// A car stands from 21.5 m on, and 18 m/s cannot be shed before it (18^2 / (2 * 8) = 20.25 m, and 4 m of the
// car are ahead of its rear axle): the guarded planner brakes at once, by 5 m/s within a second at least, the
// bare one drives the candidate that costs least.
TEST(BarePlanner, DrivesEvenWhatNoCheckWouldPass) {
  StraightRoad road;
  road.add_standing_car(24.0F);
  road.input.ego.speed_mps = 18.0F;
  Plan plan;
  planner::Explanation explanation;
  const auto guarded = std::make_unique<planner::Planner>();
  ASSERT_EQ(guarded->init(Parameters{}), Status::kOk);
  (void)guarded->plan(road.input, plan, explanation);
  EXPECT_LT(plan.trajectory.points[10].speed_mps, 13.0F);
  const auto bare = std::make_unique<baselines::BarePlanner>();
  ASSERT_EQ(bare->init(Parameters{}), Status::kOk);
  EXPECT_EQ(bare->plan(road.input, plan, explanation), Status::kOk);
}

}  // namespace
}  // namespace s4tp::campaign
