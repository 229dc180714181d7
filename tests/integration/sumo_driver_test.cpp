// These need Debian's sumo and fail without it.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/sumo/coupling_floor.hpp"
#include "sim_host/sumo/sumo_traffic.hpp"
#include "sim_host/world/engine_factory.hpp"
#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/sumo_scenarios.hpp"

namespace s4tp::sumo {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// An episode over CAN frames with SUMO's traffic reaches its goal, twice the same to the bit.
TEST(SumoTraffic, DrivesAnEpisode) {
  campaign::EpisodeOptions options;
  options.seed = 3;
  options.engine = scenario::Engine::kSumo;
  const scenario::Scenario scenario = shipped("left_turn");
  const traffic::Recording one = campaign::run_episode(scenario, options).recording;
  const traffic::Recording again = campaign::run_episode(scenario, options).recording;
  EXPECT_EQ(one.ending, traffic::Ending::kGoal);
  ASSERT_EQ(one.snapshots.size(), again.snapshots.size());
  for (std::size_t i = 0; i < one.snapshots.size(); ++i) {
    EXPECT_TRUE(same(one.snapshots[i].others, again.snapshots[i].others)) << i;
    EXPECT_TRUE(same({one.snapshots[i].ego}, {again.snapshots[i].ego})) << i;
  }
}

/// Whoever this process has started: SUMO.
void end_child() {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "status");
    for (std::string line; std::getline(file, line);) {
      if (line == "PPid:\t" + std::to_string(getpid())) kill(std::stoi(entry.path().filename()), SIGKILL);
    }
  }
}

// SUMO-005 SUMO ends 1 s into the drive: it is driven again from its beginning, to the goal, and says so. One that
// ends the second time as well is not driven; nor is one whose frames somebody has been told.
TEST(SumoTraffic, DrivesAgainWhatSumoEnded) {
  int ends = 1;
  campaign::EpisodeOptions options;
  options.seed = 3;
  options.engine = scenario::Engine::kSumo;
  double before_s = 0.0;
  options.passes = [&](double time_s, const wire::Frame&) {
    if (before_s < 1.0 && time_s >= 1.0 && ends > 0) {
      --ends;
      end_child();
    }
    before_s = time_s;
    return true;
  };
  const scenario::Scenario scenario = shipped("cruise");
  const campaign::EpisodeResult result = campaign::run_episode(scenario, options);
  EXPECT_EQ(ends, 0);
  EXPECT_EQ(result.recording.ending, traffic::Ending::kGoal);
  EXPECT_NE(result.first_ended.find("it has ended"), std::string::npos) << result.first_ended;
  ends = 2;
  EXPECT_THROW((void)campaign::run_episode(scenario, options), traffic::EngineEnded);
  EXPECT_EQ(ends, 0);
  ends = 1;
  options.record = [](std::uint64_t, const std::vector<wire::Frame>&) {};
  EXPECT_THROW((void)campaign::run_episode(scenario, options), traffic::EngineEnded);
}

// WORLD-041 SUMO's own driver takes the ego from the mission's start at entry speed to its goal; no ECU
// answers.
TEST(SumoTraffic, LetsSumoDriveTheEgo) {
  const scenario::Scenario scenario = shipped("merge");
  world::WorldOptions options;
  options.seed = 3;
  options.engine = scenario::Engine::kSumo;
  options.ego_by_traffic = true;
  world::World world(scenario, options);
  std::vector<wire::Frame> frames;
  while (!world.finished()) {
    frames.clear();
    world.tick(frames);
    if (world.time_s() >= 0.0 && world.time_s() < 0.005) {
      EXPECT_DOUBLE_EQ(world.recording().snapshots.back().ego.speed_mps, scenario.mission.start_speed_mps);
    }
  }
  EXPECT_EQ(world.recording().ending, traffic::Ending::kGoal);
  const std::vector<traffic::Snapshot>& shots = world.recording().snapshots;
  for (std::size_t i = 1; i < shots.size(); ++i) {  // no jump: 20 m/s for 0.1 s at most
    EXPECT_LT(std::hypot(shots[i].ego.centre.x - shots[i - 1].ego.centre.x,
                         shots[i].ego.centre.y - shots[i - 1].ego.centre.y),
              2.0);
  }
}

// The planner sumo_driver is that driver, from the same start, through the same recording and figures; bare
// and guarded it is the same, so it has one cell. Nobody drives against SUMO's will: elsewhere it is refused.
TEST(SumoDriver, IsAPlannerOfTheCampaign) {
  campaign::CampaignPlan plan;
  plan.planners = {"constant_speed", "sumo_driver"};
  plan.scenarios = {"merge", "cruise"};
  plan.guards = {true, false};
  plan.episodes = 2;
  const fs::path scenarios = fs::path(S4TP_SOURCE_DIR) / "sim_host/scenarios";
  const std::string refused = what_of([&] { (void)campaign::load_campaign(plan, scenarios); });
  EXPECT_NE(refused.find("sumo_driver drives in SUMO's traffic only: --traffic sumo"), std::string::npos)
      << refused;

  plan.traffic = {"builtin", "sumo"};
  campaign::Campaign all = campaign::load_campaign(plan, scenarios);
  EXPECT_EQ(all.cells.size(), 2U * 2U * 2U + 2U);
  std::vector<campaign::Job> jobs = campaign::jobs_of(all);
  std::erase_if(jobs,
                [&](const campaign::Job& job) { return all.cells[job.cell].cell.planner != "sumo_driver"; });
  ASSERT_EQ(jobs.size(), 4U);
  campaign::CampaignOptions options;
  options.threads = 2;
  for (const campaign::EpisodeRow& row : campaign::run_campaign(all, jobs, options)) {
    EXPECT_FALSE(row.cell.guarded);
    EXPECT_EQ(row.cell.traffic, "sumo");
    EXPECT_EQ(row.metrics.ending, traffic::Ending::kGoal) << row.cell.scenario << " " << row.metrics.seed;
    EXPECT_GT(row.metrics.duration_s, 5.0);
    EXPECT_GT(row.metrics.distance_m, 50.0);
  }
}

// The built-in traffic drives no ego, and says so.
TEST(TrafficEngine, OnlySumoDrivesTheEgo) {
  traffic::EngineOptions options;
  options.ego = traffic::DrivenBy::kEngine;
  EXPECT_THROW((void)world::make_engine(shipped("cruise"), options), std::invalid_argument);
  EXPECT_EQ(scenario::engine_of("sumo"), scenario::Engine::kSumo);
  EXPECT_THROW((void)scenario::engine_of("vissim"), std::invalid_argument);
}

// One of SUMO's own drives, replayed through the coupling: on an unchanged course nobody touches the ego.
TEST(SumoCoupling, ReplaysADriveUntouched) {
  const scenario::Scenario scenario = shipped("left_turn");
  const Drive drive = sumo_drive(scenario, 3);
  ASSERT_TRUE(drive.arrived && !drive.touched);
  EXPECT_FALSE(replay(scenario, 3, drive, {}).touched);
}

}  // namespace
}  // namespace s4tp::sumo
