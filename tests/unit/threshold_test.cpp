#include "sim_host/campaign/threshold.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace s4tp::campaign {
namespace {

Calibration short_drives(const char* scenario) {
  const auto folder = std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / scenario;
  CalibrationOptions options;
  options.episodes = 1;
  options.first_seed = 3;
  options.duration_s = 20.0;
  Calibration calibration = empty_calibration();
  calibrate(scenario::load_scenario(folder), options, calibration);
  return calibration;
}

}  // namespace

// Of 0, 1, .. 100 the 95th percentile is 95.
TEST(Threshold, PercentileOfUnorderedValues) {
  ThresholdCell cell;
  for (int i = 0; i <= 100; ++i) cell.risks.push_back(static_cast<float>((i * 37) % 101));
  EXPECT_EQ(cell.percentile(0.95), 95.0F);
  EXPECT_EQ(cell.percentile(0.0), 0.0F);
  EXPECT_EQ(cell.percentile(1.0), 100.0F);
}

// Drives of merging traffic: horizons of 30 steps, nobody left out that touched nobody; who looks further
// ahead sees at least as much at every instant; the wider field of the paper more than that of 2020 at p95;
// the same seed gives the same numbers.
TEST(Threshold, DrivesOfTheTrafficsOwnDrivers) {
  const Calibration once = short_drives("merge");
  ASSERT_EQ(once.cells.size(), 4U);
  EXPECT_GT(once.drives, 3);
  const ThresholdCell& paper = once.cells[0];
  const ThresholdCell& paper_fixed = once.cells[1];
  const ThresholdCell& kolekar = once.cells[2];
  ASSERT_GT(paper.risks.size(), 300U);
  EXPECT_EQ(paper.risks.size() % 30, 0U);
  ASSERT_EQ(paper.risks.size(), paper_fixed.risks.size());
  for (std::size_t i = 0; i < paper.risks.size(); ++i) {
    ASSERT_GE(paper_fixed.risks[i], 0.98F * paper.risks[i] - 1.0F);
  }
  EXPECT_GT(paper.percentile(0.95), kolekar.percentile(0.95));
  EXPECT_EQ(short_drives("merge").cells[0].risks, paper.risks);
}

}  // namespace s4tp::campaign
