// What the network is given of a scene and of our plan.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "algo/core/math.hpp"
#include "algo/satp/input_builder.hpp"
#include "algo/satp/network_shape.hpp"
#include "algo/satp/step_features.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::satp {
namespace {

using test::CrossJunction;

constexpr float kLeadS = 0.1F;
const Parameters kParameters;

float pair_of(const NetworkInput& input, int hdv, PairFeature feature) {
  return input.pair[hdv][static_cast<int>(feature)];
}

/// We turn left from the south; one comes straight from the north, one waits east of the junction.
struct Junction {
  CrossJunction cross = test::cross_junction();
  scene::Scene scene;
  NetworkInput input;

  Junction() {
    test::set_route(cross, CrossJunction::kNorth, CrossJunction::kLeft);
    const EgoState ego = test::ego_at(1.6F, -30.0F, 1.5707963F, 8.0F);
    scene = test::scene_of(
        cross.map, ego,
        {test::car(1, -1.6F, 40.0F, -1.5707963F, 13.0F), test::car(2, 30.0F, 1.6F, 3.1F, 0.0F)});
    build_network_input(scene, kParameters, kLeadS, input);
  }
  int index_of(int id) const {
    for (int i = 0; i < scene.watched; ++i) {
      if (scene.agents[i].track.id == id) return i;
    }
    ADD_FAILURE() << "nobody watches " << id;
    return 0;
  }
};

template <typename T, std::size_t N>
void expect_finite(const T (&values)[N]) {
  if constexpr (std::is_array_v<T>) {
    for (const auto& row : values) expect_finite(row);
  } else {
    for (const T value : values) ASSERT_TRUE(std::isfinite(value));
  }
}

// SATP-001 Two vehicles: rows of the other three stay 0, one instant leaves one sample, and the same scene
// gives the same bits.
TEST(NetworkInput, MasksWhatIsMissing) {
  const Junction junction;
  const NetworkInput& input = junction.input;
  ASSERT_EQ(input.hdvs, 2);
  EXPECT_EQ(input.history_valid[0], 1U << 10U);
  EXPECT_EQ(input.history_valid[2], 0U);
  expect_finite(input.history);
  expect_finite(input.place);
  expect_finite(input.lane);
  expect_finite(input.pair);
  for (int i = 2; i < kMaxAgents; ++i) {
    for (const float value : input.pair[i]) EXPECT_EQ(value, 0.0F);
    for (const int points : input.lane_points[i]) EXPECT_EQ(points, 0);
  }
  NetworkInput again;
  build_network_input(junction.scene, kParameters, kLeadS, again);
  EXPECT_EQ(std::memcmp(&again.lane, &input.lane, sizeof(input.lane)), 0);
  EXPECT_EQ(std::memcmp(&again.pair, &input.pair, sizeof(input.pair)), 0);
}

// SATP-001 The car from the north has priority over our left turn: its zone lies ahead of both, its lane
// points from 3 m before the zone carry the rule "has priority" (column 5), and it keeps 13 m/s = 1.3 m in
// the lead: its newest sample lies 1.3 m behind the anchor.
TEST(NetworkInput, ReadsTheRuleAtTheZone) {
  const Junction junction;
  const int i = junction.index_of(1);
  const NetworkInput& input = junction.input;
  EXPECT_EQ(pair_of(input, i, PairFeature::kZone), 1.0F);
  EXPECT_EQ(pair_of(input, i, PairFeature::kHasPriority), 1.0F);
  EXPECT_EQ(pair_of(input, i, PairFeature::kYields), 0.0F);
  const float entry_m = pair_of(input, i, PairFeature::kEntryM);
  EXPECT_GT(entry_m, 20.0F);
  EXPECT_GT(pair_of(input, i, PairFeature::kExitM), entry_m);
  EXPECT_GT(pair_of(input, i, PairFeature::kOurEntryM), 10.0F);
  EXPECT_NEAR(input.history[i][10][0], -1.3F, 1e-4F);
  EXPECT_NEAR(input.history[i][10][3], 13.0F, 1e-4F);
  ASSERT_EQ(input.lane_points[i][0], kLanePoints);
  int marked = 0;
  for (int p = 0; p < kLanePoints; ++p) {
    EXPECT_NEAR(input.lane[i][0][p][0], 3.0F * static_cast<float>(p), 1e-3F);
    const bool at_zone = 3.0F * static_cast<float>(p) + 3.0F > entry_m &&
                         3.0F * static_cast<float>(p) <= pair_of(input, i, PairFeature::kExitM);
    EXPECT_EQ(input.lane[i][0][p][5], at_zone ? 1.0F : 0.0F) << p;
    marked += input.lane[i][0][p][5] > 0.0F ? 1 : 0;
  }
  EXPECT_GT(marked, 0);
  EXPECT_LT(marked, kLanePoints);
}

// SATP-001 Both ways of the junction cross ours. Of two parallel roads without a connection each is the
// other's nothing; who drives in a lane beside ours shares a way, as we may change into it.
TEST(NetworkInput, SaysWhoSharesAWay) {
  const Junction junction;
  EXPECT_EQ(junction.input.paths_meet[0], 1);
  EXPECT_EQ(junction.input.paths_meet[1], 1);
  LaneMap map = test::straight_road(2, 400.0F);
  const EgoState ego = test::ego_at(100.0F, 0.0F, 0.0F, 12.0F);
  const std::vector<Track> beside = {test::car(1, 80.0F, 3.2F, 0.0F, 13.0F)};
  NetworkInput input;
  build_network_input(test::scene_of(map, ego, beside), kParameters, kLeadS, input);
  ASSERT_EQ(input.hdvs, 1);
  EXPECT_EQ(input.paths_meet[0], 1);
  for (Lane& lane : map.lanes) lane.left = lane.right = kNoLaneIndex;
  build_network_input(test::scene_of(map, ego, beside), kParameters, kLeadS, input);
  ASSERT_EQ(input.hdvs, 1);
  EXPECT_EQ(input.paths_meet[0], 0);
}

// SATP-002 The whole world turned by 0.7 rad and moved by (300, -200): each vehicle sees the same.
TEST(NetworkInput, KnowsNoPlaceAndNoNorth) {
  const auto input_of = [](float turn_rad, Point shift) {
    const Pose frame{shift.x_m, shift.y_m, turn_rad};
    test::Merge merge = test::merge_road();
    for (Lane& lane : merge.map.lanes) {
      for (Point& point : lane.points) point = offset_point(frame, point.x_m, point.y_m);
    }
    const auto placed = [&](const Pose& pose) {
      const Point point = offset_point(frame, pose.x_m, pose.y_m);
      return Pose{point.x_m, point.y_m, wrap_angle(pose.heading_rad + turn_rad)};
    };
    EgoState ego = test::ego_at(-60.0F, -10.5F, 0.17F, 9.0F);
    ego.rear_axle = placed(ego.rear_axle);
    std::vector<Track> tracks = {test::car(1, -70.0F, 0.0F, 0.0F, 13.0F),
                                 test::car(2, -40.0F, 3.2F, 0.0F, 12.0F),
                                 test::car(3, -35.0F, -6.1F, 0.17F, 5.0F)};
    for (Track& track : tracks) track.centre = placed(track.centre);
    NetworkInput input;
    build_network_input(test::scene_of(merge.map, ego, tracks), kParameters, kLeadS, input);
    return input;
  };
  const NetworkInput here = input_of(0.0F, {0.0F, 0.0F});
  const NetworkInput there = input_of(0.7F, {300.0F, -200.0F});
  ASSERT_EQ(here.hdvs, 3);
  ASSERT_EQ(there.hdvs, 3);
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < kPairFeatures; ++c)
      EXPECT_NEAR(here.pair[i][c], there.pair[i][c], 2e-3F) << i << " " << c;
    for (int c = 0; c < kPlaceFeatures; ++c) EXPECT_NEAR(here.place[1 + i][c], there.place[1 + i][c], 2e-3F);
    for (int k = 0; k < kPathsPerAgent; ++k) {
      ASSERT_EQ(here.lane_points[i][k], there.lane_points[i][k]);
      for (int p = 0; p < here.lane_points[i][k]; ++p) {
        for (int c = 0; c < kLaneFeatures; ++c)
          EXPECT_NEAR(here.lane[i][k][p][c], there.lane[i][k][p][c], 2e-3F)
              << i << " " << k << " " << p << " " << c;
      }
    }
  }
}

