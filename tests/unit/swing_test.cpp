// Around those who stand in a junction.

#include "algo/trajectory/swing.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstring>

#include "algo/core/math.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/driven_lines.hpp"
#include "algo/trajectory/reference_line.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// 60 m along +x to a junction, a left turn of 90 degrees on a radius of 10 m, and 80 m on. We wait before it.
struct Turn {
  LaneMap map;
  scene::Scene scene;
  Parameters parameters;
  ReferenceLines lines;
  LaneIndex before = kNoLaneIndex;
  LaneIndex turn = kNoLaneIndex;

  explicit Turn(float turned_rad = 0.5F * kPi) {
    before = add_lane(map, {{-60.0F, 0.0F}, {0.0F, 0.0F}});
    turn = turned_rad == 0.0F ? add_lane(map, {{0.0F, 0.0F}, {20.0F, 0.0F}})
                              : add_lane(map, arc({0.0F, 0.0F, 0.0F}, 10.0F, turned_rad, 9));
    map.lanes[turn].in_junction = true;
    const Point end = map.lanes[turn].points[map.lanes[turn].point_count - 1];
    const LaneIndex after =
        add_lane(map, {end, end + 80.0F * Point{std::cos(turned_rad), std::sin(turned_rad)}});
    link(map, before, turn);
    link(map, turn, after);
    (void)add_ego_path(scene, map, path_of(map, {before, turn, after}));
    put_ego(scene, at_line());
  }
  [[nodiscard]] TrajectoryPoint at_line() const { return state_on(map, path_of(map, {before}), 55.0F, 0.0F); }
  scene::Agent& stands(float x_m, float y_m, float heading_rad) {
    scene::Agent agent;
    agent.track = {};
    agent.track.id = static_cast<std::uint8_t>(scene.agents.size() + 1);
    agent.track.centre = {x_m, y_m, heading_rad};
    agent.track.length_m = 5.0F;
    agent.track.width_m = 1.8F;
    agent.stood_ms = 20'000;
    (void)scene.agents.push(agent);
    return scene.agents[scene.agents.size() - 1];
  }
  const ReferenceLine& drive() {
    (void)build_lines(at_line(), 0.0F, parameters, scene, lines);
    return lines[0];
  }
  [[nodiscard]] const scene::EgoPath& path() const { return scene.ego_paths[0]; }
  /// Least gap of our box, over the next 30 m.
  [[nodiscard]] float gap_m() const {
    float least_m = 100.0F;
    for (float s_m = path().frenet.s_m; s_m < path().frenet.s_m + 30.0F; s_m += 0.25F) {
      for (const scene::Agent& agent : scene.agents) {
        const Box other{agent.track.centre, agent.track.length_m, agent.track.width_m};
        least_m = std::min(least_m, separation(box_on_line(path(), s_m, parameters), other));
      }
    }
    return least_m;
  }
};

// CAND-029 One waits in our turn, its front where we would drive: 0.7 m to the right, which our lane has room for, do not
// do. We drive out until past it, no tighter than we can steer, and 0.2 m from it at least; it does not lead us.
TEST(Swing, LeadsPastWhoStandsInATurn) {
  Turn turn;
  turn.stands(5.6F, 5.4F, -1.05F);
  const ReferenceLine& line = turn.drive();
  ASSERT_GT(line.swing.by_m, 0.7F);
  EXPECT_FLOAT_EQ(turn.path().lateral_offset_m, 0.0F);
  EXPECT_GT(turn.gap_m(), kStripM);
  const auto& vehicle = turn.parameters.vehicle;
  for (const ReferenceLine::Sample& sample : line.samples)
    EXPECT_LE(std::abs(sample.curvature_1pm), curvature_for(vehicle.steering_max_rad, vehicle.wheelbase_m));
  // In our lane where the junction is not: its edges are 0.7 m from our sides.
  for (const float s_m : {50.0F, 60.0F, 60.0F + 15.7F + 1.0F, 60.0F + 15.7F + 8.0F}) {
    const Pose lane = scene::path_point(turn.map, turn.path().path, s_m).pose;
    EXPECT_LT(distance(position(reference_at(line, s_m).pose), position(lane)), 0.6F) << s_m;
  }
  EXPECT_EQ(find_leader(turn.scene, turn.path(), turn.path().frenet.s_m, turn.parameters).agent, -1);
}

