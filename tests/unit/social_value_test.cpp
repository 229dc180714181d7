#include "sim_host/world/traffic/social_value.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::traffic {
namespace {

// SOC-001 From competitive to prosocial, in steps of 0.01 rad, every number goes one way or stays.
TEST(SocialValue, IsMonotone) {
  for (double svo = -0.2; svo < 0.795; svo += 0.01) {
    const SocialTraits less = social_traits(svo);
    const SocialTraits more = social_traits(svo + 0.01);
    EXPECT_LT(less.headway, more.headway);
    EXPECT_LT(less.min_gap, more.min_gap);
    EXPECT_GT(less.acceleration, more.acceleration);
    EXPECT_GT(less.speed, more.speed);
    EXPECT_LT(less.gap_margin_s, more.gap_margin_s);
    EXPECT_LT(less.patience_s, more.patience_s);
    EXPECT_LT(less.politeness, more.politeness);
    EXPECT_LT(less.change_threshold_mps2, more.change_threshold_mps2);
    EXPECT_GT(less.asked_braking_mps2, more.asked_braking_mps2);
    EXPECT_LE(less.courtesy, more.courtesy);
    EXPECT_GE(less.rivalry, more.rivalry);
  }
}

// SOC-001 Without an orientation nothing is changed; pi/4 weighs others as oneself: politeness tan(pi/4) = 1.
// With SUMO's 1 s headways are 0.8 to 1.8 s.
TEST(SocialValue, HasItsFixedPoints) {
  const SocialTraits none = social_traits(0.0);
  EXPECT_EQ(none.headway, 1.0);
  EXPECT_EQ(none.speed, 1.0);
  EXPECT_EQ(none.politeness, 0.0);
  EXPECT_EQ(none.courtesy + none.rivalry, 0.0);
  EXPECT_NEAR(social_traits(std::atan(1.0)).politeness, 1.0, 1e-12);
  EXPECT_NEAR(social_traits(-0.2).headway, 0.8, 1e-12);
  EXPECT_NEAR(social_traits(0.8).headway, 1.8, 1e-12);
  EXPECT_EQ(social_traits(-1.5).headway, social_traits(-0.2).headway);
}

/// Two lanes of 300 m eastwards, 0 the right one; lane 0 ends unless `both_go_on`, lane 1 leads to lane 2.
map::Network two_lanes(bool both_go_on) {
  map::Network network;
  for (int i = 0; i < 2; ++i) {
    map::Lane lane;
    lane.edge = "road";
    lane.index = i;
    lane.centre = map::Polyline({{0.0, 3.2 * i}, {300.0, 3.2 * i}});
    network.lanes.push_back(lane);
  }
  network.lanes[0].left = 1;
  network.lanes[1].right = 0;
  map::Lane after;
  after.edge = "after";
  after.centre = map::Polyline({{300.0, 3.2}, {500.0, 3.2}});
  after.predecessors = {1};
  network.lanes.push_back(after);
  network.lanes[1].successors = {2};
  if (both_go_on) {
    network.lanes[0].successors = {2};
  }
  return network;
}

scenario::FlowGroup flow(int lane, double max_speed_mps, double begin_s, double svo_rad) {
  scenario::FlowGroup group;
  group.routes = {{{"road", "after"}, lane, -1}};
  group.vehicles_per_minute = {0.1, 0.1};  // one car
  group.begin_s = {begin_s, begin_s};
  group.drivers[0].svo_rad = svo_rad;
  group.drivers[0].sigma = 0.0;
  group.drivers[0].speed_factor_deviation = 0.0;
  group.drivers[0].max_speed_mps = max_speed_mps;
  group.drivers[0].lane_keeping = max_speed_mps < 20.0;
  return group;
}

int lane_changes(const std::vector<scenario::FlowGroup>& flows, double until_s) {
  const map::Network network = two_lanes(true);
  Traffic traffic(network, flows, 1);
  int changes = 0;
  std::vector<CarState> before;
  while (traffic.time_s() < until_s) {
    traffic.step(nullptr);
    for (const CarState& car : traffic.cars()) {
      for (const CarState& then : before) {
        changes += then.id == car.id && then.lane + car.lane == 1 ? 1 : 0;
      }
    }
    before = traffic.cars();
  }
  return changes;
}

// MOBIL's incentive: behind a car of 6 m/s with the other lane empty, 3 s behind, the next one changes;
// behind one as fast there is nothing to gain.
TEST(Mobil, ChangesWhereItPays) {
  EXPECT_EQ(lane_changes({flow(0, 6.0, 0.0, 0.0), flow(0, 55.0, 3.0, 0.0)}, 15.0), 1);
  EXPECT_EQ(lane_changes({flow(0, 13.0, 0.0, 0.0), flow(0, 55.0, 6.0, 0.0)}, 15.0), 0);
}

/// How a car on lane 1 fares, 25 m behind one who drives 8 m/s on lane 0, which ends. \return its speed after
/// 2 s
double beside_merging(double svo_rad) {
  const map::Network network = two_lanes(false);
  scenario::FlowGroup only = flow(1, 10.0, 0.0, svo_rad);
  only.drivers[0].speed_factor_mean = 1.0 / social_traits(svo_rad).speed;
  Traffic traffic(network, {only}, 1);
  while (traffic.time_s() < 8.0) {
    traffic.step(nullptr);
  }
  EgoSeen ego;
  ego.actor.lane = 0;
  ego.actor.speed_mps = 8.0;
  ego.actor.s_m = traffic.cars().at(0).centre.x + 12.0;
  for (int i = 0; i < 200; ++i) {
    traffic.step(&ego);
    ego.actor.s_m += 0.08;
  }
  return traffic.cars().at(0).speed_mps;
}

// Where a lane ends beside them, a prosocial driver makes room for who has to come over, one without an
// orientation drives on (10 m/s), a competitive one closes up.
TEST(Merging, IsAnsweredByCharacter) {
  const double prosocial = beside_merging(0.8);
  const double individual = beside_merging(0.0);
  const double competitive = beside_merging(-0.2);
  EXPECT_LT(prosocial, individual - 0.5);
  EXPECT_GE(competitive, individual - 1e-9);
}

}  // namespace
}  // namespace s4tp::traffic