// SATP-001 Our leader is "ahead of us", our follower has us "ahead"; 20 m between centres are 15 m of gap.
TEST(NetworkInput, SaysWhoIsAhead) {
  const LaneMap map = test::straight_road(1, 400.0F);
  const float centre_x = 100.0F + 1.5F;  // rear axle to box centre
  NetworkInput input;
  const scene::Scene scene = test::scene_of(
      map, test::ego_at(100.0F, 0.0F, 0.0F, 10.0F),
      {test::car(1, centre_x + 20.0F, 0.0F, 0.0F, 10.0F), test::car(2, centre_x - 20.0F, 0.0F, 0.0F, 10.0F)});
  build_network_input(scene, kParameters, kLeadS, input);
  for (int i = 0; i < 2; ++i) {
    const bool leads = scene.agents[i].track.id == 1;
    EXPECT_EQ(pair_of(input, i, PairFeature::kWeBehind), leads ? 1.0F : 0.0F);
    EXPECT_EQ(pair_of(input, i, PairFeature::kWeAhead), leads ? 0.0F : 1.0F);
    EXPECT_NEAR(pair_of(input, i, leads ? PairFeature::kBehindGapM : PairFeature::kAheadGapM), 15.0F, 1e-3F);
  }
}

// SATP-001 Along at 8 m/s from the anchor: after GRU step s we are 4 (s + 1) m nearer to the zone, and the
// poses seen from a vehicle's anchor lead back to the plan's.
TEST(NetworkInput, PlanIsSeenFromEachVehicle) {
  const Junction junction;
  EgoState ego = junction.scene.ego;
  ego.rear_axle = shift_ahead(ego.rear_axle, 0.8F);
  const Trajectory plan = test::plan_of(ego);
  PlanInput plan_input;
  build_plan_input(plan, kParameters, junction.input, plan_input);
  const int i = junction.index_of(1);
  for (int s = 0; s < kDecoderSteps; ++s) {
    const auto& row = plan_input.step[i][s];
    EXPECT_NEAR(row[7],
                pair_of(junction.input, i, PairFeature::kOurEntryM) - 4.0F * static_cast<float>(s + 1),
                1e-2F);
    const Pose end = from_anchor(junction.input.anchor[i], {row[3], row[4], row[5]});
    const Pose driven = shift_ahead(plan.points[5 * (s + 1)].rear_axle, 1.5F);
    EXPECT_NEAR(end.x_m, driven.x_m, 1e-3F);
    EXPECT_NEAR(end.y_m, driven.y_m, 1e-3F);
    EXPECT_NEAR(row[6], 8.0F, 1e-4F);
  }
  // Seen from 10 m further on, turned by 0.3 rad, we are where that pose says.
  StepState state;
  state.last = {10.0F, 1.0F, 0.3F};
  float features[kPlanFeatures];
  plan_features(state, plan_input.step[i][2], junction.input.pair[i], features);
  const Pose back = from_anchor(state.last, {features[2], features[3], 0.0F});
  EXPECT_NEAR(back.x_m, plan_input.step[i][2][3], 1e-3F);
  EXPECT_NEAR(back.y_m, plan_input.step[i][2][4], 1e-3F);
  EXPECT_EQ(features[11], 1.0F);
}

// SATP-003 The deployed size fits its bank of flash, every size has whole heads, and no name stands twice.
TEST(NetworkShape, OneTableForAllSizes) {
  EXPECT_LE(payload_bytes(kMcuShape) + 256, kWeightBudgetBytes);
  for (const NetworkShape& shape : {kMcuShape, kTeacherShape, kFullShape}) {
    EXPECT_EQ(shape.width % shape.heads, 0);
    EXPECT_EQ(shape.decoder_steps * shape.steps_per_decode, kHorizonSteps);
    for (int i = 0; i < kLayerCount; ++i) EXPECT_EQ(layer_bytes(layer_info(shape, i)) % 4, 0);
  }
  for (int i = 0; i < kLayerCount; ++i) {
    for (int j = 0; j < i; ++j) EXPECT_STRNE(layer_info(kMcuShape, i).name, layer_info(kMcuShape, j).name);
  }
  EXPECT_STREQ(layer_info(kMcuShape, kRoute + kNorm2).name, "route.norm_2");
  EXPECT_STREQ(layer_info(kMcuShape, kGruGates).name, "gru.gates");
  EXPECT_EQ(layer_info(kMcuShape, kGruGates).columns, 80);
}

}  // namespace
}  // namespace s4tp::satp
