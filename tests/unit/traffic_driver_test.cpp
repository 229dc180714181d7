#include "sim_host/world/traffic/traffic_driver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::traffic {
namespace {

using map::Network;

constexpr double kAlone = std::numeric_limits<double>::infinity();

// At the wanted speed nothing is left to accelerate; from standstill it is all of 2.6 m/s^2.
TEST(TrafficDriver, AcceleratesTowardsTheWantedSpeed) {
  const Driver driver;
  EXPECT_NEAR(following_acceleration_mps2(driver, 10.0, 10.0, kAlone, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(following_acceleration_mps2(driver, 0.0, 10.0, kAlone, 0.0), 2.6, 1e-12);
  EXPECT_LT(following_acceleration_mps2(driver, 12.0, 10.0, kAlone, 0.0), 0.0);
}

// Equilibrium of the improved model: at equal speed well below the wanted one the gap is minGap + v tau = 2.5
// + 8 = 10.5 m.
TEST(TrafficDriver, KeepsMinimumGapAndHeadway) {
  const Driver driver;
  EXPECT_NEAR(following_acceleration_mps2(driver, 8.0, 30.0, 10.5, 8.0), 0.0, 1e-9);
  EXPECT_LT(following_acceleration_mps2(driver, 8.0, 30.0, 9.0, 8.0), 0.0);
  EXPECT_GT(following_acceleration_mps2(driver, 8.0, 30.0, 14.0, 8.0), 0.0);
}

// 20 m from rest at 2 m/s^2 with a top of 4 m/s: 2 s and 4 m to reach it, 16 m more at 4 m/s: 6 s.
TEST(TrafficDriver, TimesADistance) {
  EXPECT_NEAR(time_to_cover_s(20.0, 0.0, 2.0, 4.0), 6.0, 1e-12);
  EXPECT_NEAR(time_to_cover_s(4.0, 0.0, 2.0, 4.0), 2.0, 1e-12);
  EXPECT_EQ(time_to_cover_s(-1.0, 5.0, 2.0, 9.0), 0.0);
  EXPECT_TRUE(std::isinf(time_to_cover_s(1.0, 0.0, 0.0, 9.0)));
}

// Waiting wears the margin down, from 1 s to a quarter of it.
TEST(TrafficDriver, GetsImpatient) {
  const Driver driver;
  EXPECT_EQ(accepted_margin_s(driver, 0.0), 1.0);
  EXPECT_EQ(accepted_margin_s(driver, 1000.0), 0.25);
}

// Drivers differ in speed as their flow says (deviation 0.1), and none reacts faster than 0.5 s or brakes
// harder than 9.
TEST(TrafficDriver, IsDrawnFromItsFlow) {
  Random random(7);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Driver driver = draw_driver({}, random);
    sum += driver.speed_factor;
    squares += driver.speed_factor * driver.speed_factor;
    EXPECT_GE(driver.reaction_s, 0.5);
    EXPECT_LE(driver.reaction_s, 1.0);
    EXPECT_GE(driver.emergency_mps2, 4.5);
    EXPECT_LE(driver.emergency_mps2, 9.0);
  }
  const double mean = sum / 2000.0;
  EXPECT_NEAR(mean, 1.0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / 2000.0 - mean * mean), 0.1, 0.01);
}

/// One lane of 300 m.
Network straight_road() {
  Network network;
  map::Lane lane;
  lane.name = "road_0";
  lane.edge = "road";
  lane.centre = map::Polyline({{0.0, 0.0}, {300.0, 0.0}});
  network.lanes.push_back(lane);
  return network;
}

scenario::FlowGroup flow(double per_minute, bool random_spacing) {
  scenario::FlowGroup group;
  group.routes = {{{"road"}, 0, 0}};
  group.vehicles_per_minute = {per_minute, per_minute};
  group.random_spacing = random_spacing;
  return group;
}

// WORLD-020 12 a minute, evenly: one every 5 s; the same seed draws the same, another one other drivers.
TEST(TrafficFlow, DrawsDepartures) {
  const Network network = straight_road();
  Random one(1);
  Random same(1);
  Random other(2);
  const FlowPlan plan = draw_flows(network, {flow(12.0, false)}, 60.0, one);
  ASSERT_EQ(plan.departures.size(), 12U);
  EXPECT_NEAR(plan.departures[3].time_s - plan.departures[2].time_s, 5.0, 1e-9);
  EXPECT_EQ(plan.departures[5].driver.speed_factor,
            draw_flows(network, {flow(12.0, false)}, 60.0, same).departures[5].driver.speed_factor);
  EXPECT_NE(plan.departures[5].driver.speed_factor,
            draw_flows(network, {flow(12.0, false)}, 60.0, other).departures[5].driver.speed_factor);
}

// Random spacing keeps the rate: 20 a minute for 3000 s are 1000 cars, give or take 3 sigma = 95.
TEST(TrafficFlow, RandomSpacingKeepsTheRate) {
  Random random(3);
  const FlowPlan plan = draw_flows(straight_road(), {flow(20.0, true)}, 3000.0, random);
  EXPECT_NEAR(static_cast<double>(plan.departures.size()), 1000.0, 95.0);
}

/// The ego as others see it on the straight road.
Actor ego_at(double s_m, double speed_mps) {
  Actor ego;
  ego.lane = 0;
  ego.s_m = s_m;
  ego.speed_mps = speed_mps;
  return ego;
}

// Drivers stop behind a standing ego; bumpers (5 m cars) stay at least 0.5 m apart.
TEST(Traffic, StopsBehindTheEgo) {
  const Network network = straight_road();
  Traffic traffic(network, {flow(20.0, false)}, 5);
  const EgoSeen seen{{}, ego_at(200.0, 0.0)};
  for (int i = 0; i < 4000; ++i) {
    traffic.step(&seen);
    for (const CarState& car : traffic.cars()) {
      EXPECT_LT(car.centre.x, 200.0 - 5.5);
    }
  }
  EXPECT_EQ(traffic.finished(), 0);
  EXPECT_GT(traffic.cars().size(), 5U);
}

// A standing ego that appears 12 m ahead of a car's bumper at about 13 m/s is hit: nobody brakes within the
// reaction time of 0.5 s, and even 9 m/s^2 needs 9.4 m after the 6.5 m driven until then.
TEST(Traffic, IsNotSuperhuman) {
  const Network network = straight_road();
  Traffic traffic(network, {flow(6.0, false)}, 5);
  while (traffic.cars().empty() || traffic.cars().front().centre.x < 100.0) {
    traffic.step(nullptr);
  }
  const double speed = traffic.cars().front().speed_mps;
  ASSERT_GT(speed, 11.0);
  const EgoSeen seen{{}, ego_at(traffic.cars().front().centre.x + 17.0, 0.0)};
  for (int i = 0; i < 50; ++i) {
    traffic.step(&seen);
  }
  EXPECT_GT(traffic.cars().front().speed_mps, speed - 0.5);
  for (int i = 0; i < 200; ++i) {
    traffic.step(&seen);
  }
  EXPECT_GT(traffic.cars().front().centre.x, seen.actor.s_m - 5.0);
}

// Distraction is uniform (mean 1/2, variance 1/12), changes once a second at each driver's own instant, and
// asking in another order changes nothing.
TEST(TrafficDriver, IsDistractedByHash) {
  double sum = 0.0;
  double squares = 0.0;
  int changes_on_the_whole_second = 0;
  for (int car = 1; car <= 200; ++car) {
    double before = distraction(9, car, 0.0);
    int changes = 0;
    for (int tick = 1; tick <= 200; ++tick) {
      const double now = distraction(9, car, tick * 0.1);
      changes_on_the_whole_second += now != before && tick % 10 == 0 ? 1 : 0;
      changes += now != before ? 1 : 0;
      before = now;
      sum += now;
      squares += now * now;
    }
    EXPECT_EQ(changes, 20);
  }
  const double mean = sum / 40000.0;  // of 4000 independent draws: deviation 0.0046
  EXPECT_NEAR(mean, 0.5, 0.02);
  EXPECT_NEAR(squares / 40000.0 - mean * mean, 1.0 / 12.0, 0.01);
  EXPECT_LT(changes_on_the_whole_second, 1000);  // of 4000: a tenth of all, were instants drawn evenly
  EXPECT_NE(distraction(9, 1, 0.0), distraction(10, 1, 0.0));
}

/// Two roads of 300 m that have nothing to do with each other.
Network two_roads() {
  Network network = straight_road();
  map::Lane other = network.lanes.front();
  other.name = "other_0";
  other.edge = "other";
  other.centre = map::Polyline({{0.0, 500.0}, {300.0, 500.0}});
  network.lanes.push_back(other);
  return network;
}

// WORLD-022 Somebody stands at the start of one road for 20 s, so that its cars enter late: those of the
// other road have the same ids, order and motion to the bit.
TEST(Traffic, ALateEntryElsewhereChangesNobody) {
  const Network network = two_roads();
  scenario::FlowGroup elsewhere = flow(10.0, true);
  elsewhere.routes = {{{"other"}, 0, 0}};
  Traffic free(network, {flow(20.0, false), elsewhere}, 5);
  Traffic blocked(network, {flow(20.0, false), elsewhere}, 5);
  const EgoSeen seen{{}, ego_at(5.0, 0.0)};
  bool differed = false;
  int compared = 0;
  for (int i = 0; i < 6000; ++i) {
    free.step(nullptr);
    blocked.step(i < 2000 ? &seen : nullptr);
    std::vector<CarState> others[2];
    for (const CarState& car : free.cars()) {
      if (car.lane == 1) others[0].push_back(car);
    }
    for (const CarState& car : blocked.cars()) {
      if (car.lane == 1) others[1].push_back(car);
    }
    differed = differed || free.cars().size() != blocked.cars().size();
    ASSERT_EQ(others[0].size(), others[1].size());
    for (std::size_t k = 0; k < others[0].size(); ++k) {
      ASSERT_EQ(others[0][k].id, others[1][k].id);
      ASSERT_EQ(others[0][k].centre.x, others[1][k].centre.x);
      ASSERT_EQ(others[0][k].speed_mps, others[1][k].speed_mps);
      ++compared;
    }
  }
  EXPECT_TRUE(differed);
  EXPECT_GT(compared, 1000);
}

// WORLD-023 A copy in the middle of it goes on as the original; another ego makes it another, and the
// original does not notice.
TEST(Traffic, IsCopied) {
  const Network network = straight_road();
  Traffic original(network, {flow(20.0, true)}, 5);
  while (original.time_s() < 20.0) {
    original.step(nullptr);
  }
  const std::unique_ptr<TrafficEngine> same = original.clone();
  const std::unique_ptr<TrafficEngine> other = original.clone();
  const EgoSeen seen{{}, ego_at(200.0, 0.0)};
  bool differed = false;
  for (int i = 0; i < 2000; ++i) {
    other->step(&seen);
    same->step(nullptr);
    original.step(nullptr);
    ASSERT_EQ(original.cars().size(), same->cars().size());
    for (std::size_t k = 0; k < original.cars().size(); ++k) {
      ASSERT_EQ(original.cars()[k].id, same->cars()[k].id);
      ASSERT_EQ(original.cars()[k].centre.x, same->cars()[k].centre.x);
      ASSERT_EQ(original.cars()[k].acceleration_mps2, same->cars()[k].acceleration_mps2);
    }
    differed = differed || other->cars().size() != original.cars().size();
  }
  EXPECT_TRUE(differed);
}

// Emptying a stretch takes those whose box reaches into it and nobody else.
TEST(Traffic, ClearsAStretch) {
  const Network network = straight_road();
  Traffic traffic(network, {flow(30.0, false)}, 5);
  while (traffic.time_s() < 25.0) {
    traffic.step(nullptr);
  }
  const std::size_t before = traffic.cars().size();
  traffic.clear(0, 100.0, 150.0);
  EXPECT_LT(traffic.cars().size(), before);
  for (const CarState& car : traffic.cars()) {
    EXPECT_TRUE(car.centre.x + 2.5 <= 100.0 || car.centre.x - 2.5 >= 150.0);
  }
}

}  // namespace
}  // namespace s4tp::traffic
