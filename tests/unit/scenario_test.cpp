#include "sim_host/world/scenario.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/networks.hpp"

namespace s4tp::world {
namespace {

using test::Folder;
using test::replaced;
using test::shipped;

const std::string kScenario = R"(
[mission]
route = ["west_in", "east_out"]
goal_m = -10

[[flow]]
choose = 1
vehicles_per_minute = [5, 10]
begin_s = 2
routes = [{ edges = ["south_in", "north_out"] }]
[flow.driver]
max_speed_mps = 10
)";

Scenario scenario_of(const std::string& text) {
  const Folder folder;
  folder.write("network.net.xml", test::kCross);
  folder.write("scenario.toml", text);
  return load_scenario(folder.path());
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(scenario_of(text));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// What is not said is the default; a goal 10 m before the end of a lane of 40 m is at 30 m.
TEST(Scenario, FillsInDefaults) {
  const Scenario scenario = scenario_of(kScenario);
  EXPECT_EQ(scenario.mission.start_edge, "west_in");
  EXPECT_DOUBLE_EQ(scenario.mission.goal_s_m, 30.0);
  EXPECT_DOUBLE_EQ(scenario.mission.time_limit_s, 80.0);
  const FlowGroup& flow = scenario.flows.at(0);
  EXPECT_EQ(flow.choose_high, 1);
  EXPECT_DOUBLE_EQ(flow.vehicles_per_minute.high, 10.0);
  EXPECT_DOUBLE_EQ(flow.begin_s.low, 2.0);
  EXPECT_FALSE(flow.random_spacing);
  EXPECT_DOUBLE_EQ(flow.driver.max_speed_mps, 10.0);
  EXPECT_DOUBLE_EQ(flow.driver.acceleration_mps2, 2.6);
  EXPECT_EQ(flow.routes.at(0).start_lane, -1);
}

// SCN-001 Every error names the file, the key and what is accepted.
TEST(Scenario, ErrorsSayWhatIsAccepted) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {replaced(kScenario, "goal_m", "goal_metres"),
       {"scenario.toml", "mission.goal_metres", "unknown key", "goal_lane, goal_m, route"}},
      {replaced(kScenario, "max_speed_mps", "top_speed"),
       {"flow[0].driver.top_speed", "accepted here: acceleration_mps2"}},
      {"wheels = 4\n" + kScenario, {"wheels: unknown key", "flow, mission, network"}},
      {replaced(kScenario, "[mission]", "[errand]"), {"mission: missing"}},
      {replaced(kScenario, "\"east_out\"", "\"moon\""), {"mission.route", "no edge \"moon\""}},
      {replaced(kScenario, "\"east_out\"", "\"north_out\""), {"mission.route", "no lane leads from"}},
      {replaced(kScenario, "goal_m = -10", "goal_lane = 3"), {"mission.goal_lane", "has no lane 3"}},
      {replaced(kScenario, "goal_m = -10", "goal_m = 41"), {"mission.goal_m", "40"}},
      {replaced(kScenario, "choose = 1", "choose = 2"), {"flow[0].choose", "from 0 to 1"}},
      {replaced(kScenario, "[5, 10]", "[10, 5]"), {"flow[0].vehicles_per_minute", "low <= high"}},
      {replaced(kScenario, "= 10\n", "= \"fast\"\n"), {"flow[0].driver.max_speed_mps", "a number from"}},
      {replaced(kScenario, "begin_s = 2", "begin_s = 2\nspacing = \"odd\""),
       {"flow[0].spacing", "\"random\""}},
      {replaced(kScenario, "[mission]", "[mission"), {"TOML"}},
      {"network = \"none.net.xml\"\n" + kScenario, {"none.net.xml"}},
  };
  for (const auto& [text, expected] : cases) {
    for (const std::string& part : expected) {
      EXPECT_NE(error_of(text).find(part), std::string::npos) << error_of(text) << "\n  lacks: " << part;
    }
  }
}

// A folder without a scenario.toml is said to be none.
TEST(Scenario, AFolderNeedsItsScenarioFile) {
  EXPECT_THROW(static_cast<void>(load_scenario("/nowhere")), std::runtime_error);
}

// The shipped ones, as in WORLD's table: when the ego enters, how many streams there are to draw from and how
// many are drawn.
TEST(Scenario, TheShippedOnesLoad) {
  struct Expected {
    const char* name;
    double entry_time_s;
    std::size_t routes;
    int choose_low;
    int choose_high;
  };
  for (const Expected& expected :
       {Expected{"left_turn", 4.0, 14, 1, 4}, Expected{"merge", 15.0, 3, 2, 3},
        Expected{"cruise", 17.0, 3, 2, 3}, Expected{"overtake", 17.0, 1, 1, 1},
        Expected{"left_turn_t", 4.0, 8, 1, 4}, Expected{"cut_in", 17.0, 4, 2, 4}}) {
    const Scenario scenario = shipped(expected.name);
    EXPECT_EQ(scenario.name, expected.name);
    EXPECT_DOUBLE_EQ(scenario.mission.entry_time_s, expected.entry_time_s) << expected.name;
    ASSERT_EQ(scenario.flows.size(), 1U) << expected.name;
    EXPECT_EQ(scenario.flows[0].routes.size(), expected.routes) << expected.name;
    EXPECT_EQ(scenario.flows[0].choose_low, expected.choose_low) << expected.name;
    EXPECT_EQ(scenario.flows[0].choose_high, expected.choose_high) << expected.name;
  }
}

}  // namespace
}  // namespace s4tp::world
