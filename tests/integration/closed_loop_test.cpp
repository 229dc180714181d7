// The whole loop on the in-process bus: world, frames, ECU, planner, frames, vehicle.

#include <gtest/gtest.h>

#include <set>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/driver.hpp"
#include "sim_host/campaign/episode.hpp"
#include "tests/support/content.hpp"

namespace s4tp::campaign {
namespace {

scenario::Scenario shipped(const std::string& name) {
  return scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name);
}

EpisodeResult drive(const std::string& scenario, std::uint64_t seed, const std::filesystem::path& log = {}) {
  EpisodeOptions options;
  options.seed = seed;
  options.trace = true;
  if (!log.empty()) options.log = log;
  return run_episode(shipped(scenario), options);
}

// An empty straight road would be too easy to fail: with traffic, seed 1 of cruise reaches its goal.
TEST(ClosedLoop, CruiseReachesTheGoal) {
  const EpisodeResult result = drive("cruise", 1);
  EXPECT_EQ(result.recording.ending, traffic::Ending::kGoal);
  EXPECT_TRUE(result.recording.collisions.empty());
}

// A road of 28 m/s that ends in a turn by 119 degrees, 7.4 m/s, and the goal where the next lane leads on into a junction. Before limits
// were foreseen as far as a plan comes that gains speed, the drive ended off the road.
TEST(ClosedLoop, ASharpTurnOfAFastRoadIsDriven) {
  EpisodeOptions options;
  options.seed = 1;
  const auto file = std::filesystem::path(S4TP_SOURCE_DIR) / "tests" / "networks" / "sharp_fast.toml";
  const EpisodeResult result = run_episode(scenario::load_scenario(file), options);
  EXPECT_EQ(result.recording.ending, traffic::Ending::kGoal);
  EXPECT_TRUE(result.recording.collisions.empty());
}

// The ECU is engaged at take-over and drives all the way: no other mode than driving once it has begun.
TEST(ClosedLoop, DrivesFromTakeOverToTheGoal) {
  const EpisodeResult result = drive("cruise", 2);
  ASSERT_FALSE(result.trace->modes.empty());
  EXPECT_EQ(result.trace->modes.back().to, ecu::Mode::kDriving);
  EXPECT_EQ(result.trace->controls.back().faults, 0);
}

// The same seed gives the same bus log, byte for byte; another seed another one.
TEST(ClosedLoop, IsDeterministicInItsSeed) {
  const auto folder = std::filesystem::temp_directory_path();
  (void)drive("left_turn", 3, folder / "s4tp_loop_a.log");
  (void)drive("left_turn", 3, folder / "s4tp_loop_b.log");
  (void)drive("left_turn", 4, folder / "s4tp_loop_c.log");
  EXPECT_EQ(test::content(folder / "s4tp_loop_a.log"), test::content(folder / "s4tp_loop_b.log"));
  EXPECT_NE(test::content(folder / "s4tp_loop_a.log"), test::content(folder / "s4tp_loop_c.log"));
}

// Perception silent for good from 1 s on: tracks are stale after 0.3 s, lost after 1 s, and the car comes to
// rest without ever leaving its lane.
TEST(ClosedLoop, StopsWhenPerceptionDies) {
  EpisodeOptions options;
  options.seed = 5;
  options.trace = true;
  options.passes = [](double time_s, const wire::Frame& frame) {
    return time_s < 1.0 || frame.id < 0x14 || frame.id > 0x16;
  };
  const EpisodeResult result = run_episode(shipped("cruise"), options);
  bool degraded = false;
  bool minimum_risk = false;
  for (const ecu::ModeRecord& change : result.trace->modes) {
    degraded = degraded || change.to == ecu::Mode::kDegraded;
    minimum_risk = minimum_risk || change.to == ecu::Mode::kMinimumRisk;
  }
  EXPECT_TRUE(degraded);
  EXPECT_TRUE(minimum_risk);
  EXPECT_LT(result.recording.snapshots.back().ego.speed_mps, 0.1);
  EXPECT_NE(result.recording.ending, traffic::Ending::kOffRoad);
}

// Rows come in the order of cells and seeds, whatever the number of threads.
TEST(Campaign, RowsDoNotDependOnThreads) {
  CampaignPlan plan;
  plan.planners = {"constant_speed"};
  plan.scenarios = {"overtake"};
  plan.episodes = 3;
  const Campaign campaign =
      load_campaign(plan, std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios");
  CampaignOptions options;
  options.threads = 1;
  const auto one = run_campaign(campaign, jobs_of(campaign), options);
  options.threads = 3;
  const auto three = run_campaign(campaign, jobs_of(campaign), options);
  ASSERT_EQ(one.size(), 3U);
  ASSERT_EQ(three.size(), 3U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].metrics.seed, i);
    EXPECT_EQ(three[i].metrics.seed, i);
    EXPECT_EQ(one[i].metrics.duration_s, three[i].metrics.duration_s);
  }
}

// An episode that cannot be driven ends the campaign, unless somebody is told of it: then the others are driven, and what is
// left out is said by name. Where most fail the campaign ends all the same.
TEST(Campaign, GoesOnPastAnEpisodeThatCannotBeDriven) {
  CampaignPlan plan;
  plan.planners = {"constant_speed"};
  plan.scenarios = {"overtake"};
  plan.episodes = 3;
  Campaign campaign = load_campaign(plan, std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios");
  Campaign broken = campaign;
  broken.cells[0].cell.planner = "nobody";
  campaign.cells.push_back(broken.cells[0]);
  std::vector<Job> jobs = jobs_of(campaign);
  ASSERT_EQ(jobs.size(), 6U);
  jobs.resize(4);  // one of the broken cell
  CampaignOptions options;
  EXPECT_THROW(static_cast<void>(run_campaign(campaign, jobs, options)), std::runtime_error);
  std::vector<std::string> failures;
  options.on_failure = [&](const std::string& why) { failures.push_back(why); };
  EXPECT_EQ(run_campaign(campaign, jobs, options).size(), 3U);
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_NE(failures[0].find("nobody"), std::string::npos) << failures[0];
  broken.plan.episodes = 10;
  EXPECT_THROW(static_cast<void>(run_campaign(broken, jobs_of(broken), options)), std::runtime_error);
}

// The parts of a campaign have every episode once, and each part some of every cell.
TEST(Campaign, ShardsShareEveryCell) {
  CampaignPlan plan;
  plan.planners = {"s4tp", "blind"};
  plan.scenarios = {"overtake"};
  plan.episodes = 10;
  const Campaign campaign =
      load_campaign(plan, std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios");
  std::set<std::pair<std::size_t, std::uint64_t>> all;
  for (int i = 1; i <= 3; ++i) {
    std::set<std::size_t> cells;
    for (const Job& job : jobs_of(campaign, {i, 3})) {
      EXPECT_TRUE(all.emplace(job.cell, job.seed).second);
      cells.insert(job.cell);
    }
    EXPECT_EQ(cells.size(), 2U);
  }
  EXPECT_EQ(all.size(), 20U);
}

// An unknown planner is refused with the list of those there are.
TEST(Driver, NamesThePlannersThereAre) {
  try {
    (void)make_driver("autopilot", true, Parameters{}, nullptr, nullptr);
    FAIL();
  } catch (const std::invalid_argument& refused) {
    for (const std::string& name : baselines::planner_names()) {
      EXPECT_NE(std::string(refused.what()).find(name), std::string::npos) << refused.what();
    }
  }
}

}  // namespace
}  // namespace s4tp::campaign
