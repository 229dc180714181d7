#include "sim_host/world/traffic/traffic_junction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::traffic {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = S4TP_SOURCE_DIR;

scenario::FlowGroup flow(const std::string& from, const std::string& to) {
  scenario::FlowGroup group;
  group.routes = {{{from, to}, -1, -1}};
  group.vehicles_per_minute = {4.0, 8.0};
  group.begin_s = {0.0, 3.0};
  group.random_spacing = true;
  return group;
}

bool any_touch(const std::vector<CarState>& cars) {
  for (std::size_t a = 0; a < cars.size(); ++a) {
    for (std::size_t b = a + 1; b < cars.size(); ++b) {
      if (overlap(box_of(cars[a]), box_of(cars[b]))) return true;
    }
  }
  return false;
}

// Right before left with a car on each of four arms: all wait for each other, until the one who has waited
// longest goes. Without that hardly anybody gets through in 300 s; with it more than one car in 10 s.
TEST(TrafficJunction, SomebodyGoesFirst) {
  const scenario::Scenario scenario =
      scenario::load_scenario(kSource / "tests/networks/right_before_left.toml");
  const std::vector<scenario::FlowGroup> groups{flow("e_in", "w_out"), flow("w_in", "e_out"),
                                                flow("n_in", "s_out"), flow("s_in", "n_out")};
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Traffic traffic(scenario.network, groups, seed);
    while (traffic.time_s() < 300.0) {
      for (int i = 0; i < 10; ++i) traffic.step(nullptr);
      ASSERT_FALSE(any_touch(traffic.cars())) << "seed " << seed << " at " << traffic.time_s() << " s";
    }
    EXPECT_GT(traffic.finished(), 30) << "seed " << seed;
  }
}

/// From lane 0 one goes straight on over lane 2, or to the left over lanes 1 and 3: a waiting place cuts that turn in two.
///
/// \code
///                    _3_/   (112, 8.3)
///   0 ----------->1_/
///                 ------2-----------> (120, 0)
/// \endcode
map::Network turn_in_two_parts() {
  const auto lane = [](bool in_junction, const std::vector<map::Vec2>& points,
                       std::vector<map::LaneId> successors) {
    map::Lane result;
    result.centre = map::Polyline(points);
    result.in_junction = in_junction;
    result.successors = std::move(successors);
    return result;
  };
  map::Network network;
  network.lanes = {
      lane(false, {{0.0, 0.0}, {100.0, 0.0}}, {1, 2}), lane(true, {{100.0, 0.0}, {104.0, 0.3}}, {3}),
      lane(true, {{100.0, 0.0}, {120.0, 0.0}}, {}), lane(true, {{104.0, 0.3}, {112.0, 8.3}}, {})};
  return network;
}

// Whoever waits in the second part of a turn is ahead of one that goes straight on while its tail is less than 2.3 m beside its way: 5 m
// on, where the tail is 2.5 m / sqrt(2) + 0.3 m beside; not 6 m on, with 3.5 m / sqrt(2) + 0.3 m. 10 + 4.01 + 5 m ahead, less 5 m of
// cars, are left.
TEST(TrafficView, SeesWhoWaitsInTheSecondPartOfATurn) {
  const map::Network network = turn_in_two_parts();
  const RoadIndex road(network);
  const auto gap_m = [&](double s_m) {
    Actor waits;
    waits.id = 1;
    waits.lane = 3;
    waits.s_m = s_m;
    const TrafficView view(road, {waits});
    return view.leader({{0, -90.0}, {2, 10.0}}, 2, 5.0).gap_m;
  };
  EXPECT_NEAR(gap_m(5.0), 14.01, 0.01);
  EXPECT_TRUE(std::isinf(gap_m(6.0)));
}

class LeftTurnFromNorth : public testing::Test {
 protected:
  /// Somebody on an arm `before_line_m` (bumper) before its line.
  Actor actor(int id, const char* lane, const map::RouteGuide& guide, double before_line_m,
              double speed_mps) {
    Actor result;
    result.id = id;
    result.lane = network_.find(lane);
    result.s_m =
        network_.lanes[static_cast<std::size_t>(result.lane)].centre.length_m() - before_line_m - 2.5;
    result.speed_mps = speed_mps;
    result.guide = &guide;
    return result;
  }

