// Corners tighter than the car: the way through them, and driving on from where one is stuck in one.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <utility>

#include "algo/core/math.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/roll_out.hpp"
#include "tests/support/driven_lines.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

constexpr std::uint32_t kNow = 5000;

/// 60 m straight, a right turn by 105 degrees, 80 m straight.
struct Corner {
  LaneMap map;
  scene::LanePath path;
  explicit Corner(float radius_m) {
    const LaneIndex before = add_lane(map, {{-60.0F, 0.0F}, {0.0F, 0.0F}});
    const LaneIndex turn = add_lane(map, arc({0.0F, 0.0F, 0.0F}, radius_m, -1.8326F, 5));
    const Point end = map.lanes[turn].points[map.lanes[turn].point_count - 1];
    const float heading = -1.8326F;
    const LaneIndex after =
        add_lane(map, {end, {end.x_m + 80.0F * std::cos(heading), end.y_m + 80.0F * std::sin(heading)}});
    link(map, turn, after);
    link(map, before, turn);
    path = path_of(map, {before, turn, after});
  }
};

// CAND-024 A bend of 9 m radius, 5.2 m/s at 3 m/s^2, begins 110 m ahead at 16.7 m/s: the line reaches 66 m, and 45 m before
// the bend sqrt(5.2^2 + 4 * 45) = 14.4 m/s may be driven, to brake with 2 m/s^2.
TEST(TightCorner, IsBrakedForFromAPlansEnd) {
  LaneMap map;
  const LaneIndex before = add_lane(map, {{-200.0F, 0.0F}, {0.0F, 0.0F}});
  const LaneIndex turn = add_lane(map, arc({0.0F, 0.0F, 0.0F}, 9.0F, 1.5708F, 9));
  link(map, before, turn);
  for (const LaneIndex lane : {before, turn}) map.lanes[lane].speed_limit_mps = 16.7F;
  const scene::LanePath path = path_of(map, {before, turn});
  trajectory::ReferenceLine line;
  trajectory::build_reference(map, path, 90.0F, 16.7F, Parameters{}, line);
  EXPECT_NEAR(trajectory::speed_cap_at(line, 155.0F), 14.4F, 0.5F);
  EXPECT_FLOAT_EQ(trajectory::speed_cap_at(line, 90.0F), 16.7F);
}

/// Speed that may be driven 60 m ahead of `before_m` before a junction's lane of 8 m length and 6 m/s, on a road of 28 m/s.
float cap_before_short_lane_mps(float before_m, float speed_mps) {
  LaneMap map;
  const LaneIndex before = add_lane(map, {{-200.0F, 0.0F}, {0.0F, 0.0F}});
  const LaneIndex within = add_lane(map, {{0.0F, 0.0F}, {8.0F, 0.0F}});
  const LaneIndex after = add_lane(map, {{8.0F, 0.0F}, {150.0F, 0.0F}});
  link(map, before, within);
  link(map, within, after);
  map.lanes[before].speed_limit_mps = map.lanes[after].speed_limit_mps = 28.0F;
  map.lanes[within].speed_limit_mps = 6.0F;
  const scene::LanePath path = path_of(map, {before, within, after});
  trajectory::ReferenceLine line;
  trajectory::build_reference(map, path, 200.0F - before_m, speed_mps, Parameters{}, line);
  return trajectory::speed_cap_at(line, 260.0F - before_m);
}

// CAND-024 At 14 m/s a plan may be at 23 m/s in 3 s, 57 m on, and from there 6 m/s take 124 m at 2 m/s^2: 110 m before such a lane
// 50 m are left at the end of the line's first 60, where sqrt(6^2 + 4 * 50) = 15.4 m/s may be driven. By the speed now alone a plan
// gained speed until 5 m/s^2 did not do any more, and ran off the road.
TEST(TightCorner, IsBrakedForByAPlanThatGainsSpeed) {
  EXPECT_NEAR(cap_before_short_lane_mps(110.0F, 14.0F), 15.4F, 0.5F);
}

