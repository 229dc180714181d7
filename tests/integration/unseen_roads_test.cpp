// Roads nobody drew by hand or tuned anything to: the ten of tests/networks/roads (random_roads.py draws as
// many more as one likes): crossings of any angle and rule, ramps, bends, lane drops, late lane changes.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/world/scenario.hpp"

namespace s4tp::campaign {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> roads() {
  std::vector<fs::path> found;
  for (const auto& entry :
       fs::directory_iterator(fs::path(S4TP_SOURCE_DIR) / "tests" / "networks" / "roads")) {
    if (entry.path().extension() == ".toml") {
      found.push_back(entry.path());
    }
  }
  std::ranges::sort(found);
  return found;
}

class UnseenRoads : public testing::TestWithParam<fs::path> {};

// On each road, among both kinds of drivers, two drives reach their goal and nobody is touched. (What broke
// here first: a corner tighter than the car, in which it stood for good.)
TEST_P(UnseenRoads, ReachesItsGoal) {
  for (const std::string flavour : {"smarts", "social"}) {
    const world::Scenario road = world::load_scenario(GetParam(), flavour);
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      EpisodeOptions options;
      options.seed = seed;
      const EpisodeResult result = run_episode(road, options);
      EXPECT_EQ(result.recording.ending, world::Ending::kGoal) << flavour << ", seed " << seed;
      EXPECT_TRUE(result.recording.collisions.empty()) << flavour << ", seed " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ten, UnseenRoads, testing::ValuesIn(roads()),
                         [](const auto& road) { return road.param.stem().string(); });

}  // namespace
}  // namespace s4tp::campaign
