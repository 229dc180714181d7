#include "sim_host/world/scenario/route_file.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "sim_host/world/traffic/traffic.hpp"
#include "sim_host/world/traffic/traffic_flow.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::scenario {
namespace {

using test::Folder;

/// On the cross: west_in -> east_out, south_in -> north_out.
Demand demand_of(const std::string& elements) {
  const Folder folder;
  return load_demand(folder.write("a.rou.xml", "<routes>" + elements + "</routes>"),
                     test::network_of(test::kCross));
}

traffic::FlowPlan plan_of(const std::string& elements, double until_s = 100.0) {
  traffic::Random random(3);
  return traffic::draw_demand(test::network_of(test::kCross), demand_of(elements), until_s, random);
}

std::string error_of(const std::string& elements) {
  try {
    static_cast<void>(demand_of(elements));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// SCN-003 Vehicles by a route of their own or by name, and trips, whose way is found; in the order of
// departure.
TEST(RouteFile, VehiclesAndTrips) {
  const traffic::FlowPlan plan = plan_of(R"(<route id="we" edges="west_in east_out"/>
    <vehicle id="late" depart="00:01:05" route="we" departPos="20" departSpeed="3.5"/>
    <vehicle id="own" depart="2.5"><route edges="south_in north_out"/></vehicle>
    <trip id="t" depart="10" from="west_in" to="east_out" departSpeed="max"/>)");
  ASSERT_EQ(plan.departures.size(), 3U);
  EXPECT_DOUBLE_EQ(plan.departures[0].time_s, 2.5);
  EXPECT_DOUBLE_EQ(plan.departures[0].speed_mps, 0.0);  // SUMO's default
  EXPECT_LT(plan.departures[0].s_m, 0.0);               // "base": at the start
  EXPECT_EQ(plan.ways[plan.departures[0].way].last_edge, "north_out");
  EXPECT_DOUBLE_EQ(plan.departures[1].time_s, 10.0);
  EXPECT_GT(plan.departures[1].speed_mps, 100.0);  // as fast as traffic allows
  EXPECT_DOUBLE_EQ(plan.departures[2].time_s, 65.0);
  EXPECT_DOUBLE_EQ(plan.departures[2].s_m, 17.5);  // front bumper at 20 m, 5 m long
  EXPECT_DOUBLE_EQ(plan.departures[2].speed_mps, 3.5);
}

// SCN-003 Every way a flow can say how many: 360 an hour and a period of 10 s are 10 in 100 s; 4 spread over
// 20 .. 60 s; a third a second is about 33; exponential gaps of 2 s are about 50.
TEST(RouteFile, Flows) {
  const std::string way = R"( from="west_in" to="east_out")";
  const auto count = [&](const std::string& spacing) {
    return plan_of("<flow id=\"f\"" + way + " " + spacing + "/>").departures.size();
  };
  EXPECT_EQ(count(R"(begin="0" end="1000" vehsPerHour="360")"), 10U);
  EXPECT_EQ(count(R"(begin="0" period="10")"), 10U);
  EXPECT_EQ(count(R"(begin="95" period="10")"), 1U);
  EXPECT_EQ(count(R"(begin="20" end="60" number="4")"), 4U);
  EXPECT_EQ(count(R"(number="3" period="1")"), 3U);
  EXPECT_NEAR(static_cast<double>(count(R"(probability="0.33")")), 33.0, 15.0);
  EXPECT_NEAR(static_cast<double>(count(R"xml(period="exp(0.5)")xml")), 50.0, 21.0);
  const traffic::FlowPlan spread = plan_of("<flow id=\"f\"" + way + R"( begin="20" end="60" number="4"/>)");
  EXPECT_DOUBLE_EQ(spread.departures[1].time_s, 30.0);
}

// SCN-003 A type's values are the driver's and the car's; what it does not say is SUMO's default for its
// class.
TEST(RouteFile, Types) {
  const Demand demand = demand_of(R"xml(<vType id="slow" accel="1.5" decel="4" sigma="0.1" tau="1.4"
      minGap="3" maxSpeed="9" speedFactor="normc(0.9,0.05,0.5,1.2)" length="4.3" width="1.7"/>
    <vType id="lorry" vClass="truck"/>
    <vTypeDistribution id="mix" vTypes="slow lorry" probabilities="0.75 0.25"/>
    <flow id="f" type="mix" from="west_in" to="east_out" period="5" speedDev="0.3"/>)xml");
  const std::vector<DriverModel>& drivers = demand.flows.at(0).drivers;
  ASSERT_EQ(drivers.size(), 2U);
  EXPECT_DOUBLE_EQ(drivers[0].weight, 0.75);
  EXPECT_DOUBLE_EQ(drivers[0].acceleration_mps2, 1.5);
  EXPECT_DOUBLE_EQ(drivers[0].deceleration_mps2, 4.0);
  EXPECT_DOUBLE_EQ(drivers[0].headway_s, 1.4);
  EXPECT_DOUBLE_EQ(drivers[0].min_gap_mean_m, 3.0);
  EXPECT_DOUBLE_EQ(drivers[0].max_speed_mps, 9.0);
  EXPECT_DOUBLE_EQ(drivers[0].speed_factor_mean, 0.9);
  EXPECT_DOUBLE_EQ(drivers[0].speed_factor_deviation, 0.3);
  EXPECT_DOUBLE_EQ(drivers[0].length_m, 4.3);
  EXPECT_DOUBLE_EQ(drivers[1].length_m, 7.1);
  EXPECT_DOUBLE_EQ(drivers[1].acceleration_mps2, 1.3);
}

// SCN-003 Of a distribution of routes each car takes one: three in four go east.
TEST(RouteFile, RouteDistributions) {
  const traffic::FlowPlan plan = plan_of(R"(<routeDistribution id="d">
      <route id="a" edges="west_in east_out" probability="3"/><route id="b" edges="south_in north_out"/>
    </routeDistribution><flow id="f" route="d" period="0.25"/>)");
  int east = 0;
  for (const traffic::Departure& each : plan.departures) {
    east += plan.ways[each.way].last_edge == "east_out" ? 1 : 0;
  }
  EXPECT_NEAR(east, 300, 40);
}

// SCN-003 What is no vehicle on the road is left out with a note; the rest drives.
TEST(RouteFile, LeavesOutWhatDoesNoHarm) {
  const Demand demand = demand_of(R"(<vType id="train" vClass="rail"/><vType id="bike" vClass="bicycle"/>
    <person id="p" depart="0"><walk edges="west_in"/></person>
    <vehicle id="v" depart="0" type="train"><route edges="rails"/></vehicle>
    <vehicle id="b" depart="0" type="bike"><route edges="cycle_path"/></vehicle>
    <vehicle id="c" depart="1"><route edges="west_in east_out"/></vehicle>)");
  EXPECT_EQ(demand.flows.size(), 1U);
  EXPECT_EQ(demand.notes.size(), 3U);
}

// SCN-003 Errors name the file, the element and what is accepted.
TEST(RouteFile, ErrorsNameTheElement) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {R"(<vehicle id="v" depart="0"><route edges="west_in moon"/></vehicle>)",
       {"a.rou.xml", "<vehicle id=\"v\">", "no edge \"moon\""}},
      {R"(<vehicle id="v" depart="0"><route edges="west_in north_out"/></vehicle>)", {"no lane leads from"}},
      {R"(<trip id="t" depart="0" from="west_in" to="north_out"/>)", {"<trip id=\"t\">", "no way for a car"}},
      {R"(<trip id="t" depart="0" fromTaz="1" toTaz="2"/>)", {"expected a route, or from and to"}},
      {R"(<vehicle id="v" depart="soon" route="r"/>)", {"depart=\"soon\"", "seconds or h:m:s"}},
      {R"(<vehicle id="v" route="r"/>)", {"depart: missing"}},
      {R"(<vehicle id="v" depart="0" route="r"/>)", {"no <route id=\"r\">"}},
      {R"(<vehicle id="v" depart="0" type="x" route="r"/>)", {"no <vType id=\"x\">"}},
      {R"(<vType id="x" accel="0"/>)", {"<vType id=\"x\">", "accel=\"0\"", "from 0.01"}},
      {R"xml(<vType id="x" speedFactor="normc(1)"/>)xml", {"speedFactor", "normc(mean,dev,low,high)"}},
      {R"(<flow id="f" from="west_in" to="east_out"/>)", {"<flow id=\"f\">", "expected period, vehsPerHour"}},
      {R"(<vehicle id="v" depart="0" departLane="3"><route edges="west_in east_out"/></vehicle>)",
       {"departLane=\"3\"", "has no such lane"}},
      {R"(<wagon id="w"/>)", {"<wagon id=\"w\">", "expected vehicle, trip, flow"}},
  };
  for (const auto& [text, expected] : cases) {
    for (const std::string& part : expected) {
      EXPECT_NE(error_of(text).find(part), std::string::npos) << error_of(text) << "\n  lacks: " << part;
    }
  }
}

// FILE-002 Each of 40 distributions names the one before twice: 2^40 routes, which were 4 GB at the 26th.
// They are one route.
TEST(RouteFile, NestedDistributionsStaySmall) {
  std::string text = R"(<routeDistribution id="d0"><route id="r" edges="west_in east_out"/>)"
                     R"(<route id="s" edges="south_in north_out" probability="3"/></routeDistribution>)";
  for (int i = 1; i < 40; ++i) {
    const std::string before = "d" + std::to_string(i - 1);
    text += "<routeDistribution id=\"d" + std::to_string(i) + "\" routes=\"" + before + " " + before +
            "\" probabilities=\"0.5 0.5\"/>";
  }
  const Demand demand = demand_of(text + R"(<flow id="f" route="d39" period="0.25"/>)");
  ASSERT_EQ(demand.flows.at(0).route_weights.size(), 2U);
  EXPECT_DOUBLE_EQ(demand.flows[0].route_weights[1], 3.0 * demand.flows[0].route_weights[0]);
}

// FILE-002 Weights that grow without bound, lists of choices that together do, and kinds of drivers are
// refused by name.
TEST(RouteFile, ChoicesAreBounded) {
  std::string heavy = R"(<route id="d0" edges="west_in east_out"/>)";
  for (int i = 1; i < 40; ++i) {
    heavy += "<routeDistribution id=\"d" + std::to_string(i) + "\" routes=\"d" + std::to_string(i - 1) +
             "\" probabilities=\"1e9\"/>";
  }
  EXPECT_NE(error_of(heavy).find("the weight of another"), std::string::npos) << error_of(heavy);
  std::string many = "<routeDistribution id=\"d0\">";
  for (int i = 0; i < 2'000; ++i) many += "<route edges=\"e" + std::to_string(i) + "\"/>";
  many += "</routeDistribution>";
  for (int i = 0; i < 600; ++i) many += "<routeDistribution id=\"d\" routes=\"d0\"/>";
  EXPECT_NE(error_of(many).find("1000000 routes and drivers to choose from"), std::string::npos);
  std::string kinds = "<vType id=\"a\"/><vTypeDistribution id=\"k\" vTypes=\"";
  for (int i = 0; i < 1'001; ++i) kinds += "a ";
  kinds += R"("/><flow id="f" type="k" from="west_in" to="east_out" period="5"/>)";
  EXPECT_NE(error_of(kinds).find("more than 1000 kinds of drivers"), std::string::npos) << error_of(kinds);
}

/// A road of `edges` edges, each of so many lanes.
map::Network long_road(int edges, int lanes) {
  std::string text = "<net>";
  std::string connections;
  for (int e = 0; e < edges; ++e) {
    text += "<edge id=\"e" + std::to_string(e) + "\">";
    for (int i = 0; i < lanes; ++i) {
      const std::string y = std::to_string(3 * i);
      const std::string n = std::to_string(i);
      text += "<lane id=\"e" + std::to_string(e) + "_" + n + "\" index=\"" + n + "\" shape=\"" +
              std::to_string(20 * e) + "," + y + " " + std::to_string(20 * e + 20) + "," + y + "\"/>";
      if (e + 1 < edges) {
        connections += "<connection from=\"e" + std::to_string(e) + "\" to=\"e" + std::to_string(e + 1) +
                       "\" fromLane=\"" + n + "\" toLane=\"" + n + "\"/>";
      }
    }
    text += "</edge>";
  }
  return test::network_of(text + connections + "</net>");
}

// FILE-002 Different routes are kept lane by lane: 900 of them along 30 to 60 edges of 90 lanes each are refused.
TEST(RouteFile, LanesAlongAllRoutesAreBounded) {
  const map::Network network = long_road(60, 90);
  std::string text = "<routes>";
  for (int first = 0; first < 30; ++first) {
    for (int last = 30; last < 60; ++last) {
      std::string edges;
      for (int e = first; e <= last; ++e) edges += "e" + std::to_string(e) + " ";
      text += "<vehicle id=\"v\" depart=\"0\"><route edges=\"" + edges + "\"/></vehicle>";
    }
  }
  const Folder folder;
  const auto file = folder.write("a.rou.xml", text + "</routes>");
  try {
    static_cast<void>(load_demand(file, network));
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("more than 2000000 lanes together"), std::string::npos)
        << error.what();
  }
}

// FILE-002 Of a way that goes round and round no more is sought than can be driven: what comes after it has passed an edge
// again is left out, here the name of an edge that is not there.
TEST(RouteFile, AWayRoundAndRoundIsNotFollowedOn) {
  const map::Network ring = test::network_of(R"(<net>
    <edge id="a"><lane id="a_0" index="0" shape="0,0 50,0"/></edge>
    <edge id="b"><lane id="b_0" index="0" shape="50,0 50,50 0,50 0,0"/></edge>
    <connection from="a" to="b" fromLane="0" toLane="0"/><connection from="b" to="a" fromLane="0" toLane="0"/></net>)");
  const Folder folder;
  const Demand demand = load_demand(
      folder.write("a.rou.xml",
                   R"(<routes><trip id="t" depart="0" from="a" via="b a b a nowhere" to="b"/></routes>)"),
      ring);
  ASSERT_EQ(demand.routes.size(), 1U);
  EXPECT_EQ(demand.routes[0].edges, (std::vector<std::string>{"a", "b"}));
}

// FILE-003 Ten million cars, or fewer from long before the beginning, were drawn one by one before anything
// drove; the limit holds for all flows together.
TEST(RouteFile, CarsAreBounded) {
  const std::string flow = R"(<flow id="f" from="west_in" to="east_out" )";
  for (const std::string spacing :
       {R"(begin="0" end="100" number="10000000"/>)", R"(begin="-900000" period="0.01"/>)",
        R"(begin="-900000" probability="0"/>)", R"(vehsPerHour="1000000"/>)",
        R"xml(period="exp(100)"/>)xml"}) {
    EXPECT_NE(error_of(flow + spacing).find("more than 200000 cars"), std::string::npos) << spacing;
  }
  std::string many;
  for (int i = 0; i < 60; ++i) many += flow + R"(vehsPerHour="3600"/>)";
  EXPECT_NE(error_of(many).find("more than 200000 cars"), std::string::npos);
  EXPECT_EQ(error_of(flow + R"(number="10000000" period="10"/>)"), "no error");  // 480 of them ever depart
}

// Episode i takes file i modulo their number: of two files with one car each, the even ones' comes from the
// west.
TEST(RouteFile, EpisodesTakeTheFilesInTurn) {
  const Folder folder;
  folder.write("net.xml", test::kCross);
  folder.write("0.rou.xml",
               R"(<routes><vehicle id="a" depart="0"><route edges="west_in east_out"/></vehicle></routes>)");
  folder.write(
      "1.rou.xml",
      R"(<routes><vehicle id="b" depart="0"><route edges="south_in north_out"/></vehicle></routes>)");
  folder.write("scenario.toml",
               "[network]\nfile = \"net.xml\"\n[traffic]\nroutes = [\"0.rou.xml\", \"1.rou.xml\"]\n"
               "[mission]\nstart_lane = \"west_in_0\"\ngoal_lane = \"east_out_0\"\n");
  const Scenario scenario = load_scenario(folder.path());
  for (const std::uint64_t episode : {0U, 1U, 2U, 7U}) {
    traffic::Traffic traffic(scenario, episode, 5);
    for (int i = 0; i < 20; ++i) {
      traffic.step(nullptr);
    }
    ASSERT_EQ(traffic.cars().size(), 1U);
    EXPECT_EQ(scenario.network.lanes[static_cast<std::size_t>(traffic.cars()[0].lane)].edge,
              episode % 2 == 0 ? "west_in" : "south_in");
  }
}

}  // namespace
}  // namespace s4tp::scenario
