#include "sim_host/world/scenario/vehicle_types.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sim_host/world/map/xml_values.hpp"

namespace s4tp::scenario {
namespace {

/// SUMO's defaults where a class differs from a passenger car: Vehicle_Type_Parameter_Defaults in its manual.
struct ClassDefaults {
  const char* name;
  double length_m, width_m, min_gap_m, acceleration_mps2, deceleration_mps2, max_speed_mps;
};
constexpr std::array<ClassDefaults, 11> kClasses{{
    {"moped", 2.1, 0.8, 2.5, 1.1, 7.0, 45.0 / 3.6},
    {"motorcycle", 2.2, 0.9, 2.5, 6.0, 10.0, 200.0 / 3.6},
    {"bicycle", 1.6, 0.65, 0.5, 1.2, 3.0, 50.0 / 3.6},
    {"scooter", 1.2, 0.5, 0.5, 1.0, 3.0, 25.0 / 3.6},
    {"truck", 7.1, 2.4, 2.5, 1.3, 4.0, 130.0 / 3.6},
    {"trailer", 16.5, 2.55, 2.5, 1.1, 4.0, 130.0 / 3.6},
    {"bus", 12.0, 2.5, 2.5, 1.2, 4.0, 85.0 / 3.6},
    {"coach", 14.0, 2.6, 2.5, 2.0, 4.0, 100.0 / 3.6},
    {"delivery", 6.5, 2.16, 2.5, 2.6, 4.5, 200.0 / 3.6},
    {"emergency", 6.5, 2.16, 2.5, 2.6, 4.5, 200.0 / 3.6},
    {"passenger", 5.0, 1.8, 2.5, 2.6, 4.5, 200.0 / 3.6},
}};
constexpr double kNone = -1.0;

RoadUse use_of(const std::string& vehicle_class) {
  static const std::set<std::string> elsewhere{
      "tram",   "rail_urban", "rail",  "rail_electric", "rail_fast", "ship",     "container",  "cable_car",
      "subway", "aircraft",   "drone", "pedestrian",    "lightrail", "cityrail", "wheelchair", "rail_slow"};
  static const std::set<std::string> cars{"", "passenger", "private", "taxi", "hov", "evehicle"};
  return elsewhere.count(vehicle_class) != 0 ? RoadUse::kElsewhere
         : cars.count(vehicle_class) != 0    ? RoadUse::kCar
                                             : RoadUse::kOtherOnTheRoad;
}

}  // namespace

std::string element_name(const pugi::xml_node& node) {
  const std::string id = node.attribute("id").value();
  return "<" + std::string(node.name()) +
         (id.empty() ? "> at byte " + std::to_string(node.offset_debug()) : " id=\"" + id + "\">");
}

double attribute_number(const pugi::xml_node& node, const char* name, double missing, double low,
                        double high) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) {
    return missing;
  }
  const std::optional<double> value = map::number_in(attribute.value());
  if (!value || *value < low || *value > high) {
    std::ostringstream what;
    what << element_name(node) << ": " << name << "=\"" << attribute.value() << "\": expected a number";
    if (value) {
      what << " from " << low << " to " << high;
    }
    throw std::runtime_error(what.str());
  }
  return *value;
}

void read_speed_factor(const pugi::xml_node& node, DriverModel& model) {
  const std::string text = node.attribute("speedFactor").value();
  if (!text.empty()) {
    std::string numbers = text;
    const bool distributed = text.rfind("norm", 0) == 0 && text.back() == ')';
    if (distributed) {
      numbers = text.substr(0, text.size() - 1).substr(std::min(text.size() - 1, text.find('(') + 1));
    }
    std::vector<double> values;
    std::istringstream list(numbers);
    for (std::string part; std::getline(list, part, ',');) {
      values.push_back(map::number_in(part).value_or(kNone));
    }
    const bool right = distributed ? values.size() == 2 || values.size() == 4 : values.size() == 1;
    if (!right || !(values[0] > 0.0 && values[0] <= 5.0) ||
        (distributed && !(values[1] >= 0.0 && values[1] <= 2.0))) {
      throw std::runtime_error(element_name(node) + ": speedFactor=\"" + text +
                               "\": expected a number above 0, norm(mean,dev) or normc(mean,dev,low,high)");
    }
    model.speed_factor_mean = values[0];
    if (distributed) {
      model.speed_factor_deviation = values[1];
    }
  }
  model.speed_factor_deviation = attribute_number(node, "speedDev", model.speed_factor_deviation, 0.0, 2.0);
}