// CAND-024 Wherever we are before it, so short a lane is not overlooked.
TEST(TightCorner, AShortLaneIsNotOverlooked) {
  for (float before_m = 75.0F; before_m < 140.0F; before_m += 1.0F) {
    EXPECT_NEAR(cap_before_short_lane_mps(before_m, 18.0F), std::sqrt(36.0F + 4.0F * (before_m - 60.0F)),
                0.7F)
        << before_m;
  }
}

float sharpest_1pm(const trajectory::ReferenceLine& line) {
  float most = 0.0F;
  for (const trajectory::ReferenceLine::Sample& sample : line.samples)
    most = std::max(most, std::abs(sample.curvature_1pm));
  return most;
}

/// The least and the greatest distance of the line from the lane's centre, left positive.
std::pair<float, float> beside_lane_m(const Corner& corner, const trajectory::ReferenceLine& line) {
  std::pair<float, float> beside_m;
  for (const trajectory::ReferenceLine::Sample& sample : line.samples) {
    const scene::Frenet at = scene::project(corner.map, corner.path, position(sample.pose), 60.0F, 60.0F);
    beside_m = {std::min(beside_m.first, at.d_m), std::max(beside_m.second, at.d_m)};
  }
  return beside_m;
}

// Steering of 0.55 rad and a wheelbase of 2.9 m turn on 4.7 m, 0.211 / m. A polygon at 5 m radius bends by
// more in its middle; it is widened to within 5 % of the limit, and leaves the lane's centre by less than 0.7
// m.
TEST(TightCorner, IsWidenedToWhatCanBeSteered) {
  const Corner corner(5.0F);
  const Parameters parameters;
  trajectory::ReferenceLine line;
  trajectory::build_reference(corner.map, corner.path, 50.0F, 4.0F, parameters, line);
  const float limit_1pm = std::tan(parameters.vehicle.steering_max_rad) / parameters.vehicle.wheelbase_m;
  EXPECT_LE(sharpest_1pm(line), 1.05F * limit_1pm);
  const auto [right_m, left_m] = beside_lane_m(corner, line);
  EXPECT_LT(std::max(-right_m, left_m), 0.7F);
}

// However narrow: where the lane turns on 2.2 m, a way on 4.85 m or more (0.97 of the limit, and 5 % for how curvature is sampled) cuts 2.65 *
// (1 / cos 52.5 - 1) = 1.7 m of the corner, or less as it swings out before and behind it. It was cut off at 3 m, and the road left.
TEST(TightCorner, IsWidenedHoweverNarrow) {
  const Corner corner(2.2F);
  const Parameters parameters;
  trajectory::ReferenceLine line;
  trajectory::build_reference(corner.map, corner.path, 50.0F, 4.0F, parameters, line);
  const float limit_1pm = std::tan(parameters.vehicle.steering_max_rad) / parameters.vehicle.wheelbase_m;
  EXPECT_LE(sharpest_1pm(line), 1.02F * limit_1pm);
  const auto [inside_m, outside_m] = beside_lane_m(corner, line);  // a right turn
  EXPECT_GT(inside_m, -1.3F);
  EXPECT_LT(outside_m, 0.5F);
  EXPECT_GT(outside_m, 0.1F);
}

