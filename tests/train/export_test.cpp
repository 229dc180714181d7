// From torch to the ECU's integers: the same network all the way.

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "sim_host/train/evaluation.hpp"
#include "sim_host/train/image_export.hpp"
#include "sim_host/train/predict.hpp"
#include "sim_host/train/yields_row.hpp"
#include "tests/train/synthetic.hpp"

namespace s4tp::train {
namespace {

class Export : public testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(11);
    network = std::make_unique<Network>(satp::kMcuShape);
    file = std::filesystem::temp_directory_path() /
           (std::string("s4tp_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    write_rule_traffic(file, 5, 8, 2);
    set = SampleSet(file);
    samples.resize(set.size());
    std::iota(samples.begin(), samples.end(), std::size_t{0});
  }
  void TearDown() override { std::filesystem::remove(file); }

  // How far torch's forecasts are from these after 3 s, root mean square.
  double torch_from_m(const Forecasts& integers) {
    const Forecasts floats = network_forecasts(*network, set, samples, true, 1.0);
    double squares = 0.0;
    int count = 0;
    for (const std::size_t i : samples) {
      for (std::size_t vehicle = 0; vehicle < 2; ++vehicle) {
        for (int mode = 0; mode < kMaxModes; ++mode) {
          const float(&a)[2] = floats[i][vehicle].position_m[mode][kHorizonSteps - 1];
          const float(&b)[2] = integers[i][vehicle].position_m[mode][kHorizonSteps - 1];
          squares += std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2);
          ++count;
        }
      }
    }
    return std::sqrt(squares / count);
  }

  std::unique_ptr<Network> network;
  std::filesystem::path file;
  SampleSet set;
  std::vector<std::size_t> samples;
};

// Torch and the plain float network, written apart from the same equations, agree: positions within 1 mm,
// probabilities within 1e-4, with plan and without.
TEST_F(Export, TorchAgreesWithThePlainNetwork) {
  FloatNetwork plain(satp::kMcuShape, network->arrays());
  for (const bool with_plan : {false, true}) {
    const Forecasts forecasts = network_forecasts(*network, set, samples, with_plan, 0.7);
    for (const std::size_t i : samples) {
      const FloatEncoded encoded = plain.encode(set[i].input);
      for (int vehicle = 0; vehicle < set[i].input.hdvs; ++vehicle) {
        const FloatFutures futures =
            plain.decode(encoded, set[i].input, vehicle, with_plan ? &set[i].plan : nullptr, 0.7F);
        const Forecast& forecast = forecasts[i][static_cast<std::size_t>(vehicle)];
        for (int mode = 0; mode < kMaxModes; ++mode) {
          EXPECT_NEAR(futures.probability[mode], forecast.probability[mode], 1e-4F);
          EXPECT_NEAR(futures.pose[mode][kHorizonSteps - 1][0],
                      forecast.position_m[mode][kHorizonSteps - 1][0], 1e-3F);
          EXPECT_NEAR(futures.pose[mode][kHorizonSteps - 1][1],
                      forecast.position_m[mode][kHorizonSteps - 1][1], 1e-3F);
        }
      }
    }
  }
}

// TRAIN-005 The image is accepted, is the same each time, survives its file, and forecasts what torch does:
// within 0.1 m (root mean square) after 3 s.
TEST_F(Export, TheImageForecastsLikeTorch) {
  const Trained trained{network->arrays(), {}, 1.0F, 10, 11};
  const std::vector<std::uint32_t> image = export_image(trained, set, samples);
  EXPECT_EQ(image, export_image(trained, set, samples));
  std::filesystem::remove(file);  // the set has it open still
  write_image(image, file);
  EXPECT_EQ(read_image(file), image);
  EXPECT_LT(torch_from_m(image_forecasts(image, set, samples, true)), 0.1);
}

// TRAIN-014 The rounding a training can learn with is the image's: with it torch is 0.55 times as far from what the
// integers forecast as without; with any of the history's layers left as it is, 1.0 to 1.2 times.
TEST_F(Export, TorchRoundsAsTheImageDoes) {
  {
    const torch::NoGradGuard no_gradient;  // weights as drawn hardly make a difference between vehicles
    for (auto& parameter : network->parameters()) parameter.mul_(3.0);
  }
  const std::vector<std::uint32_t> image = export_image({network->arrays(), {}, 1.0F, 10, 11}, set, samples);
  const Forecasts integers = image_forecasts(image, set, samples, true);
  const double without_m = torch_from_m(integers);
  network->round_as_integers(calibrated_ranges(network->arrays(), set, samples));
  EXPECT_LT(torch_from_m(integers), 0.75 * without_m);
}

// TRAIN-013 The row of yielding is fitted to an image: what it forecasts stays as it is to the bit, and where the
// crossing vehicle always lets us pass when we go, it says so.
TEST_F(Export, TheRowOfYieldingIsFittedToAnImage) {
  const std::vector<std::uint32_t> image = export_image({network->arrays(), {}, 1.0F, 10, 11}, set, samples);
  const Forecasts before = image_forecasts(image, set, samples, true);
  const Forecasts after = image_forecasts(fit_yields_row(image, set, samples, samples), set, samples, true);
  for (const std::size_t i : samples) {
    for (std::size_t vehicle = 0; vehicle < 2; ++vehicle) {
      const Forecast& was = before[i][vehicle];
      const Forecast& is = after[i][vehicle];
      EXPECT_EQ(std::memcmp(was.position_m, is.position_m, sizeof was.position_m), 0);
      EXPECT_EQ(std::memcmp(was.probability, is.probability, sizeof was.probability), 0);
    }
    if ((set[i].flags & kEgoGoes) != 0) {
      EXPECT_GT(after[i][1].yield_probability(), 0.8);
    }
  }
}

// An image is judged alone where no checkpoint is left of its training; with neither there is nothing to judge.
TEST_F(Export, AnImageIsJudgedWithoutItsCheckpoint) {
  EvaluationOptions options;
  options.data = file.string() + "_judged";
  std::filesystem::create_directories(options.data);
  write_rule_traffic(options.data / "rule.samples", 5, 40, 1);
  EXPECT_THROW(evaluate(satp::kMcuShape, options), std::runtime_error);
  options.image = options.data / "network.image";
  options.json = options.data / "figures.json";
  write_image(export_image({network->arrays(), {}, 1.0F, 10, 11}, set, samples), options.image);
  evaluate(satp::kMcuShape, options);
  const auto figures = nlohmann::json::parse(std::ifstream(options.json));
  EXPECT_TRUE(figures["predictors"].contains("image, our plan"));
  EXPECT_FALSE(figures["predictors"].contains("satp, our plan"));
  EXPECT_GT(figures["width_m"]["image, our plan"], 0.0);
  EXPECT_GT(figures["conditioned"]["image"]["conditioning"]["pairs"], 0);
  std::filesystem::remove_all(options.data);
}

// A changed image is refused with its reason, not used.
TEST_F(Export, AChangedImageIsRefused) {
  std::vector<std::uint32_t> image = export_image({network->arrays(), {}, 1.0F, 10, 11}, set, samples);
  image[image.size() / 2] ^= 1U;
  EXPECT_THROW((void)image_forecasts(image, set, samples, true), std::runtime_error);
}

}  // namespace
}  // namespace s4tp::train
