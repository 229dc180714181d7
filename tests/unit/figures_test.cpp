// What forecasts are worth: figures on samples whose answer is known by hand.

#include "sim_host/train/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "sim_host/train/conditioning.hpp"
#include "sim_host/train/reliability_plot.hpp"

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

// Differences to the kinematic forecast are paired: standing is off 15.5 m on average where the truth is 10 m/s, and
// 30 m at 3 s, which a width of 10 m makes 4.5 + log(100) less likely than no error with one of 1 m.
TEST(Figures, DifferencesArePaired) {
  const SampleSet set = set_of({straight(1, 10.0F), straight(2, 10.0F)});
  const std::vector<std::size_t> both{0, 1};
  const auto kinematic = errors_of(set, both, kinematic_forecasts(set, both));
  const auto steady = errors_of(set, both, steady_forecasts(set, both));
  const auto json = figures_by_group({steady, 1.0}, {kinematic, 10.0});
  EXPECT_NEAR(json["merge"]["top_1_ade_less_reference"]["mean"].get<double>(), -15.5, 1e-4);
  EXPECT_NEAR(json["merge"]["nll_less_reference"]["mean"].get<double>(), -4.5 - std::log(100.0), 1e-4);
  EXPECT_NEAR(json["all"]["top_1_ade"]["mean"].get<double>(), 0.0, 1e-5);
  EXPECT_FALSE(json.contains("cruise"));
}

// Of two vehicles one has priority and one shares no zone with us: each stands alone beneath its scenario, 15.5 m and 0 off.
TEST(Figures, RightOfWayIsToldApart) {
  std::vector<Sample> samples{straight(1, 10.0F), straight(2, 10.0F)};
  samples[0].rule[0] = SampleRule::kHasPriority;
  const SampleSet set = set_of(samples);
  const std::vector<std::size_t> both{0, 1};
  auto forecasts = steady_forecasts(set, both);
  forecasts[0] = kinematic_forecasts(set, both)[0];
  const Judged judged{errors_of(set, both, forecasts), 1.0};
  const auto json = figures_by_group(judged, judged)["merge"]["right_of_way"];
  EXPECT_NEAR(json["has_priority"]["top_1_ade"]["mean"].get<double>(), 15.5, 1e-4);
  EXPECT_EQ(json["has_priority"]["vehicles"].get<int>(), 1);
  EXPECT_NEAR(json["no_zone"]["top_1_ade"]["mean"].get<double>(), 0.0, 1e-4);
  EXPECT_FALSE(json.contains("yields"));
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
  const auto moved = conditioning_figures(set, {0, 1}, forecasts, 1.0);
  EXPECT_EQ(moved["phantom"]["share"], 0.0);
  EXPECT_EQ(moved["phantom_in_hindsight"]["share"], 0.0);
  EXPECT_EQ(conditioning_figures(set, {0, 1}, {forecasts[0], forecasts[0]}, 1.0)["phantom"]["share"], 1.0);
}

// Ten forks that go, in each one vehicle that has priority; four let us pass. Who says 0.4 of each is right
// and knows no more than the base rate; who knows which has a skill of 1; who is sure of all is wrong by 0.6.
// A branch in which it is not settled is counted, not judged; one in which we wait is neither.
TEST(Conditioning, YieldsAreJudgedWhereWeGo) {
  std::vector<Sample> branches;
  for (int i = 0; i < 12; ++i) {
    Sample& sample = branches.emplace_back(straight(1, 10.0F));
    sample.flags = i == 11 ? kForked : kForked | kEgoGoes;
    sample.rule[0] = SampleRule::kHasPriority;
    sample.yields[0] = static_cast<std::int8_t>(i == 10 ? -1 : i < 4 ? 1 : 0);
  }
  const SampleSet set = set_of(branches);
  const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const auto judge = [&](const std::function<float(int)>& yields) {
    Forecasts forecasts(branches.size());
    for (int i = 0; i < 12; ++i) {
      Forecast& forecast = forecasts[static_cast<std::size_t>(i)][0];
      forecast = at_speeds({{0.5F, 10.0F}, {0.5F, 8.0F}});
      for (float& value : forecast.yields) value = yields(i);
    }
    return yield_figures(set, all, forecasts);
  };
  const auto base = judge([](int) { return 0.4F; });
  EXPECT_EQ(base["count"], 10);
  EXPECT_EQ(base["unsettled"], 1);
  EXPECT_NEAR(base["error"].get<double>(), 0.0, 1e-6);
  EXPECT_NEAR(base["brier_skill"].get<double>(), 0.0, 1e-6);
  const auto knows = judge([](int i) { return i < 4 ? 1.0F : 0.0F; });
  EXPECT_NEAR(knows["brier_skill"].get<double>(), 1.0, 1e-6);
  const auto hopes = judge([](int) { return 1.0F; });
  EXPECT_NEAR(hopes["error"].get<double>(), 0.6, 1e-6);
  EXPECT_LT(hopes["brier_skill"].get<double>(), 0.0);
}

// A curve of two bins is two circles, the one with all the weight on the diagonal's middle.
TEST(Figures, DrawsReliability) {
  const auto file = std::filesystem::temp_directory_path() / "s4tp_reliability.svg";
  draw_reliability({{"ours",
                     {{{"count", 9.0}, {"expected", 0.5}, {"happened", 0.5}},
                      {{"count", 1.0}, {"expected", 0.9}, {"happened", 0.2}}}}},
                   file);
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::filesystem::remove(file);
  EXPECT_NE(text.find("<circle cx='212' cy='176' r='8.5'"), std::string::npos) << text;
  EXPECT_NE(text.find("ours</text>"), std::string::npos);
}

// The gate of who meets us and of who does not, and for how many it is shut.
TEST(Conditioning, ToldHowOpenTheGateIs) {
  std::vector<Sample> scenes{straight(1, 10.0F), straight(1, 10.0F)};
  scenes[0].interacts[0] = 1;
  const SampleSet set = set_of(scenes);
  Forecasts forecasts(2);
  forecasts[0][0].gate = 0.75F;
  const auto gates = gate_figures(set, {0, 1}, forecasts);
  EXPECT_EQ(gates["shares_something"]["mean"], 0.75);
  EXPECT_EQ(gates["shares_nothing"]["mean"], 0.0);
  EXPECT_EQ(gates["shut"]["mean"], 0.5);
}

}  // namespace
}  // namespace s4tp::train
