// The network's parts, in every size.

#include "sim_host/train/network.hpp"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <filesystem>
#include <numeric>

#include "sim_host/train/full_size.hpp"
#include "sim_host/train/loss.hpp"
#include "sim_host/train/predict.hpp"
#include "sim_host/train/sample_file.hpp"
#include "tests/train/synthetic.hpp"

namespace s4tp::train {
namespace {

using torch::Tensor;

class Sizes : public testing::TestWithParam<satp::NetworkShape> {};

// TRAIN-003 Every tensor of the table is handed over, with the table's size.
TEST_P(Sizes, HandOverEveryTensorOfTheTable) {
  const Network network(GetParam());
  const auto arrays = network.arrays();
  std::size_t expected = static_cast<std::size_t>(GetParam().modes) * GetParam().hidden;
  EXPECT_EQ(arrays.at("start.mode").size(), expected);
  for (int layer = 0; layer < satp::kLayerCount; ++layer) {
    const satp::LayerInfo info = satp::layer_info(GetParam(), layer);
    const std::string name = info.name;
    const auto rows = static_cast<std::size_t>(info.rows);
    const auto check = [&](const std::string& array, std::size_t size) {
      ASSERT_EQ(arrays.count(array), 1U) << array;
      EXPECT_EQ(arrays.at(array).size(), size) << array;
      expected += size;
    };
    if (info.kind == satp::LayerKind::kLinear) {
      check(name + ".weight", rows * static_cast<std::size_t>(info.columns));
      check(name + ".bias", rows);
    } else if (info.kind == satp::LayerKind::kLayerNorm) {
      check(name + ".gain", rows);
      check(name + ".bias", rows);
    } else if (info.kind == satp::LayerKind::kVector) {
      check(name, rows);
    }
  }
  for (const FullLayerInfo& info : full_layers(GetParam())) {  // of the training alone
    const auto rows = static_cast<std::size_t>(info.rows);
    if (info.kind == satp::LayerKind::kLinear) expected += rows * static_cast<std::size_t>(info.columns + 1);
    if (info.kind == satp::LayerKind::kLayerNorm) expected += 2 * rows;
  }
  EXPECT_EQ(static_cast<std::size_t>(network.size()), expected) << "a parameter that nobody is given";
}

// One step of the loss reaches every parameter: nothing is left out of the forward pass.
TEST_P(Sizes, EveryParameterTakesPart) {
  torch::manual_seed(7);
  Network network(GetParam());
  const Batch batch = random_batch(GetParam(), 4);
  const Encoded encoded = network.encode(batch);
  Tensor has_plan = torch::ones({batch.vehicles()});
  has_plan[0] = 0.0F;
  const Decoded decoded = network.decode(batch, encoded, has_plan);
  const std::int64_t horizon = GetParam().decoder_steps * GetParam().steps_per_decode;
  EXPECT_EQ(decoded.pose.sizes(),
            (std::vector<std::int64_t>{batch.vehicles(), GetParam().modes, horizon, 3}));
  loss_of(batch, encoded, decoded).total.backward();
  for (const auto& item : network.named_parameters()) {
    ASSERT_TRUE(item.value().grad().defined()) << item.key();
    EXPECT_GT(item.value().grad().abs().sum().item<float>(), 0.0F) << item.key();
  }
}

INSTANTIATE_TEST_SUITE_P(All, Sizes, testing::Values(satp::kMcuShape, satp::kTeacherShape, satp::kFullShape),
                         [](const auto& shape) { return "Shape" + std::to_string(shape.param.id); });

class Forward : public testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(3);
    network = std::make_unique<Network>(satp::kMcuShape);
    const auto file =
        std::filesystem::temp_directory_path() /
        (std::string("s4tp_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".samples");
    write_rule_traffic(file, 5, 4, 1);
    set = SampleSet(file);
    std::filesystem::remove(file);
  }

  // Poses of all vehicles of these samples, side by side.
  Tensor poses(const std::vector<const Sample*>& samples, float has_plan) {
    const torch::NoGradGuard no_gradient;
    const Batch batch = make_batch(samples, satp::kMcuShape);
    return network->decode(batch, network->encode(batch), torch::full({batch.vehicles()}, has_plan)).pose;
  }

  std::unique_ptr<Network> network;
  SampleSet set;
};

// Scenes of one batch do not see each other: alone each is predicted as in company (up to the order of sums).
TEST_F(Forward, ScenesOfABatchAreApart) {
  const Tensor together = poses({&set[0], &set[2], &set[4]}, 1.0F);
  for (int i = 0; i < 3; ++i) {
    const Tensor alone = poses({&set[static_cast<std::size_t>(2 * i)]}, 1.0F);
    EXPECT_TRUE(torch::allclose(alone, together.slice(0, 2 * i, 2 * i + 2), 1e-4, 1e-4));
  }
}

// What is masked does not count: vehicles that are not there, samples before the first, points beyond the
// last.
TEST_F(Forward, WhatIsMaskedDoesNotCount) {
  const auto sample = std::make_unique<Sample>(set[0]);
  sample->input.history_valid[1] = 0b11111100000;
  sample->input.lane_points[0][0] = 9;
  const Tensor before = poses({sample.get()}, 1.0F);
  sample->input.place[4][0] = 7.0F;
  sample->input.history[1][2][0] = 12.0F;
  sample->input.lane[0][0][9][1] = 20.0F;
  sample->input.lane[0][2][0][1] = 20.0F;
  EXPECT_TRUE(torch::equal(before, poses({sample.get()}, 1.0F)));
  sample->input.lane[0][0][8][1] = 20.0F;  // this one is there
  EXPECT_FALSE(torch::equal(before, poses({sample.get()}, 1.0F)));
}

// Without plan the plan has no say, nor where no way is shared; with it, it has. Samples 0 and 1 differ by the plan alone.
TEST_F(Forward, ThePlanHasASayOnlyWhereItIsShown) {
  EXPECT_TRUE(torch::equal(poses({&set[0]}, 0.0F), poses({&set[1]}, 0.0F)));
  EXPECT_FALSE(torch::equal(poses({&set[0]}, 1.0F), poses({&set[1]}, 1.0F)));
  const auto go = std::make_unique<Sample>(set[0]);
  const auto wait = std::make_unique<Sample>(set[1]);
  for (Sample* const sample : {go.get(), wait.get()})
    std::fill(std::begin(sample->input.paths_meet), std::end(sample->input.paths_meet), std::uint8_t{0});
  EXPECT_TRUE(torch::equal(poses({go.get()}, 1.0F), poses({wait.get()}, 1.0F)));
}

// Where we go the crossing vehicle always lets us pass: a network that hardly expects it is brought to.
TEST_F(Forward, OddsOfYieldingAreCalibratedWhereWeGo) {
  std::vector<std::size_t> all(set.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  network->rescale_yields(0.2, -3.0);
  const auto mean = [&] {
    double sum = 0.0;
    for (const SceneForecast& scene : network_forecasts(*network, set, all, true, 1.0))
      sum += scene[1].yield_probability() / static_cast<double>(all.size());
    return sum;
  };
  EXPECT_LT(mean(), 0.1);
  calibrate_yields(*network, set, all, 1.0);
  EXPECT_GT(mean(), 0.7);
}

}  // namespace
}  // namespace s4tp::train
