#include "sim_host/world/map/sumo_lane.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim_host/world/map/xml_values.hpp"

namespace s4tp::map {
namespace {

constexpr double kDefaultWidth_m = 3.2;      // SUMO's own
constexpr double kDefaultSpeed_mps = 13.89;  // SUMO's own
constexpr double kFurthest_m = 1e8;
constexpr double kSamePoint_m = 0.005;

/// Whether a list of vehicle classes means our cars.
bool names_cars(const std::vector<std::string>& classes) {
  return std::any_of(classes.begin(), classes.end(),
                     [](const std::string& each) { return each == "passenger" || each == "all"; });
}

std::vector<Vec2> shape_of(const pugi::xml_node& lane, const std::string& where) {
  std::vector<Vec2> points;
  for (const std::string& word : words_in(lane.attribute("shape").value())) {
    const std::size_t comma = word.find(',');
    const std::string after = comma == std::string::npos ? "" : word.substr(comma + 1);
    const std::optional<double> x = number_in(word.substr(0, comma));
    const std::optional<double> y = number_in(after.substr(0, after.find(',')));
    if (!x || !y || std::abs(*x) > kFurthest_m || std::abs(*y) > kFurthest_m) {
      fail_at(where, "shape holds \"" + word + "\": expected x,y or x,y,z within 1e8 m");
    }
    if (points.empty() || std::hypot(*x - points.back().x, *y - points.back().y) > kSamePoint_m) {
      points.push_back({*x, *y});
    }
  }
  return points;
}

}  // namespace

void fail_at(const std::string& where, const std::string& what) {
  throw std::runtime_error(where + ": " + what);
}

double lane_number(const pugi::xml_node& node, const char* name, double missing, const std::string& where) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) {
    return missing;
  }
  const std::optional<double> value = number_in(attribute.value());
  if (!value) {
    fail_at(where, std::string(name) + "=\"" + attribute.value() + "\": expected a number");
  }
  return *value;
}

bool open_to_cars(const pugi::xml_node& lane) {
  const std::vector<std::string> allowed = words_in(lane.attribute("allow").value());
  return allowed.empty() ? !names_cars(words_in(lane.attribute("disallow").value())) : names_cars(allowed);
}

bool change_open(const pugi::xml_node& lane, const char* side) {
  const std::vector<std::string> allowed = words_in(lane.attribute(side).value());
  return allowed.empty() || names_cars(allowed);
}

std::optional<Lane> read_lane(const pugi::xml_node& node, const std::string& edge, bool in_junction,
                              const std::string& where) {
  Lane lane;
  lane.name = node.attribute("id").value();
  lane.edge = edge;
  lane.in_junction = in_junction;
  lane.width_m = lane_number(node, "width", kDefaultWidth_m, where);
  lane.speed_limit_mps = lane_number(node, "speed", kDefaultSpeed_mps, where);
  if (lane.width_m <= 0.0 || lane.width_m > 100.0 || lane.speed_limit_mps <= 0.0) {
    fail_at(where, "expected width (up to 100 m) and speed above 0");
  }
  const std::vector<Vec2> shape = shape_of(node, where);
  if (shape.size() < 2 && lane.in_junction) {
    return std::nullopt;
  }
  if (shape.size() < 2) {
    fail_at(where, "shape: expected at least two different points x,y");
  }
  lane.centre = Polyline(shape);
  lane.drawn = lane.centre;
  lane.sumo_length_m = lane_number(node, "length", lane.centre.length_m(), where);
  return lane;
}

}  // namespace s4tp::map
