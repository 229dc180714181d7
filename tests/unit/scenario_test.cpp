#include "sim_host/world/scenario/scenario.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/networks.hpp"

namespace s4tp::scenario {
namespace {

using test::Folder;
using test::replaced;
using test::shipped;

const std::string kScenario = R"(
[network]
file = "network.net.xml"
[mission]
start_lane = "west_in_0"
goal_lane = "east_out_0"
goal_pos_m = 30.0

[traffic.driver]
max_speed_mps = 10
[[traffic.flow]]
choose = 1
vehicles_per_minute = [5, 10]
begin_s = 2
routes = [{ edges = ["south_in", "north_out"] }]
)";

Scenario scenario_of(const std::string& text, const std::string& flavour = {}) {
  const Folder folder;
  folder.write("network.net.xml", test::kCross);
  folder.write("scenario.toml", text);
  return load_scenario(folder.path(), flavour);
}

std::string error_of(const std::string& text, const std::string& flavour = {}) {
  try {
    static_cast<void>(scenario_of(text, flavour));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// SCN-002 What is not said is the default: 5 m along the start lane, at its limit (10 m/s here), 80 s to get
// there; the way is found.
TEST(Scenario, FillsInDefaults) {
  const Scenario scenario = scenario_of(kScenario);
  EXPECT_EQ(scenario.mission.start_lane, scenario.network.find("west_in_0"));
  EXPECT_EQ(scenario.mission.edges, (std::vector<std::string>{"west_in", "east_out"}));
  EXPECT_DOUBLE_EQ(scenario.mission.start_s_m, 5.0);
  EXPECT_DOUBLE_EQ(scenario.mission.start_speed_mps, 10.0);
  EXPECT_DOUBLE_EQ(scenario.mission.goal_s_m, 30.0);
  EXPECT_DOUBLE_EQ(scenario.mission.time_limit_s, 80.0);
  EXPECT_DOUBLE_EQ(scenario.mission.in_time_s, 80.0);
  const FlowGroup& flow = scenario.flows.at(0);
  EXPECT_EQ(flow.choose_high, 1);
  EXPECT_DOUBLE_EQ(flow.vehicles_per_minute.high, 10.0);
  EXPECT_DOUBLE_EQ(flow.begin_s.low, 2.0);
  EXPECT_FALSE(flow.random_spacing);
  ASSERT_EQ(flow.drivers.size(), 1U);
  EXPECT_DOUBLE_EQ(flow.drivers[0].max_speed_mps, 10.0);
  EXPECT_DOUBLE_EQ(flow.drivers[0].acceleration_mps2, 2.6);
  EXPECT_EQ(flow.routes.at(0).start_lane, -1);
}

// Whoever asks for a goal within 25 s still ends an episode after 80: the time to be in is no limit.
TEST(Scenario, ATimeToBeInIsNoLimit) {
  const Scenario scenario = scenario_of(replaced(kScenario, "30.0", "30.0\nin_time_s = 25"));
  EXPECT_DOUBLE_EQ(scenario.mission.time_limit_s, 80.0);
  EXPECT_DOUBLE_EQ(scenario.mission.in_time_s, 25.0);
}

// A goal at -1 is the lane's end (40 m), an entry speed of -1 the lane's limit (10 m/s).
TEST(Scenario, MinusOneIsWhatTheLaneHas) {
  const Mission mission =
      scenario_of(replaced(kScenario, "goal_pos_m = 30.0", "goal_pos_m = -1.0\nentry_speed_mps = -1.0"))
          .mission;
  EXPECT_DOUBLE_EQ(mission.goal_s_m, 40.0);
  EXPECT_DOUBLE_EQ(mission.start_speed_mps, 10.0);
}

// At the end of a lane that leads on (40 m into the crossing) one may have to wait: there the goal is 5 m before it, and as written
// where it is written.
TEST(Scenario, AGoalAtAJunctionIsBeforeIt) {
  const std::string before = replaced(kScenario, "goal_lane = \"east_out_0\"", "goal_lane = \"west_in_0\"");
  EXPECT_DOUBLE_EQ(scenario_of(replaced(before, "goal_pos_m = 30.0", "goal_pos_m = -1.0")).mission.goal_s_m,
                   35.0);
  EXPECT_DOUBLE_EQ(scenario_of(replaced(before, "goal_pos_m = 30.0", "goal_pos_m = 40.0")).mission.goal_s_m,
                   40.0);
}

// A flavour's tables are put over the file's; what it does not name stays; without a name the file holds as
// written.
TEST(Scenario, AFlavourOverrides) {
  const std::string text = kScenario +
                           "[flavour.hasty.mission]\nentry_speed_mps = 12.5\n"
                           "[flavour.hasty.traffic.driver]\nsvo_rad = 0.5\n";
  EXPECT_DOUBLE_EQ(scenario_of(text).mission.start_speed_mps, 10.0);
  EXPECT_DOUBLE_EQ(scenario_of(text, "smarts").mission.start_speed_mps, 10.0);
  const Scenario hasty = scenario_of(text, "hasty");
  EXPECT_EQ(hasty.flavour, "hasty");
  EXPECT_DOUBLE_EQ(hasty.mission.start_speed_mps, 12.5);
  EXPECT_DOUBLE_EQ(hasty.mission.goal_s_m, 30.0);
  EXPECT_DOUBLE_EQ(hasty.flows.at(0).drivers.at(0).svo_rad, 0.5);
  EXPECT_DOUBLE_EQ(hasty.flows.at(0).drivers.at(0).max_speed_mps, 10.0);
  EXPECT_NE(error_of(text, "lazy").find("flavour.lazy: there is no such flavour; there are: hasty, smarts"),
            std::string::npos)
      << error_of(text, "lazy");
}

// A mix's kinds start from what all drivers have in common.
TEST(Scenario, AMixHasItsKindsOfDrivers) {
  const std::string text = replaced(kScenario, "[[traffic.flow]]",
                                    "[[traffic.mix]]\nname = \"calm\"\nweight = 3\nheadway_s = 2\n"
                                    "[[traffic.mix]]\n[[traffic.flow]]");
  const std::vector<DriverModel> drivers = scenario_of(text).flows.at(0).drivers;
  ASSERT_EQ(drivers.size(), 2U);
  EXPECT_EQ(drivers[0].name, "calm");
  EXPECT_DOUBLE_EQ(drivers[0].weight, 3.0);
  EXPECT_DOUBLE_EQ(drivers[0].headway_s, 2.0);
  EXPECT_DOUBLE_EQ(drivers[0].max_speed_mps, 10.0);
  EXPECT_DOUBLE_EQ(drivers[1].weight, 1.0);
  EXPECT_DOUBLE_EQ(drivers[1].headway_s, 1.0);
}

// SCN-001 Every error names the file, the key and what is accepted.
TEST(Scenario, ErrorsSayWhatIsAccepted) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {replaced(kScenario, "goal_pos_m", "goal_metres"),
       {"scenario.toml", "mission.goal_metres", "unknown key",
        "goal_lane, goal_pos_m, in_time_s, start_lane"}},
      {replaced(kScenario, "max_speed_mps", "top_speed"),
       {"traffic.driver.top_speed", "accepted here: acceleration_mps2"}},
      {"wheels = 4\n" + kScenario, {"wheels: unknown key", "mission, network, traffic"}},
      {replaced(kScenario, "[mission]", "[errand]"), {"mission: missing"}},
      {replaced(kScenario, "\"east_out_0\"", "\"moon_0\""), {"mission.goal_lane", "no lane \"moon_0\""}},
      {replaced(kScenario, "\"east_out_0\"", "\":c_0_0\""), {"mission.goal_lane", "outside junctions"}},
      {replaced(kScenario, "\"east_out_0\"", "\"north_out_0\""),
       {"mission.goal_lane", "no way for a car leads from lane \"west_in_0\" to lane \"north_out_0\""}},
      {replaced(kScenario, "\"east_out_0\"", "\"west_in_0\"\nstart_pos_m = 35"),
       {"mission.goal_lane", "the goal lies behind the start"}},
      {replaced(kScenario, "30.0", "41"), {"mission.goal_pos_m", "40"}},
      {replaced(kScenario, "30.0", "-0.5"), {"mission.goal_pos_m", "or -1"}},
      {replaced(kScenario, "30.0", "30.0\nstart_pos_m = 41"), {"mission.start_pos_m", "40"}},
      {replaced(kScenario, "30.0", "30.0\ntime_limit_s = 30\nin_time_s = 31"),
       {"mission.in_time_s", "a number from 1 to 30"}},
      {replaced(kScenario, "choose = 1", "choose = 2"), {"traffic.flow[0].choose", "from 0 to 1"}},
      {replaced(kScenario, "[5, 10]", "[10, 5]"), {"traffic.flow[0].vehicles_per_minute", "low <= high"}},
      {replaced(kScenario, "= 10\n", "= \"fast\"\n"), {"traffic.driver.max_speed_mps", "a number from"}},
      {replaced(kScenario, "begin_s = 2", "begin_s = 2\nspacing = \"odd\""),
       {"traffic.flow[0].spacing", "\"random\""}},
      {replaced(kScenario, "\"north_out\"] }", "\"moon\"] }"), {"routes[0].edges", "no edge \"moon\""}},
      {replaced(kScenario, "\"north_out\"] }", "\"north_out\"], end_lane = 3 }"),
       {"routes[0].end_lane", "has no lane 3"}},
      {replaced(kScenario, "[traffic.driver]", "[traffic]\nroutes = [\"a.rou.xml\"]\n[traffic.driver]"),
       {"traffic.routes", "either route files"}},
      {replaced(kScenario, "[mission]", "[mission"), {"TOML"}},
      {replaced(kScenario, "network.net.xml", "none.net.xml"),
       {"scenario.toml: network.file: there is no file", "none.net.xml"}},
      {replaced(kScenario, "network.net.xml", "/none.net.xml"),
       {"scenario.toml: network.file: there is no file"}},
  };
  for (const auto& [text, expected] : cases) {
    for (const std::string& part : expected) {
      EXPECT_NE(error_of(text).find(part), std::string::npos) << error_of(text) << "\n  lacks: " << part;
    }
  }
}

// FILE-003 Traffic drawn by the scenario itself has the same limit: 24 routes of 120 cars a minute are
// 230,400 in 4,800 s.
TEST(Scenario, CarsAreBounded) {
  std::string routes;
  for (int i = 0; i < 24; ++i) routes += "{ edges = [\"south_in\", \"north_out\"] },";
  std::string text = replaced(kScenario, "vehicles_per_minute = [5, 10]", "vehicles_per_minute = [5, 120]");
  text = replaced(text, "choose = 1", "choose = 24");
  text = replaced(text, "{ edges = [\"south_in\", \"north_out\"] }", routes);
  EXPECT_NE(error_of(text).find("more than 200000 cars"), std::string::npos) << error_of(text);
  EXPECT_EQ(error_of(replaced(text, "choose = 24", "choose = [1, 20]")), "no error");
  std::string mix;
  for (int i = 0; i < 101; ++i) mix += "[[traffic.mix]]\n";
  EXPECT_NE(error_of(kScenario + mix).find("1 to 100 kinds"), std::string::npos) << error_of(kScenario + mix);
}

// A scenario is named by its folder or by its own file, whatever that is called; route files lie beside it.
TEST(Scenario, IsNamedByFolderOrFile) {
  const Folder folder;
  folder.write("network.net.xml", test::kCross);
  folder.write("a.rou.xml", "<routes/>");
  const std::string text = kScenario.substr(0, kScenario.find("[traffic.driver]"));
  folder.write("scenario.toml", text);
  folder.write("two.toml", text + "[traffic]\nroutes = [\"a.rou.xml\"]\n");
  EXPECT_EQ(load_scenario(folder.path()).name, folder.path().filename());
  EXPECT_EQ(load_scenario(folder.path() / "scenario.toml").name, folder.path().filename());
  const Scenario two = load_scenario(folder.path() / "two.toml");
  EXPECT_EQ(two.name, "two");
  EXPECT_EQ(two.network_file, folder.path() / "network.net.xml");
  EXPECT_EQ(two.route_files, std::vector<std::filesystem::path>{folder.path() / "a.rou.xml"});
}

// A folder without a scenario.toml is said to be none.
TEST(Scenario, AFolderNeedsItsScenarioFile) {
  EXPECT_THROW(static_cast<void>(load_scenario("/nowhere")), std::runtime_error);
}

// The shipped ones, as they were set: when the ego enters, how many streams there are to draw from and how
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

// SCN-004: a slip in a shipped name is answered with those there are; a path of one's own stays as it is given,
// whether or not it is there.
TEST(ScenarioPath, NamesTheShippedOnes) {
  const std::filesystem::path root = std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios";
  EXPECT_EQ(scenario_path(root, "merge"), root / "merge");
  EXPECT_EQ(scenario_path(root, "mine/lefturn"), "mine/lefturn");
  EXPECT_EQ(scenario_path(root, "./merge"), "./merge");  // the user's own, whatever is shipped
  try {
    (void)scenario_path(root, "lefturn");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(
        std::string(error.what()).find("lefturn: there is no such scenario; shipped are: cruise, cut_in,"),
        std::string::npos)
        << error.what();
  }
}

// A cut's commands are an ordinary file: a device's might never end. (Found by the fuzz target cut.)
TEST(Scenario, ACutsCommandsAreAnOrdinaryFile) {
  const std::string merge = std::string(S4TP_SOURCE_DIR) + "/sim_host/scenarios/merge";
  const std::string cut = "[cut]\nof = \"" + merge +
                          "\"\nseed = 1\ntraffic = \"builtin\"\nperception = \"ideal\"\nstart_tick = 1\n";
  for (const std::string file : {"/dev/null", ".", "none.log"}) {
    const std::string error = error_of(cut + "commands = \"" + file + "\"\n");
    EXPECT_NE(error.find(file + ": there is no such file"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace s4tp::scenario