VehicleTypes::VehicleTypes() {
  VehicleType standard;
  standard.model.name = "DEFAULT_VEHTYPE";
  standard.model.max_speed_mps = kClasses.back().max_speed_mps;
  types_["DEFAULT_VEHTYPE"] = {standard};
  types_["DEFAULT_TAXITYPE"] = {standard};
}

const std::vector<VehicleType>* VehicleTypes::find(const std::string& id) const {
  const auto found = types_.find(id);
  return found == types_.end() ? nullptr : &found->second;
}

VehicleType VehicleTypes::read_type(const pugi::xml_node& node) {
  VehicleType type;
  const std::string vehicle_class = node.attribute("vClass").value();
  type.use = use_of(vehicle_class);
  DriverModel& model = type.model;
  model.name = node.attribute("id").value();
  const ClassDefaults* defaults = &kClasses.back();
  for (const ClassDefaults& each : kClasses) {
    defaults = each.name == vehicle_class ? &each : defaults;
  }
  model.length_m = attribute_number(node, "length", defaults->length_m, 0.1, 50.0);
  model.width_m = attribute_number(node, "width", defaults->width_m, 0.1, 5.0);
  model.min_gap_mean_m = attribute_number(node, "minGap", defaults->min_gap_m, 0.0, 100.0);
  model.acceleration_mps2 = attribute_number(node, "accel", defaults->acceleration_mps2, 0.01, 20.0);
  model.deceleration_mps2 = attribute_number(node, "decel", defaults->deceleration_mps2, 0.01, 20.0);
  model.max_speed_mps = attribute_number(node, "maxSpeed", defaults->max_speed_mps, 0.1, 150.0);
  model.sigma = attribute_number(node, "sigma", model.sigma, 0.0, 1.0);
  model.headway_s = attribute_number(node, "tau", model.headway_s, 0.01, 20.0);
  read_speed_factor(node, model);
  model.weight = attribute_number(node, "probability", 1.0, 0.0, 1e9);
  return type;
}

void VehicleTypes::read(const pugi::xml_node& parent) {
  for (const pugi::xml_node node : parent.children("vType")) {
    types_[node.attribute("id").value()] = {read_type(node)};
  }
  for (const pugi::xml_node node : parent.children("vTypeDistribution")) {
    std::vector<VehicleType> all;
    for (const pugi::xml_node inner : node.children("vType")) {
      all.push_back(read_type(inner));
      types_[all.back().model.name] = {all.back()};
    }
    const std::vector<std::string> weights = map::words_in(node.attribute("probabilities").value());
    std::size_t at = 0;
    for (const std::string& name : map::words_in(node.attribute("vTypes").value())) {
      const std::vector<VehicleType>* named = find(name);
      const double weight = at < weights.size() ? map::number_in(weights[at]).value_or(kNone)
                            : weights.empty()   ? 1.0
                                                : kNone;
      if (named == nullptr || weight < 0.0) {
        throw std::runtime_error(element_name(node) +
                                 ": expected known vTypes and as many probabilities; \"" + name +
                                 "\" is none or has none");
      }
      all.push_back(named->front());
      all.back().model.weight = weights.empty() ? named->front().model.weight : weight;
      ++at;
    }
    if (all.empty()) {
      throw std::runtime_error(element_name(node) + ": expected at least one vType");
    }
    types_[node.attribute("id").value()] = all;
  }
}

}  // namespace s4tp::scenario
