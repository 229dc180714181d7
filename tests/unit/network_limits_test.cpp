// What a network file must not hold, what the error says, and what is just within the limits.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim_host/world/map/network.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::map {
namespace {

using test::kBridged;
using test::kCross;
using test::lane;
using test::network_of;
using test::replaced;

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(network_of(text));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

/// A junction with `count` ways of their own, each so long.
std::string ways_of(int count, double length_m) {
  std::string lanes;
  std::string connections;
  std::string listed;
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    const std::string y = std::to_string(10 * i);
    const auto lane = [&](const std::string& edge, double from_m, double to_m, const std::string& function) {
      return "<edge id=\"" + edge + "\"" + function + "><lane id=\"" + edge + "_0\" index=\"0\" shape=\"" +
             std::to_string(from_m) + "," + y + " " + std::to_string(to_m) + "," + y + "\"/></edge>\n";
    };
    lanes += lane("a" + n, -50.0, 0.0, "") + lane(":c_" + n, 0.0, length_m, " function=\"internal\"") +
             lane("b" + n, length_m, length_m + 50.0, "");
    connections += "<connection from=\"a" + n + "\" to=\"b" + n + "\" fromLane=\"0\" toLane=\"0\" via=\":c_" +
                   n + "_0\"/>\n<connection from=\":c_" + n + "\" to=\"b" + n +
                   "\" fromLane=\"0\" toLane=\"0\"/>\n";
    listed += " :c_" + n + "_0";
  }
  return "<net>" + lanes + "<junction id=\"c\" type=\"priority\" intLanes=\"" + listed + "\"/>" +
         connections + "</net>";
}

/// A way through a junction in `count` parts of 1 m.
std::string in_a_row(int count) {
  std::string text =
      "<net><edge id=\"a\"><lane id=\"a_0\" index=\"0\" shape=\"-50,0 0,0\"/></edge>"
      "<edge id=\"b\"><lane id=\"b_0\" index=\"0\" shape=\"200,0 250,0\"/></edge>";
  std::string connections;
  std::string before = "a";
  for (int i = 0; i < count; ++i) {
    const std::string edge = ":c_" + std::to_string(i);
    text += "<edge id=\"" + edge + "\" function=\"internal\"><lane id=\"" + edge +
            "_0\" index=\"0\" shape=\"" + std::to_string(i) + ",0 " + std::to_string(i + 1) + ",0\"/></edge>";
    connections +=
        "<connection from=\"" + before + "\" to=\"b\" fromLane=\"0\" toLane=\"0\" via=\"" + edge + "_0\"/>";
    before = edge;
  }
  connections += "<connection from=\"" + before + "\" to=\"b\" fromLane=\"0\" toLane=\"0\"/>";
  return text + "<junction id=\"c\" type=\"priority\" intLanes=\"" + before + "_0\"/>" + connections +
         "</net>";
}

/// A lane that leads straight into `count` others.
std::string leading_to(int count) {
  std::string text = "<net><edge id=\"a\"><lane id=\"a_0\" index=\"0\" shape=\"-50,0 0,0\"/></edge>";
  std::string connections;
  for (int i = 0; i < count; ++i) {
    const std::string edge = "b" + std::to_string(i);
    text += "<edge id=\"" + edge + "\"><lane id=\"" + edge + "_0\" index=\"0\" shape=\"0,0 50," +
            std::to_string(i) + "\"/></edge>";
    connections += "<connection from=\"a\" to=\"" + edge + "\" fromLane=\"0\" toLane=\"0\"/>";
  }
  return text + connections + "</net>";
}

/// A lane of 50 m with `count` points.
std::string dense(int count) {
  std::string shape;
  for (int i = 0; i < count; ++i) shape += std::to_string(50.0 * i / (count - 1)) + ",0 ";
  return "<net><edge id=\"a\"><lane id=\"a_0\" index=\"0\" shape=\"" + shape + "\"/></edge></net>";
}

