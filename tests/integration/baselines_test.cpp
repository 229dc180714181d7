// Every baseline on the CAN path: who cannot drive an empty road is no yardstick.

#include <gtest/gtest.h>

#include "sim_host/campaign/episode.hpp"

namespace s4tp::campaign {
namespace {

class EmptyRoad : public testing::TestWithParam<const char*> {};

// All shipped scenarios without traffic, bare and guarded: the goal, in time, without a contact.
TEST_P(EmptyRoad, IsDrivenToTheGoal) {
  for (const char* const name : {"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"}) {
    world::Scenario scenario =
        world::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name);
    scenario.flows.clear();
    for (const bool guarded : {false, true}) {
      EpisodeOptions options;
      options.planner = GetParam();
      options.guarded = guarded;
      const EpisodeResult result = run_episode(scenario, options);
      EXPECT_EQ(result.recording.ending, world::Ending::kGoal) << name << (guarded ? ", guarded" : ", bare");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Baselines, EmptyRoad,
                         testing::Values("static_drf", "idm_lane", "predictive_decision", "drf_controller"),
                         [](const auto& planner) { return std::string(planner.param); });

}  // namespace
}  // namespace s4tp::campaign