// Whatever a map says, down to turns on 5 cm and kinks: every value of the line is finite, and widening ends.
TEST(TightCorner, TheLineOfAnyRoadIsFinite) {
  EXPECT_TRUE(rc::check([] {
    const auto between = [](int low, int high) {
      return 0.01F * static_cast<float>(*rc::gen::inRange(low, high));
    };
    LaneMap map;
    const float turn_rad = between(-314, 315);
    const LaneIndex before = add_lane(map, {{-60.0F, 0.0F}, {0.0F, 0.0F}});
    std::vector<Point> points = arc({0.0F, 0.0F, 0.0F}, between(5, 600), turn_rad, *rc::gen::inRange(2, 9));
    for (Point& point : points) point = point + Point{between(-40, 41), between(-40, 41)};
    const LaneIndex turn = add_lane(map, points);
    const float heading_rad = turn_rad + between(-100, 101);
    const Point on = between(300, 3000) * Point{std::cos(heading_rad), std::sin(heading_rad)};
    const LaneIndex after = add_lane(map, {points.back(), points.back() + on});
    link(map, before, turn);
    link(map, turn, after);
    const scene::LanePath path = path_of(map, {before, turn, after});
    trajectory::ReferenceLine line;
    const int work =
        trajectory::build_reference(map, path, between(0, 7500), between(0, 3600), Parameters{}, line);
    RC_ASSERT(work < 2000);
    for (const trajectory::ReferenceLine::Sample& sample : line.samples) {
      RC_ASSERT(std::isfinite(sample.pose.x_m) && std::isfinite(sample.pose.y_m));
      RC_ASSERT(std::isfinite(sample.pose.heading_rad) && std::isfinite(sample.curvature_1pm));
      RC_ASSERT(std::isfinite(sample.speed_cap_mps));
    }
  }));
}

// A corner that can be steered is left alone: at 10.7 m only the usual 0.67 / 10.7 = 6 cm are cut.
TEST(TightCorner, AWideOneIsNot) {
  const Corner corner(10.7F);
  trajectory::ReferenceLine line;
  trajectory::build_reference(corner.map, corner.path, 50.0F, 4.0F, Parameters{}, line);
  const auto [right_m, left_m] = beside_lane_m(corner, line);
  EXPECT_LT(std::max(-right_m, left_m), 0.25F);
}

// The line must not move under the car: built from every metre on the way, it lies where the last one lay,
// within 3 cm, from 2 m behind the car to 15 m ahead.
TEST(TightCorner, TheLineStaysWhereItIsAsWeGoAlong) {
  const Corner corner(4.0F);
  trajectory::ReferenceLine before;
  trajectory::build_reference(corner.map, corner.path, 40.0F, 3.0F, Parameters{}, before);
  for (float s_m = 41.0F; s_m < 90.0F; s_m += 1.0F) {
    trajectory::ReferenceLine now;
    trajectory::build_reference(corner.map, corner.path, s_m, 3.0F, Parameters{}, now);
    for (float at_m = s_m - 2.0F; at_m < s_m + 15.0F; at_m += 1.0F) {
      const Point moved = position(trajectory::reference_at(now, at_m).pose) -
                          position(trajectory::reference_at(before, at_m).pose);
      EXPECT_LT(std::hypot(moved.x_m, moved.y_m), 0.03F) << "at " << at_m << " m, seen from " << s_m << " m";
    }
    before = now;
  }
}

// Wheels take 0.9 s from straight to locked (0.55 rad at 0.6 rad/s): a bend that sets in within 2 m is driven
// at less than 2 / 0.9 = 2.2 m/s, though lateral acceleration would allow sqrt(3 / 0.17) = 4.2.
TEST(TightCorner, IsDrivenNoFasterThanTheWheelsTurn) {
  const Corner corner(3.5F);
  const Parameters parameters;
  trajectory::ReferenceLine line;
  trajectory::build_reference(corner.map, corner.path, 50.0F, 4.0F, parameters, line);
  for (int i = 0; i + 1 < trajectory::kReferenceSamples; ++i) {
    const float change = std::abs(line.samples[i + 1].curvature_1pm - line.samples[i].curvature_1pm);
    const float rate_radps =
        line.samples[i].speed_cap_mps * parameters.vehicle.wheelbase_m * change / line.spacing_m;
    if (line.samples[i].speed_cap_mps <= 1.0F) continue;
    EXPECT_LE(rate_radps, parameters.vehicle.steering_rate_max_radps);
  }
}

