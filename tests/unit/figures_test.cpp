// What forecasts are worth: figures on samples whose answer is known by hand.

#include "sim_host/train/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "sim_host/train/conditioning.hpp"

namespace s4tp::train {
namespace {

constexpr std::uint32_t kAllSeen = (1U << kHorizonSteps) - 1U;

// One vehicle that drives straight at `speed_mps`, with a kinematic forecast that stands still.
Sample straight(std::uint64_t road, float speed_mps) {
  Sample sample;
  sample.road = road;
  sample.scenario = SampleScenario::kMerge;
  sample.input.hdvs = 1;
  sample.input.speed_mps[0] = 10.0F;
  sample.target.valid[0] = kAllSeen;
  for (int i = 0; i < kHorizonSteps; ++i)
    sample.target.pose[0][i][0] = speed_mps * 0.1F * static_cast<float>(i + 1);
  sample.kinematic[0].probability[0] = 1.0F;
  return sample;
}

SampleSet set_of(const std::vector<Sample>& samples) {
  const auto file =
      std::filesystem::temp_directory_path() /
      (std::string("s4tp_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".samples");
  SampleWriter writer(file);
  for (const Sample& sample : samples) writer.add(sample);
  writer.close();
  SampleSet set(file);
  std::filesystem::remove(file);
  return set;
}

// One mode a speed, straight on.
Forecast at_speeds(std::initializer_list<std::pair<float, float>> modes) {
  Forecast forecast;
  int mode = 0;
  for (const auto& [probability, speed_mps] : modes) {
    forecast.probability[mode] = probability;
    for (int i = 0; i < kHorizonSteps; ++i) {
      forecast.position_m[mode][i][0] = speed_mps * 0.1F * static_cast<float>(i + 1);
    }
    ++mode;
  }
  return forecast;
}

// True 10 m/s; modes of 9 (0.6) and 10 m/s (0.4): the likeliest is 0.1 m off a step, 1.55 on average and 3 at
// the end; weighted 0.6 x 1.55; the nearest 0.
TEST(Figures, AreTheDistancesOfTheModes) {
  const SampleSet set = set_of({straight(1, 10.0F)});
  Forecasts forecasts(1);
  forecasts[0][0] = at_speeds({{0.6F, 9.0F}, {0.4F, 10.0F}});
  const auto errors = errors_of(set, {0}, forecasts);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0].top_1_ade_m, 1.55, 1e-5);
  EXPECT_NEAR(errors[0].weighted_ade_m, 0.93, 1e-5);
  EXPECT_NEAR(errors[0].top_1_fde_m, 3.0, 1e-5);
  EXPECT_NEAR(errors[0].min_ade_m, 0.0, 1e-5);
  EXPECT_EQ(errors[0].nearest, 1);
}

// A vehicle that was lost before 3 s, and one that the kinematic predictor left out, are judged for nobody.
TEST(Figures, JudgeWhatEveryPredictorHas) {
  Sample lost = straight(1, 10.0F);
  lost.target.valid[0] = kAllSeen >> 1U;
  Sample left_out = straight(1, 10.0F);
  left_out.kinematic[0].probability[0] = 0.0F;
  const SampleSet set = set_of({lost, left_out, straight(1, 10.0F)});
  EXPECT_EQ(errors_of(set, {0, 1, 2}, steady_forecasts(set, {0, 1, 2})).size(), 1U);
}

// One Gaussian of 2 m, 2 m off: 0.5 + log(8 pi); the width that fits errors of 1 m best is 1 / sqrt(2).
TEST(Figures, LikelihoodIsOfGaussians) {
  VehicleErrors errors;
  errors.probability[0] = 1.0;
  errors.end_m[0] = 2.0;
  EXPECT_NEAR(negative_log_likelihood(errors, 2.0), 0.5 + std::log(8.0 * std::numbers::pi), 1e-9);
  errors.end_m[0] = 1.0;
  EXPECT_NEAR(fitted_sigma_m({errors}), 1.0 / std::numbers::sqrt2, 1e-3);
}

// Roads 1 (values 0, 0) and 2 (values 2, 2): mean 1; deviations of -2 and 2 over four values:
// 1.96 sqrt(2 x 8) / 4 = 1.96. Unclustered it would be 1.13.
TEST(Figures, IntervalsGoByRoad) {
  RoadMean mean;
  for (const std::uint64_t road : {1U, 1U, 2U, 2U}) mean.add(road, road == 1U ? 0.0 : 2.0);
  EXPECT_NEAR(mean.mean(), 1.0, 1e-12);
  EXPECT_NEAR(mean.half_width(), 1.96, 1e-9);
}

// The difference to the kinematic forecast is paired: standing is off 15.5 m on average where the truth is 10
// m/s.
TEST(Figures, DifferencesArePaired) {
  const SampleSet set = set_of({straight(1, 10.0F), straight(2, 10.0F)});
  const std::vector<std::size_t> both{0, 1};
  const auto kinematic = errors_of(set, both, kinematic_forecasts(set, both));
  const auto steady = errors_of(set, both, steady_forecasts(set, both));
  const auto json = figures_by_scenario(steady, 1.0, kinematic);
  EXPECT_NEAR(json["merge"]["top_1_ade_less_reference"]["mean"].get<double>(), -15.5, 1e-4);
  EXPECT_NEAR(json["all"]["top_1_ade"]["mean"].get<double>(), 0.0, 1e-5);
  EXPECT_FALSE(json.contains("cruise"));
}

// Three paces of one future: at 0.8 of 10 m/s the first second is 8 m.
TEST(Figures, KinematicVariantsKeepTheWay) {
  Sample sample = straight(1, 10.0F);
  for (int i = 0; i < kHorizonSteps; ++i) {
    sample.kinematic[0].position_cm[0][i][0] = static_cast<std::int16_t>(100 * (i + 1));
  }
  const SampleSet set = set_of({sample});
  const Forecast forecast = kinematic_variants(set, {0})[0][0];
  EXPECT_NEAR(forecast.position_m[0][9][0], 10.0F, 1e-4F);
  EXPECT_NEAR(forecast.position_m[1][9][0], 8.0F, 1e-4F);
  EXPECT_NEAR(forecast.position_m[2][9][0], 12.0F, 1e-4F);
  EXPECT_NEAR(forecast.position_m[2][29][0], 36.0F, 1e-3F);
}

// Two branches, 10 and 8 m/s: 6 m apart after 3 s. Who predicts each right tells them apart with slope 1; who
// mixes them up has slope -1 and none right; who sees no influence has no slope and gains nothing.
TEST(Conditioning, TellsAFollowerFromAnIgnorer) {
  std::vector<Sample> branches{straight(1, 10.0F), straight(1, 8.0F)};
  for (Sample& branch : branches) {
    branch.flags = kForked;
    branch.interacts[0] = 1;
  }
  const SampleSet set = set_of(branches);
  Forecasts right(2);
  right[0][0] = at_speeds({{1.0F, 10.0F}});
  right[1][0] = at_speeds({{1.0F, 8.0F}});
  const auto good = conditioning_figures(set, {0, 1}, right, 1.0);
  EXPECT_EQ(good["told_apart"]["share"], 1.0);
  EXPECT_NEAR(good["slope"].get<double>(), 1.0, 1e-5);
  EXPECT_NEAR(good["explained"].get<double>(), 1.0, 1e-5);
  const auto bad = conditioning_figures(set, {0, 1}, {right[1], right[0]}, 1.0);
  EXPECT_EQ(bad["told_apart"]["share"], 0.0);
  EXPECT_NEAR(bad["slope"].get<double>(), -1.0, 1e-5);
  const auto none = conditioning_figures(set, {0, 1}, {right[0], right[0]}, 1.0);
  EXPECT_EQ(none["told_apart"]["share"], 0.0);
  EXPECT_FALSE(none.contains("slope"));
}

// A vehicle that shares nothing with us and is moved by our plan all the same is a phantom.
TEST(Conditioning, SeesPhantoms) {
  std::vector<Sample> branches{straight(1, 10.0F), straight(1, 10.0F)};
  for (Sample& branch : branches) branch.flags = kForked;
  const SampleSet set = set_of(branches);
  Forecasts forecasts(2);
  forecasts[0][0] = at_speeds({{1.0F, 10.0F}});
  forecasts[1][0] = at_speeds({{1.0F, 9.0F}});
  EXPECT_EQ(conditioning_figures(set, {0, 1}, forecasts, 1.0)["phantom"]["share"], 0.0);
  EXPECT_EQ(conditioning_figures(set, {0, 1}, {forecasts[0], forecasts[0]}, 1.0)["phantom"]["share"], 1.0);
}

// We leave the zone after 2 s; its entry is 15 m ahead, the vehicle 4 m long: 13 m to go. At 10 m/s it is in
// after 1.3 s (goes), at 5 m/s after 2.6 s (yields): with 0.3 and 0.7, p(yields) = 0.7.
TEST(Conditioning, YieldsAreModesThatComeAfterUs) {
  Sample sample = straight(1, 10.0F);
  using satp::PairFeature;
  float(&pair)[satp::kPairFeatures] = sample.input.pair[0];
  pair[static_cast<int>(PairFeature::kEntryM)] = 15.0F;
  pair[static_cast<int>(PairFeature::kLengthM)] = 4.0F;
  pair[static_cast<int>(PairFeature::kOurExitM)] = 18.0F;
  sample.input.place[0][6] = 4.0F;  // our rear is out 2 m beyond the exit: after 20 m
  for (int step = 0; step < satp::kDecoderSteps; ++step) {
    sample.plan.step[0][step][6] = 10.0F;
    sample.plan.step[0][step][8] = 18.0F - 5.0F * static_cast<float>(step + 1);
  }
  EXPECT_NEAR(yield_probability(sample, 0, at_speeds({{0.3F, 10.0F}, {0.7F, 5.0F}})), 0.7, 1e-6);
  EXPECT_NEAR(yield_probability(sample, 0, at_speeds({{1.0F, 0.0F}})), 1.0, 1e-6);
}

}  // namespace
}  // namespace s4tp::train