// NET-001 NET-004 Every error names the file, the element and what was expected.
TEST(Network, ErrorsSayWhatWasExpected) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"<net><edge", {"network.net.xml", "at byte"}},
      {"<routes/>", {"expected <net>"}},
      {"<net/>", {"expected at least one <lane>"}},
      {replaced(kCross, "-50,0 -10,0", "-50,0"), {"lane \"west_in_0\"", "two different points"}},
      {replaced(kCross, "-50,0 -10,0", "-50;0 -10,0"), {"\"-50;0\"", "expected x,y"}},
      {replaced(kCross, "-50,0 -10,0", "-50,0 -50,0"), {"west_in_0", "two different points"}},
      {replaced(kCross, "-10,0 10,0", "-10,0 1e8,0"),
       {"\":c_0_0\"", "through the junction", "at most 1000 m"}},
      {replaced(kBridged, "\"60,0", "\"1060,0"), {"\":c_0_0\"", "1010 m long", "at most 1000 m"}},
      {replaced(replaced(kCross, "-10,0 10,0", "-10,0 1e8,0"), ":c_0_0 :c_1_0\"", "\""),
       {"\":c_0_0\"", "at most 1000 m"}},  // in no junction's list
      {replaced(kCross, "-50,0 -10,0", "-5e7,0 -10,0"), {"<net>", "50000 km long", "at most 20000 km"}},
      {replaced(kCross, "\":c_0_0 :c_1_0\"", "\":c_0_0 :c_1_0 :c_0_0\""),
       {"junction \"c\"", "listed already"}},
      {ways_of(9, 990.0), {"junction \"c\"", "8 km long together"}},
      {ways_of(257, 9.0), {"junction \"c\"", "more than 256 ways"}},
      {in_a_row(101), {"junction", "more than 100 lanes"}},
      {leading_to(65), {"\"a_0\"", "more than 64 lanes"}},
      {dense(601), {"\"a_0\"", "601 points", "10 a metre"}},
      {replaced(kCross, R"(speed="10" length="40" shape="-50)", R"(speed="fast" shape="-50)"),
       {"west_in_0", "speed=\"fast\"", "a number"}},
      {replaced(kCross, R"(via=":c_0_0")", R"(via=":c_7_0")"),
       {"connection from \"west_in\" to \"east_out\"", "\":c_7_0\"", "no <edge> has"}},
      {replaced(kCross, R"(fromLane="0" )", ""), {"connection from", "attribute fromLane"}},
      {replaced(kCross, R"(<request index="1")", R"(<request index="9")"),
       {"junction \"c\"", "request index=\"9\""}},
      {replaced(kCross, R"(response="10")", R"(response="1x")"), {"junction \"c\"", "0s and 1s"}},
  };
  for (const auto& [text, expected] : cases) {
    for (const std::string& part : expected) {
      EXPECT_NE(error_of(text).find(part), std::string::npos) << error_of(text) << "\n  lacks: " << part;
    }
  }
  EXPECT_THROW(static_cast<void>(load_network("/nowhere/network.net.xml")), std::runtime_error);
}

// NET-004 What is just within the limits is read: ways of 7.9 km together, 256 ways, a way of 100 parts, 64 lanes to go to,
// and 600 points on 50 m.
TEST(Network, WhatIsWithinTheLimitsIsRead) {
  EXPECT_EQ(network_of(ways_of(8, 990.0)).lanes.size(), 24U);
  EXPECT_EQ(network_of(ways_of(256, 9.0)).lanes.size(), 768U);
  EXPECT_EQ(network_of(in_a_row(100)).lanes.size(), 102U);
  EXPECT_EQ(lane(network_of(leading_to(64)), "a_0").successors.size(), 64U);
  EXPECT_EQ(lane(network_of(dense(600)), "a_0").centre.points().size(), 600U);
}

}  // namespace
}  // namespace s4tp::map