// Half way through, at rest, wheels locked over and 15 degrees off, no quintic can be driven; a way on is
// found.
TEST(TightCorner, FromRestWithLockedWheelsThereIsAWayOn) {
  const Corner corner(5.0F);
  scene::Scene scene;
  add_ego_path(scene, corner.map, corner.path);
  scene.time_ms = kNow;
  TrajectoryPoint start = state_on(corner.map, corner.path, 70.5F, 0.0F);
  start.rear_axle.heading_rad += 0.26F;
  start.rear_axle.x_m -= 0.4F;
  start.curvature_1pm = -0.19F;
  put_ego(scene, start);
  trajectory::ReferenceLines lines;
  test::build_lines_of(scene, start, Parameters{}, lines);
  trajectory::CandidateList list;
  int left_out = 0;
  trajectory::generate_candidates(scene, start, Plan{}, kNow, Parameters{}, kMaxCandidates, lines, list,
                                  left_out);
  float furthest_m = 0.0F;
  for (const trajectory::Candidate& candidate : list) {
    Trajectory trajectory;
    trajectory::roll_out(lines[0], candidate, start, Plan{}, kNow, Parameters{}, trajectory);
    const Pose& end = trajectory.points[kHorizonSteps].rear_axle;
    furthest_m =
        std::max(furthest_m, std::hypot(end.x_m - start.rear_axle.x_m, end.y_m - start.rear_axle.y_m));
  }
  EXPECT_GT(furthest_m, 3.0F);
}

// Steered candidates can be driven from whatever state the steering itself allows, and come back to the line:
// after 45 m within half a metre, even if they begin 2 m beside it, heading away by 0.6 rad and turning further.
TEST(TightCorner, SteeringComesBackFromAnywhere) {
  EXPECT_TRUE(rc::check([] {
    const auto hundredths = [](int low, int high) {
      return 0.01F * static_cast<float>(*rc::gen::inRange(low, high + 1));
    };
    const LaneMap map = straight_road(1, 300.0F);
    scene::Scene scene;
    add_ego_path(scene, map, path_of(map, {0}));
    const Parameters parameters;
    TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 100.0F, hundredths(0, 300));
    start.rear_axle.y_m += hundredths(-200, 200);
    start.rear_axle.heading_rad += hundredths(-60, 60);
    start.curvature_1pm = hundredths(-20, 20);
    trajectory::ReferenceLine line;
    trajectory::Candidate candidate;
    candidate.steered = true;
    float way_m = 0.0F;
    TrajectoryPoint at = start;
    for (int cycle = 0; cycle < 12 && way_m < 45.0F; ++cycle) {
      trajectory::build_reference(map, scene.ego_paths[0].path, 100.0F + way_m, at.speed_mps, parameters,
                                  line);
      candidate.start_s_m = trajectory::locate_on(line, position(at.rear_axle), 100.0F + way_m).s_m;
      candidate.acceleration_mps2 = at.speed_mps < 3.0F ? 1.0F : 0.0F;
      Trajectory trajectory;
      trajectory::roll_out(line, candidate, at, Plan{}, kNow, parameters, trajectory);
      RC_ASSERT(trajectory::feasible(trajectory, parameters));
      for (int i = 1; i < kTrajectoryPoints; ++i) {
        way_m += 0.5F * kStepS * (trajectory.points[i - 1].speed_mps + trajectory.points[i].speed_mps);
      }
      at = trajectory.points[kHorizonSteps];
    }
    const scene::Frenet end =
        scene::project(map, scene.ego_paths[0].path, position(at.rear_axle), 100.0F + way_m, 30.0F);
    RC_ASSERT(std::abs(end.d_m) < 0.5F);
    RC_ASSERT(std::abs(at.rear_axle.heading_rad - start.rear_axle.heading_rad) < 3.2F);
  }));
}

}  // namespace
}  // namespace s4tp
