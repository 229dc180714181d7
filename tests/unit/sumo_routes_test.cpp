#include "sim_host/sumo/sumo_routes.hpp"

#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <string>

#include "sim_host/world/traffic/social_value.hpp"

namespace s4tp::sumo {
namespace {

/// One lane of 300 m.
map::Network road() {
  map::Network network;
  map::Lane lane;
  lane.name = "road_0";
  lane.edge = "road";
  lane.centre = map::Polyline({{0.0, 0.0}, {300.0, 0.0}});
  network.lanes.push_back(lane);
  return network;
}

/// The vType SUMO gets for a driver drawn from a model.
pugi::xml_document type_of(const scenario::DriverModel& model, double length_m = 5.0) {
  const map::Network network = road();
  traffic::Random random(1);
  traffic::FlowPlan plan;
  plan.ways.push_back({map::RouteGuide(network, {"road"}, map::kNoLane, 0.0), "road", {{"road"}, -1, -1}});
  traffic::Departure departure;
  departure.lane = 0;
  departure.driver = traffic::draw_driver(model, random);
  departure.length_m = length_m;
  departure.width_m = 2.5;
  plan.departures.push_back(departure);
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(routes_file(flow_definitions(network, plan)).c_str()));
  return document;
}

double number(const pugi::xml_document& document, const char* name) {
  const pugi::xml_attribute attribute = document.child("routes").child("vType").attribute(name);
  EXPECT_TRUE(attribute) << name;
  return attribute.as_double(-99.0);
}

scenario::DriverModel with_svo(double svo_rad) {
  scenario::DriverModel model;
  model.svo_rad = svo_rad;
  return model;
}

// SUMO-002 A driver of orientation 0 is SUMO's default driver: its documented defaults of the junction and
// lane change models.
TEST(SumoRoutes, OrdinaryDriverIsSumosDefault) {
  const pugi::xml_document type = type_of(with_svo(0.0));
  EXPECT_DOUBLE_EQ(number(type, "jmTimegapMinor"), 1.0);
  EXPECT_DOUBLE_EQ(number(type, "impatience"), 0.0);
  EXPECT_DOUBLE_EQ(number(type, "lcSpeedGain"), 1.0);
  EXPECT_DOUBLE_EQ(number(type, "lcAssertive"), 1.0);
  EXPECT_DOUBLE_EQ(number(type, "lcCooperative"), 1.0);
  EXPECT_DOUBLE_EQ(number(type, "tau"), 1.0);
}

// Margins 0.8 and 4.0 s against 2.8: -1 (0 at least) and 2.2 s. Patience 15 and 90 s against 60: 10/15 -
// 10/60 = 0.5 and 10/90 - 10/60. Thresholds 0.05 and 0.3 against 0.1; braking 4 and 2 against 3; rivalry 1
// and 0.
TEST(SumoRoutes, SocialDriversDifferAsOursDo) {
  const pugi::xml_document competitive = type_of(with_svo(-0.2));
  EXPECT_DOUBLE_EQ(number(competitive, "jmTimegapMinor"), 0.0);
  EXPECT_NEAR(number(competitive, "impatience"), 0.5, 1e-12);
  EXPECT_NEAR(number(competitive, "lcSpeedGain"), 2.0, 1e-12);
  EXPECT_NEAR(number(competitive, "lcAssertive"), 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(number(competitive, "lcCooperative"), 0.0, 1e-12);
  const pugi::xml_document prosocial = type_of(with_svo(0.8));
  EXPECT_NEAR(number(prosocial, "jmTimegapMinor"), 2.2, 1e-12);
  EXPECT_NEAR(number(prosocial, "impatience"), 10.0 / 90.0 - 10.0 / 60.0, 1e-12);
  EXPECT_NEAR(number(prosocial, "lcSpeedGain"), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(number(prosocial, "lcAssertive"), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(number(prosocial, "lcCooperative"), 1.0, 1e-12);
}

// A car has the size it has in the built-in traffic, and who keeps the lane has no wish to leave it.
TEST(SumoRoutes, SizeAndLaneKeeping) {
  scenario::DriverModel keeping;
  keeping.lane_keeping = true;
  const pugi::xml_document type = type_of(keeping, 12.0);
  EXPECT_DOUBLE_EQ(number(type, "length"), 12.0);
  EXPECT_DOUBLE_EQ(number(type, "width"), 2.5);
  EXPECT_DOUBLE_EQ(number(type, "lcStrategic"), -1.0);
  EXPECT_DOUBLE_EQ(number(type, "lcSpeedGain"), 0.0);
}

// SUMO-004 A blank anywhere in the network, or what SUMO takes for one in the ego's way: named with its file.
// The same letter off every way we tell SUMO of does no harm.
TEST(SumoRoutes, NamesThatSumoTakesApartAreRefused) {
  scenario::Scenario scenario;
  scenario.network_file = "mine.net.xml";
  scenario.network = road();
  scenario.mission.edges = {"road"};
  scenario.network.lanes[0].edge = "Stra\u00dfe";
  EXPECT_NO_THROW(check_names(scenario));
  for (const std::string edge : {"Stra\u00dfe", "two words"}) {
    scenario.network.lanes[0].edge = edge;
    if (edge != "two words") scenario.mission.edges = {edge};
    try {
      check_names(scenario);
      ADD_FAILURE() << edge;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("mine.net.xml: edge \"" + edge + "\": SUMO separates", 0),
                0U);
    }
    scenario.mission.edges = {"road"};
  }
}

// SUMO-004 strange_names holds such a way: the built-in traffic has loaded it, SUMO's is told no before it
// starts.
TEST(SumoRoutes, StrangeNamesAreRefused) {
  const scenario::Scenario scenario =
      scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "tests/networks/strange_names.toml");
  EXPECT_THROW(check_names(scenario), std::runtime_error);
}

}  // namespace
}  // namespace s4tp::sumo
