// The size full: its finer grid, its second map channel, its ego head, and that it trains.

#include "sim_host/train/full_size.hpp"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim_host/train/fine_samples.hpp"
#include "sim_host/train/predict.hpp"
#include "sim_host/train/trainer.hpp"
#include "tests/train/synthetic.hpp"

namespace s4tp::train {
namespace {

using torch::Tensor;

const std::atomic<bool> kWholeTraining{false};

class FullSize : public testing::Test {
 protected:
  static void SetUpTestSuite() { use_threads(1); }
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() /
             (std::string("s4tp_full_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder);
    write_rule_traffic(folder / "rule.samples", 1, 40, 2);
    set = SampleSet(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::filesystem::path folder;
  SampleSet set;
};

// A straight lane of 17 points every 3 m becomes one of 49 points every metre; the last two of 51 are not there.
TEST_F(FullSize, ReadsALaneEveryMetre) {
  const FineLane lane = fine_lane(set[0].input.lane[0][0], satp::kLanePoints);
  ASSERT_EQ(lane.points, 49);
  for (int p = 0; p < lane.points; ++p) {
    EXPECT_NEAR(lane.row[p][0], static_cast<float>(p), 1e-5F);
    EXPECT_EQ(lane.row[p][1], 0.0F);
  }
  const Tensor mask = make_batch({&set[0]}, satp::kFullShape).lanes.point_mask;
  EXPECT_EQ(mask.sizes(), (std::vector<std::int64_t>{2, 51}));
  EXPECT_EQ(mask.sum().item<float>(), 2.0F * 49.0F);
}

// Limit, rules and stop line are those of the segment's first point; a heading turns by the shorter arc (3 to -3 rad is
// 0.28 rad to the left); behind the last point that is there, there is none.
TEST_F(FullSize, ALaneKeepsItsRulesBetweenThePoints) {
  float row[satp::kLanePoints][satp::kLaneFeatures] = {};
  row[0][2] = 3.0F;
  row[1][2] = -3.0F;
  row[0][3] = 8.0F;
  row[1][3] = 14.0F;
  row[0][7] = 1.0F;
  const FineLane lane = fine_lane(row, 2);
  ASSERT_EQ(lane.points, 4);
  EXPECT_NEAR(lane.row[1][2], 3.0F + 0.2832F / 3.0F, 1e-4F);
  EXPECT_NEAR(lane.row[2][2], -3.0F - 0.2832F / 3.0F, 1e-4F);
  EXPECT_EQ(lane.row[2][3], 8.0F);
  EXPECT_EQ(lane.row[2][7], 1.0F);
  EXPECT_EQ(lane.row[3][3], 14.0F);
  EXPECT_EQ(lane.row[3][7], 0.0F);
}

// A plan of constant speed, 8 m/s past the side of vehicle 1: 0.8 m a step, begins where the last step ended, and the way
// to the zone shrinks by as much from the first step on.
TEST_F(FullSize, ReadsAPlanEveryTenthOfASecond) {
  const FinePlan plan = fine_plan(set[0].plan.step[1], set[0].input.pair[1]);
  for (int s = 0; s < kHorizonSteps; ++s) {
    const float(&row)[satp::kPlanValues] = plan.step[s];
    const float begin_m = 0.8F * static_cast<float>(s);
    EXPECT_NEAR(row[0], 20.0F, 1e-4F);
    EXPECT_NEAR(row[1], 20.0F - begin_m, 1e-4F);
    EXPECT_NEAR(row[4], 20.0F - begin_m - 0.8F, 1e-4F);
    EXPECT_NEAR(row[5], -1.57F, 1e-5F);
    EXPECT_NEAR(row[6], 8.0F, 1e-5F);
    EXPECT_NEAR(row[7], 16.0F - begin_m - 0.8F, 1e-4F);
    EXPECT_NEAR(row[8], 24.0F - begin_m - 0.8F, 1e-4F);
  }
}

// What we drove is found back from the plan as vehicle 0 sees it: straight ahead, 4 m each half second. Where nobody
// knows our plan, nothing is known of it.
TEST_F(FullSize, KnowsWhatWeDrove) {
  const Batch batch = make_batch({&set[0]}, satp::kFullShape);
  EXPECT_EQ(batch.ego_known.item<float>(), 1.0F);
  for (int s = 0; s < satp::kDecoderSteps; ++s) {
    EXPECT_NEAR(batch.ego_target[0][s][0].item<float>(), 4.0F * static_cast<float>(s + 1), 1e-4F);
    EXPECT_NEAR(batch.ego_target[0][s][1].item<float>(), 0.0F, 1e-4F);
    EXPECT_NEAR(batch.ego_target[0][s][2].item<float>(), 0.0F, 1e-4F);
  }
  const auto unknown = std::make_unique<Sample>(set[0]);
  unknown->flags |= kNoPlan;
  EXPECT_FALSE(ego_motion(*unknown).known);
}

// The frame of a vehicle that faces us, 30 m ahead: 10 m ahead of it is 20 m ahead of us, its left is our right.
TEST_F(FullSize, FindsOurFrameFromAnyVehicle) {
  const auto sample = std::make_unique<Sample>(set[0]);
  float(&place)[satp::kPlaceFeatures] = sample->input.place[1];
  place[0] = 30.0F;
  place[1] = 0.0F;
  place[2] = 0.0F;
  place[3] = -1.0F;
  float(&end)[satp::kPlanValues] = sample->plan.step[0][5];
  end[3] = 10.0F;
  end[4] = 2.0F;
  end[5] = 3.0F;
  const EgoMotion motion = ego_motion(*sample);
  EXPECT_NEAR(motion.pose[5][0], 20.0F, 1e-4F);
  EXPECT_NEAR(motion.pose[5][1], -2.0F, 1e-4F);
  EXPECT_NEAR(motion.pose[5][2], 3.0F - 3.14159F, 1e-4F);
}

// The other sizes are given what the sample holds, to the bit, and nothing of full's.
TEST_F(FullSize, LeavesTheOtherSizesWhatTheyHad) {
  for (const satp::NetworkShape& shape : {satp::kMcuShape, satp::kTeacherShape}) {
    const Batch batch = make_batch({&set[0], &set[1]}, shape);
    EXPECT_EQ(batch.lanes.point.sizes(),
              (std::vector<std::int64_t>{4, satp::kLanePoints, satp::kLaneFeatures}));
    EXPECT_EQ(batch.lanes.point[1][5][0].item<float>(), set[0].input.lane[1][0][5][0] / satp::kLaneUnit[0]);
    EXPECT_EQ(batch.lanes.point_mask.sum().item<float>(), 4.0F * satp::kLanePoints);
    EXPECT_EQ(batch.plan.sizes(), (std::vector<std::int64_t>{4, satp::kDecoderSteps, satp::kPlanValues}));
    for (int s = 0; s < satp::kDecoderSteps; ++s) {
      for (int i = 0; i < satp::kPlanValues; ++i)
        EXPECT_EQ(batch.plan[3][s][i].item<float>(), set[1].plan.step[1][s][i]);
    }
    EXPECT_FALSE(batch.ego_target.defined());
    EXPECT_FALSE(batch.crosswalks.point.defined());
    Network network(shape);
    EXPECT_FALSE(network.encode(batch).ego.defined());
  }
}

// From 8 m/s at 2 m/s^2 it is 33 m in 3 s; at -8 m/s^2 a car stands after 1 s and 4 m, and stays.
TEST_F(FullSize, RollsOutAConstantAcceleration) {
  const Tensor acceleration = torch::tensor({2.0F, -8.0F}).unsqueeze(1).expand({2, kHorizonSteps});
  const Tensor poses = roll_out(acceleration, torch::zeros_like(acceleration), torch::tensor({8.0F, 8.0F}));
  EXPECT_NEAR(poses[0][kHorizonSteps - 1][0].item<float>(), 33.0F, 1e-3F);
  EXPECT_NEAR(poses[0][9][0].item<float>(), 9.0F, 1e-4F);
  EXPECT_EQ(poses[0][kHorizonSteps - 1][1].item<float>(), 0.0F);
  EXPECT_NEAR(poses[1][9][0].item<float>(), 4.0F, 1e-4F);
  EXPECT_NEAR(poses[1][kHorizonSteps - 1][0].item<float>(), 4.0F, 1e-4F);
}

// Steered by 0.1 rad at 5 m/s the rear axle (1.5 m behind the centre) drives a circle of the radius wheelbase / tan 0.1.
TEST_F(FullSize, RollsOutACircle) {
  const Tensor steering = torch::full({1, kHorizonSteps}, 0.1F);
  const Tensor end =
      roll_out(torch::zeros_like(steering), steering, torch::tensor({5.0F}))[0][kHorizonSteps - 1];
  const double radius_m = 2.9 / std::tan(0.1);
  const double turned = 15.0 / radius_m;
  EXPECT_NEAR(end[2].item<float>(), turned, 1e-4);
  EXPECT_NEAR(end[0].item<float>(), radius_m * std::sin(turned) + 1.5 * (std::cos(turned) - 1.0), 1e-2);
  EXPECT_NEAR(end[1].item<float>(), radius_m * (1.0 - std::cos(turned)) + 1.5 * std::sin(turned), 1e-2);
}

// The head's output is bounded before it is driven: however large, 8 m/s^2 from rest is 36 m in 3 s.
TEST_F(FullSize, BoundsWhatTheEgoHeadDrives) {
  const Tensor output = torch::tensor({1e6F, 0.0F}).repeat({1, kHorizonSteps});
  EXPECT_NEAR(ego_poses(output, torch::zeros({1}))[0][kHorizonSteps - 1][0].item<float>(), 36.0F, 1e-3F);
}

// A crosswalk changes what is expected of the vehicle that has it and of no other; masked it is as if there were none, to
// the bit.
TEST_F(FullSize, ACrosswalkHasASayWhereItIs) {
  const torch::NoGradGuard no_gradient;
  torch::manual_seed(3);
  Network network(satp::kFullShape);
  Batch batch = random_batch(satp::kFullShape, 2);
  const MapChannel crosswalks = batch.crosswalks;
  batch.crosswalks = {};
  const Tensor none = network.encode(batch).start;
  batch.crosswalks = crosswalks;
  batch.crosswalks.path_mask = torch::zeros_like(crosswalks.path_mask);
  EXPECT_TRUE(torch::equal(none, network.encode(batch).start));
  batch.crosswalks.path_mask[4][1] = 1.0F;
  const Tensor one = network.encode(batch).start;
  EXPECT_TRUE(torch::equal(none.slice(0, 0, 4), one.slice(0, 0, 4)));
  EXPECT_FALSE(torch::equal(none[4], one[4]));
}

// Full learns from the samples all sizes share. Shown only the branches in which we go, 24 m in 3 s at 8 m/s, its ego head
// soon drives that; what is expected of the others comes nearer, too.
TEST_F(FullSize, Learns) {
  TrainingOptions options;
  options.steps = 40;
  options.passes = 100;
  options.batch = 8;
  options.rough = 0.0;
  options.forks = false;
  options.validate_every = 5;
  Trainer trainer(satp::kFullShape, options, set);
  trainer.run(kWholeTraining, [](const CurvePoint&) {});
  EXPECT_LT(trainer.curve().back().position, 0.67 * trainer.curve().front().position);
  EXPECT_LT(trainer.curve().back().ego, 0.1);
}

// Its checkpoint, with the crosswalks' layers that no sample has reached, is gone on with to the same bits, and its
// forecasts have all 30 steps.
TEST_F(FullSize, GoesOnAsIfNothingHadBeen) {
  TrainingOptions options;
  options.steps = 4;
  options.batch = 8;
  options.validate_every = 2;
  Trainer whole(satp::kFullShape, options, set);
  whole.run(kWholeTraining, [](const CurvePoint&) {});
  std::atomic<bool> stop{false};
  Trainer first(satp::kFullShape, options, set);
  first.run(stop, [&](const CurvePoint& point) { stop = point.step == 2; });
  first.save(folder / "checkpoint.pt");
  Trainer second(satp::kFullShape, options, set);
  second.load(folder / "checkpoint.pt");
  second.run(kWholeTraining, [](const CurvePoint&) {});
  EXPECT_EQ(second.network().arrays(), whole.network().arrays());
  EXPECT_EQ(second.curve().back().ego, whole.curve().back().ego);
  const auto network = load_network(satp::kFullShape, folder / "checkpoint.pt");
  const Forecast forecast = network_forecasts(*network, set, {0}, true, 1.0)[0][0];
  EXPECT_GT(forecast.position_m[0][kHorizonSteps - 1][0], forecast.position_m[0][kHorizonSteps - 2][0]);
}

}  // namespace
}  // namespace s4tp::train