  JunctionChoice choice(const std::vector<Actor>& actors) const {
    const TrafficView view(road_, actors);
    Approach approach;
    approach.self = &view.actors().front();
    approach.driver = &driver_;
    approach.wanted_mps = 13.89;
    return choose_at_junction(view, approach);
  }

  const map::Network network_ = map::load_network(kSource / "sim_host/scenarios/left_turn/network.net.xml");
  const RoadIndex road_{network_};
  const map::RouteGuide left_{network_, {"north_in", "east_out"}, map::kNoLane, 0.0};
  const map::RouteGuide straight_{network_, {"south_in", "north_out"}, map::kNoLane, 0.0};
  const map::RouteGuide ego_{network_, {"south_in", "west_out"}, map::kNoLane, 0.0};
  const Driver driver_{};
};

// A left turner waits for a car that comes straight from the opposite arm, 8 m before its line and 2 m/s
// fast; but not for one that stands behind somebody who stands: it cannot come first.
TEST_F(LeftTurnFromNorth, DoesNotWaitForAQueue) {
  const Actor self = actor(1, "north_in_0", left_, 0.4, 0.0);
  const Actor standing_ego = actor(0, "south_in_0", ego_, 0.4, 0.0);
  Actor second = actor(2, "south_in_0", straight_, 8.0, 2.0);
  EXPECT_TRUE(choice({self, standing_ego, second}).stop);
  second.speed_mps = 0.0;
  second.queues = true;
  EXPECT_FALSE(choice({self, standing_ego, second}).stop);
}

// Who stands in a queue says so, who stands first in line names those waited for.
TEST_F(LeftTurnFromNorth, TellsQueueFromLine) {
  const Actor self = actor(1, "north_in_0", left_, 0.4, 0.0);
  const Actor coming = actor(2, "south_in_0", straight_, 8.0, 2.0);
  const JunctionChoice first = choice({self, coming});
  EXPECT_FALSE(first.queues);
  EXPECT_NE(std::find(first.waits_for.begin(), first.waits_for.end(), 2), first.waits_for.end());
  const std::vector<Actor> queue{actor(3, "north_in_0", left_, 8.0, 0.0), self};
  const TrafficView view(road_, queue);
  Approach second;
  second.self = &view.actors().front();
  second.driver = &driver_;
  second.wanted_mps = 13.89;
  second.leader = view.leader(second.self->way, 3, 5.0);
  EXPECT_TRUE(choose_at_junction(view, second).queues);
}

// Seeds whose cars touched: a driver in a queue who had eyes only for somebody merging before the one ahead
// of it (21, 190, 352), a left turner that was committed in the moment in which somebody appeared (213).
TEST(TrafficJunction, HasNoTouchesThatItHad) {
  for (const auto& [name, seed] : std::vector<std::pair<std::string, std::uint64_t>>{
           {"left_turn", 21}, {"left_turn", 213}, {"left_turn_t", 190}, {"left_turn_t", 352}}) {
    scenario::Scenario scenario = scenario::load_scenario(kSource / "sim_host/scenarios" / name, "social");
    scenario::FlowGroup neutral;  // a driver on the mission's way
    neutral.routes = {{scenario.mission.edges, 0, 0}};
    neutral.vehicles_per_minute = {0.1, 0.1};
    neutral.begin_s = {scenario.mission.entry_time_s, scenario.mission.entry_time_s};
    scenario.flows.push_back(neutral);
    Traffic traffic(scenario.network, scenario.flows, seed);
    while (traffic.time_s() < 120.0) {
      for (int i = 0; i < 10; ++i) traffic.step(nullptr);
      ASSERT_FALSE(any_touch(traffic.cars()))
          << name << ", seed " << seed << ", " << traffic.time_s() << " s";
    }
  }
}

}  // namespace
}  // namespace s4tp::traffic