// CAND-029 Who has stood for less may be waiting for a gap, and sets off as soon as we are beside it.
TEST(Swing, OnlyAroundWhoHasStoodForLong) {
  Turn turn;
  turn.stands(5.6F, 5.4F, -1.05F).stood_ms = 19'900;
  EXPECT_EQ(turn.drive().swing.by_m, 0.0F);
  turn.scene.agents[0].stood_ms = 20'000;
  EXPECT_GT(turn.drive().swing.by_m, 0.0F);
  // Nor is one led around another who has not.
  turn.stands(2.0F, 3.2F, -1.5F).stood_ms = 5'000;
  EXPECT_EQ(turn.drive().swing.by_m, 0.0F);
}

// CAND-029 Who moves is no obstacle; outside junctions nobody leaves the lane; and beside another lane we change into none is led
// around.
TEST(Swing, OnlyAroundWhoStandsInAJunctionOnOurWay) {
  Turn moving;
  moving.stands(5.6F, 5.4F, -1.05F).track.speed_mps = 0.5F;
  EXPECT_EQ(moving.drive().swing.by_m, 0.0F);
  Turn road;
  road.map.lanes[road.turn].in_junction = false;
  road.stands(5.6F, 5.4F, -1.05F);
  EXPECT_EQ(road.drive().swing.by_m, 0.0F);
  Turn change;
  change.scene.ego_paths[0].manoeuvre = scene::Manoeuvre::kLeft;
  change.stands(5.6F, 5.4F, -1.05F);
  EXPECT_EQ(change.drive().swing.by_m, 0.0F);
}

// CAND-029 Straight on to either side: one reaches in from the left, then one from the right.
TEST(Swing, ToEitherSideOfAStraightWay) {
  for (const float side : {1.0F, -1.0F}) {
    Turn straight(0.0F);
    straight.stands(10.0F, side * 2.1F, -side * 0.5F * kPi);  // its front is 0.4 m beyond the middle
    const ReferenceLine& line = straight.drive();
    ASSERT_GT(line.swing.by_m, 1.0F) << side;
    EXPECT_LT(side * reference_at(line, 67.0F).pose.y_m, -0.9F);
    EXPECT_GT(straight.gap_m(), kStripM);
  }
}

// CAND-029 Two leave no way between them: the line is, to the bit, what it is with nobody there, and one of them leads.
TEST(Swing, WithoutAWayTheLineStaysAsItIs) {
  Turn empty;
  empty.drive();
  Turn blocked;
  blocked.stands(5.6F, 5.4F, -1.05F);
  blocked.stands(8.4F, 1.0F, 1.9F);
  blocked.drive();
  EXPECT_EQ(std::memcmp(&empty.lines[0], &blocked.lines[0], sizeof(ReferenceLine)), 0);
  EXPECT_GE(find_leader(blocked.scene, blocked.path(), blocked.path().frenet.s_m, blocked.parameters).agent,
            0);
}

// CAND-029 Who stands on the way around leads us, though it is not in our lane's strip.
TEST(Swing, WhoStandsOnTheWayAroundLeads) {
  Turn turn;
  turn.stands(5.6F, 5.4F, -1.05F);
  const ReferenceLine& line = turn.drive();
  const Pose out =
      reference_at(line, line.swing.from_s_m + 0.6F * (line.swing.to_s_m - line.swing.from_s_m)).pose;
  const Point there = offset_point(out, 2.0F, -1.8F);
  scene::Agent& second = turn.stands(there.x_m, there.y_m, out.heading_rad);
  second.track.width_m = 1.0F;
  second.track.length_m = 2.0F;
  EXPECT_EQ(find_leader(turn.scene, turn.path(), turn.path().frenet.s_m, turn.parameters).agent, 1);
}

