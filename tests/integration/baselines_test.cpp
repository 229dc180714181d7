// Every baseline on the CAN path: who cannot drive an empty road is no yardstick.

#include <gtest/gtest.h>

#include "algo/satp/shipped_weights.hpp"
#include "sim_host/campaign/episode.hpp"

namespace s4tp::campaign {
namespace {

class EmptyRoad : public testing::TestWithParam<const char*> {};

// All shipped scenarios without traffic, bare and guarded: the goal, in time, without a contact.
TEST_P(EmptyRoad, IsDrivenToTheGoal) {
  for (const char* const name : {"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"}) {
    scenario::Scenario scenario =
        scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name);
    scenario.flows.clear();
    for (const bool guarded : {false, true}) {
      EpisodeOptions options;
      options.planner = GetParam();
      options.guarded = guarded;
      const EpisodeResult result = run_episode(scenario, options);
      EXPECT_EQ(result.recording.ending, traffic::Ending::kGoal)
          << name << (guarded ? ", guarded" : ", bare");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Baselines, EmptyRoad,
                         testing::Values("static_drf", "idm_lane", "predictive_decision", "drf_controller",
                                         "predictive_decision_kinematic", "s4tp_kinematic"),
                         [](const auto& planner) { return std::string(planner.param); });

/// Cycles of a short drive among others, and in how many of them the network predicted.
std::pair<int, int> predicted_by_network(const char* planner) {
  scenario::Scenario scenario =
      scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / "cut_in");
  scenario.mission.time_limit_s = 3.0;
  EpisodeOptions options;
  options.planner = planner;
  options.trace = true;
  const EpisodeResult result = run_episode(scenario, options);
  int cycles = 0;
  int learned = 0;
  for (const CycleTrace& cycle : result.trace->cycles) {
    if (cycle.record.explanation.status != Status::kOk) continue;
    ++cycles;
    learned += cycle.record.explanation.learned ? 1 : 0;
  }
  return {cycles, learned};
}

// Planner and baseline predict with the network the build carries, their _kinematic twins never do: the two of a pair
// differ in nothing else.
TEST(Predictors, TwinsDifferInTheNetwork) {
  const bool carried = satp::shipped_weights().image != nullptr;
  for (const char* const planner : {"s4tp", "predictive_decision"}) {
    const auto [cycles, learned] = predicted_by_network(planner);
    EXPECT_GT(cycles, 20) << planner;
    EXPECT_EQ(learned, carried ? cycles : 0) << planner;
    const auto [twins, never] = predicted_by_network((std::string(planner) + "_kinematic").c_str());
    EXPECT_GT(twins, 20) << planner;
    EXPECT_EQ(never, 0) << planner;
  }
}

}  // namespace
}  // namespace s4tp::campaign
