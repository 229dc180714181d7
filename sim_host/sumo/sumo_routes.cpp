#include "sim_host/sumo/sumo_routes.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "sim_host/world/map/escaped.hpp"
#include "sim_host/world/traffic/social_value.hpp"

namespace s4tp::sumo {
namespace {

// A driver of orientation 0 is SUMO's default driver; the others differ from it as they differ from ours.
const traffic::SocialTraits kOrdinary = traffic::social_traits(0.0);
constexpr double kTimegapMinor_s = 1.0;  // SUMO's default
constexpr double kWait_s = 10.0;         // at a line, of a patient driver: p95 in docs/traffic_tables.md

/// An element with everything in it written so that reading gives the same number.
class Element {
 public:
  explicit Element(const char* name) { text_ << std::boolalpha, text_.precision(17), text_ << '<' << name; }

  Element& with(const char* attribute, const std::string& value) {
    text_ << ' ' << attribute << "=\"" << map::escaped(value) << '"';  // edge ids may hold any character
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
  std::ostringstream text_;
};

std::string route_definition(const std::string& id, const std::vector<std::string>& edges) {
  std::string list;
  for (const std::string& edge : edges) {
    list += (list.empty() ? "" : " ") + edge;
  }
  return Element("route").with("id", id).with("edges", list).closed();
}

Element driver_definition(const std::string& id, const traffic::Departure& departure) {
  const traffic::Driver& driver = departure.driver;
  Element type("vType");
  type.with("id", id)
      .with("length", departure.length_m)
      .with("width", departure.width_m)
      .with("accel", driver.acceleration_mps2)
      .with("decel", driver.deceleration_mps2)
      .with("emergencyDecel", driver.emergency_mps2)
      .with("sigma", driver.imperfection)
      .with("tau", driver.headway_s)
      .with("minGap", driver.min_gap_m)
      .with("speedFactor", driver.speed_factor)
      .with("speedDev", 0)
      .with("maxSpeed", driver.max_speed_mps);
  type.with("jmTimegapMinor", std::max(0.0, kTimegapMinor_s + driver.gap_margin_s - kOrdinary.gap_margin_s))
      .with("impatience",
            std::clamp(kWait_s / driver.patience_s - kWait_s / kOrdinary.patience_s, -1.0, 1.0));
  if (driver.lane_keeping) {
    type.with("lcStrategic", -1).with("lcSpeedGain", 0).with("lcKeepRight", 0).with("lcCooperative", 0);
  } else {
    type.with("lcSpeedGain", kOrdinary.change_threshold_mps2 / driver.change_threshold_mps2)
        .with("lcAssertive", driver.asked_braking_mps2 / kOrdinary.asked_braking_mps2)
        .with("lcCooperative", 1.0 - driver.rivalry);
  }
  return type;
}

[[noreturn]] void refuse(const scenario::Scenario& scenario, const std::string& edge) {
  throw std::runtime_error(scenario.network_file.string() + ": edge \"" + edge +
                           "\": SUMO separates edges by blanks and takes every letter outside ASCII for one, "
                           "so it cannot drive here; the "
                           "built-in traffic can");
}

bool is_blank(unsigned char c) {
  return c <= ' ';
}

bool is_blank_to_sumo(unsigned char c) {
  return is_blank(c) || c >= 0x80;
}

void check_route(const scenario::Scenario& scenario, const std::vector<std::string>& edges) {
  for (const std::string& edge : edges) {
    if (std::any_of(edge.begin(), edge.end(), is_blank_to_sumo)) refuse(scenario, edge);
  }
}

}  // namespace

void check_names(const scenario::Scenario& scenario) {
  for (const map::Lane& lane : scenario.network.lanes) {  // its network files list them at each junction
    if (std::any_of(lane.edge.begin(), lane.edge.end(), is_blank)) refuse(scenario, lane.edge);
  }
  check_route(scenario, scenario.mission.edges);
  for (const scenario::FlowGroup& group : scenario.flows) {
    for (const scenario::TrafficRoute& route : group.routes) check_route(scenario, route.edges);
  }
}

std::string ego_definitions(const std::vector<std::string>& edges, double length_m, double width_m,
                            const std::string& driver) {
  Element type("vType");
  type.with("id", kEgoName).with("length", length_m).with("width", width_m).with("speedDev", 0);
  return type.closed(driver) + route_definition(kEgoName, edges);
}

std::string flow_definitions(const map::Network& network, const traffic::FlowPlan& plan) {
  std::string text;
  for (std::size_t way = 0; way < plan.ways.size(); ++way) {
    text += route_definition("way" + std::to_string(way), plan.ways[way].route.edges);
  }
  for (std::size_t i = 0; i < plan.departures.size(); ++i) {
    const traffic::Departure& departure = plan.departures[i];
    const std::string id = "car" + std::to_string(i);
    text += driver_definition(id, departure).closed();
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

}  // namespace s4tp::sumo