// CAND-029 The map's zone on the way is longer by as much as we leave the lane; a lane of the junction without a zone that we
// come near is one where nobody expects us; not so one into which our own lane forks.
TEST(Swing, ZonesAreTheWayAroundsToo) {
  Turn turn;
  const LaneIndex near = add_lane(turn.map, {{12.5F, -20.0F}, {12.5F, 20.0F}});
  turn.map.lanes[near].in_junction = true;
  const LaneIndex fork = add_lane(turn.map, {{0.0F, 0.0F}, {20.0F, 0.0F}});
  turn.map.lanes[fork].in_junction = true;
  link(turn.map, turn.before, fork);
  const LaneIndex crossed = add_lane(turn.map, {{7.0F, 20.0F}, {7.0F, -20.0F}});
  turn.map.lanes[crossed].in_junction = true;
  scene::ConflictZone zone;
  zone.other_lane = crossed;
  zone.entry_s_m = 64.0F;
  zone.exit_s_m = 70.0F;
  zone.stop_s_m = 59.0F;
  (void)turn.scene.ego_paths[0].zones.push(zone);
  turn.stands(5.6F, 5.4F, -1.05F);
  const float by_m = turn.drive().swing.by_m;
  ASSERT_GT(by_m, 0.7F);
  int beside = 0;
  for (const scene::ConflictZone& found : turn.path().zones) {
    EXPECT_NE(found.other_lane, fork);
    if (found.other_lane == crossed) {
      EXPECT_FLOAT_EQ(found.entry_s_m, 64.0F - by_m);
      EXPECT_FLOAT_EQ(found.exit_s_m, 70.0F + by_m);
    }
    beside += found.beside && found.other_lane == near ? 1 : 0;
  }
  EXPECT_EQ(beside, 1);
}

// CAND-029 Wherever up to four stand: where the line is swung, our box leaves all of them what the guard asks for, and it can be
// steered; where it is not, it is what it would be without anybody.
TEST(Swing, PassesAllOrStaysAsItIs) {
  int swung = 0;
  rc::check([&swung] {
    const auto between = [](int low, int high) {
      return 0.01F * static_cast<float>(*rc::gen::inRange(low, high));
    };
    const float turned_rad = *rc::gen::element(0.5F * kPi, -0.5F * kPi, 0.0F, 1.0F);
    Turn turn(turned_rad);
    Turn empty(turned_rad);
    empty.drive();
    const int count = *rc::gen::inRange(1, 5);
    for (int i = 0; i < count; ++i) turn.stands(between(0, 1800), between(-1000, 1500), between(-314, 315));
    const ReferenceLine& line = turn.drive();
    if (line.swing.by_m == 0.0F) {
      empty.lines[0].lateral_offset_m = line.lateral_offset_m;
      RC_ASSERT(std::memcmp(&empty.lines[0], &line, sizeof(ReferenceLine)) == 0);
      return;
    }
    ++swung;
    const auto& vehicle = turn.parameters.vehicle;
    for (const ReferenceLine::Sample& sample : line.samples)
      RC_ASSERT(std::abs(sample.curvature_1pm) <=
                1.02F * curvature_for(vehicle.steering_max_rad, vehicle.wheelbase_m));
    const scene::Agent* leads = nullptr;
    const Leader leader = find_leader(turn.scene, turn.path(), turn.path().frenet.s_m, turn.parameters);
    if (leader.agent >= 0) leads = &turn.scene.agents[leader.agent];
    RC_ASSERT(leads != nullptr || turn.gap_m() > 0.1F);
  });
  EXPECT_GT(swung, 0);
}

}  // namespace
}  // namespace s4tp::trajectory
