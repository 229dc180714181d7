#include "sim_host/world/sumo/sumo_routes.hpp"

#include <pugixml.hpp>
#include <sstream>

namespace s4tp::world {
namespace {

/// An element with everything in it written so that reading gives the same number.
class Element {
 public:
  explicit Element(const char* name) { text_ << std::boolalpha, text_.precision(17), text_ << '<' << name; }

  Element& with(const char* attribute, const std::string& value) {
    text_ << ' ' << attribute << "=\"" << escaped(value) << '"';
    return *this;
  }
  Element& with(const char* attribute, const char* value) { return with(attribute, std::string(value)); }
  template <typename Number>
  Element& with(const char* attribute, Number value) {
    text_ << ' ' << attribute << "=\"" << value << '"';
    return *this;
  }
  [[nodiscard]] std::string closed(const std::string& more = {}) const {
    return text_.str() + ' ' + more + "/>\n";
  }

 private:
  /// Edge ids may hold any character.
  static std::string escaped(const std::string& value) {
    std::string result;
    for (const char c : value) {
      switch (c) {
        case '&':
          result += "&amp;";
          break;
        case '<':
          result += "&lt;";
          break;
        case '"':
          result += "&quot;";
          break;
        default:
          result += c;
      }
    }
    return result;
  }

  std::ostringstream text_;
};

std::string route_definition(const std::string& id, const std::vector<std::string>& edges) {
  std::string list;
  for (const std::string& edge : edges) {
    list += (list.empty() ? "" : " ") + edge;
  }
  return Element("route").with("id", id).with("edges", list).closed();
}

Element driver_definition(const std::string& id, const Driver& driver) {
  Element type("vType");
  type.with("id", id)
      .with("accel", driver.acceleration_mps2)
      .with("decel", driver.deceleration_mps2)
      .with("emergencyDecel", driver.emergency_mps2)
      .with("sigma", driver.imperfection)
      .with("tau", driver.headway_s)
      .with("minGap", driver.min_gap_m)
      .with("speedFactor", driver.speed_factor)
      .with("speedDev", 0)
      .with("maxSpeed", driver.max_speed_mps);
  if (driver.lane_keeping) {
    type.with("lcStrategic", -1).with("lcSpeedGain", 0).with("lcKeepRight", 0).with("lcCooperative", 0);
  }
  return type;
}

}  // namespace

std::string ego_definitions(const std::vector<std::string>& edges, double length_m, double width_m,
                            const std::string& driver) {
  Element type("vType");
  type.with("id", kEgoName).with("length", length_m).with("width", width_m).with("speedDev", 0);
  return type.closed(driver) + route_definition(kEgoName, edges);
}

std::string flow_definitions(const Network& network, const FlowPlan& plan) {
  std::string text;
  for (std::size_t way = 0; way < plan.ways.size(); ++way) {
    text += route_definition("way" + std::to_string(way), plan.ways[way].route.edges);
  }
  for (std::size_t i = 0; i < plan.departures.size(); ++i) {
    const Departure& departure = plan.departures[i];
    const std::string id = "car" + std::to_string(i);
    text += driver_definition(id, departure.driver).closed();
    Element vehicle("vehicle");
    vehicle.with("id", id)
        .with("type", id)
        .with("route", "way" + std::to_string(departure.way))
        .with("depart", departure.time_s)
        .with("departLane", network.lanes[static_cast<std::size_t>(departure.lane)].index)
        .with("departPos", "base")
        .with("departSpeed", "max");
    if (const int end_lane = plan.ways[departure.way].route.end_lane; end_lane >= 0) {
      vehicle.with("arrivalLane", end_lane);
    }
    text += vehicle.closed();
  }
  return text;
}

std::string routes_file(const std::string& definitions) {
  return "<routes>\n" + definitions + "</routes>\n";
}

}  // namespace s4tp::world
