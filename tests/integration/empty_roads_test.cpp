// Roads by number with nobody else on them: what a mission asks for can be driven.

#include <gtest/gtest.h>

#include <filesystem>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/roads/generator.hpp"
#include "sim_host/roads/road.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::campaign {
namespace {

class EmptyRoads : public testing::TestWithParam<std::uint64_t> {};

// ROAD-003 Two roads of each family, numbers 0 to 27: without traffic the goal is reached within the time
// limit.
TEST_P(EmptyRoads, AreDrivenToTheGoal) {
  const test::Folder out;
  const std::filesystem::path mix = std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios/social.toml";
  scenario::Scenario road = scenario::load_scenario(roads::write_road(GetParam(), mix, out.path()).folder);
  road.flows.clear();
  EpisodeOptions options;
  options.planner = "sumo_driver";
  options.engine = scenario::Engine::kSumo;
  const EpisodeResult result = run_episode(road, options);
  EXPECT_EQ(result.recording.ending, traffic::Ending::kGoal) << road.name;
}

INSTANTIATE_TEST_SUITE_P(TwoOfEachFamily, EmptyRoads, testing::Range(std::uint64_t{0}, std::uint64_t{28}));

}  // namespace
}  // namespace s4tp::campaign
