#include "sim_host/world/scenario/flow_attributes.hpp"

#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "sim_host/world/map/xml_values.hpp"
#include "sim_host/world/scenario/vehicle_types.hpp"

namespace s4tp::scenario {
namespace {

constexpr double kTimeMax_s = 1e6;

}  // namespace

[[noreturn]] void fail_at(const pugi::xml_node& node, const std::string& what) {
  throw std::runtime_error(element_name(node) + ": " + what);
}

std::string quoted(const pugi::xml_node& node, const char* name) {
  return std::string(name) + "=\"" + node.attribute(name).value() + "\"";
}

double time_of(const pugi::xml_node& node, const char* name, double missing_s) {
  if (!node.attribute(name)) {
    return missing_s;
  }
  std::vector<double> parts;  // the last one first
  std::istringstream text(node.attribute(name).value());
  for (std::string part; std::getline(text, part, ':');) {
    parts.insert(parts.begin(), map::number_in(part).value_or(2.0 * kTimeMax_s));
  }
  static constexpr double kUnits_s[] = {1.0, 60.0, 3600.0, 86400.0};
  double time_s = parts.empty() || parts.size() == 2 || parts.size() > 4 ? 2.0 * kTimeMax_s : 0.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(parts.size(), 4); ++i) {
    time_s += kUnits_s[i] * parts[i];
  }
  if (!(time_s > -kTimeMax_s && time_s < kTimeMax_s)) {
    fail_at(node, quoted(node, name) + ": expected seconds or h:m:s");
  }
  return time_s;
}

void read_spacing(const pugi::xml_node& node, const pugi::xml_node& interval, DemandFlow& flow) {
  flow.begin_s = time_of(node, "begin", time_of(interval, "begin", 0.0));
  flow.end_s = time_of(node, "end", time_of(interval, "end", flow.end_s));
  const double number = attribute_number(node, "number", -1.0, 0.0, 1e7);
  if (node.attribute("number")) {
    flow.number = static_cast<int>(number);
  }
  const std::string period = node.attribute("period").value();
  const double per_hour =
      attribute_number(node, "perHour", attribute_number(node, "vehsPerHour", 0.0, 0.0, 1e6), 0.0, 1e6);
  if (period.rfind("exp(", 0) == 0 && period.back() == ')') {
    const double rate = map::number_in(period.substr(4, period.size() - 5)).value_or(0.0);
    if (!(rate > 0.0 && rate <= 100.0)) {
      fail_at(node, quoted(node, "period") + ": expected exp(RATE), vehicles a second, above 0");
    }
    flow.spacing = DemandFlow::Spacing::kExponential;
    flow.period_s = 1.0 / rate;
  } else if (!period.empty()) {
    flow.period_s = attribute_number(node, "period", 1.0, 0.01, kTimeMax_s);
  } else if (node.attribute("probability")) {
    flow.spacing = DemandFlow::Spacing::kPerSecond;
    flow.probability = attribute_number(node, "probability", 0.0, 0.0, 1.0);
  } else if (per_hour > 0.0) {
    flow.period_s = 3600.0 / per_hour;
  } else if (flow.number > 0 && node.attribute("number") && flow.end_s > flow.begin_s &&
             flow.end_s < kTimeMax_s) {
    flow.period_s = (flow.end_s - flow.begin_s) / flow.number;
  } else if (flow.number == 0 || node.attribute("perHour") || node.attribute("vehsPerHour")) {
    flow.number = 0;
  } else {
    fail_at(node, "expected period, vehsPerHour, perHour, probability, or number with begin and end");
  }
}

void read_depart(const pugi::xml_node& node, DepartWish& wish) {
  const auto word_of = [&](const char* name, const char* missing) {
    return std::string(node.attribute(name).as_string(missing));
  };
  const std::string lane = word_of("departLane", "first");
  const std::string position = word_of("departPos", "base");
  const std::string speed = word_of("departSpeed", "0");
  if (lane == "first" || lane == "allowed") {
    wish.lane = DepartWish::Lane::kFirst;
  } else if (lane == "random" || lane == "free") {
    wish.lane = DepartWish::Lane::kRandom;
  } else if (lane == "best" || lane == "best_prob") {
    wish.lane = DepartWish::Lane::kBest;
  } else {
    const std::optional<double> number = map::number_in(lane);
    if (!number || *number < 0.0 || *number > 99.0) {
      fail_at(node, quoted(node, "departLane") +
                        ": expected a lane's number, first, random, free, allowed or best");
    }
    wish.lane = DepartWish::Lane::kNumber;
    wish.lane_number = static_cast<int>(*number);
  }
  static const std::set<std::string> base{"base", "free", "last", "stop", "splitFront"};
  if (base.count(position) != 0) {
    wish.position = DepartWish::Position::kBase;
  } else if (position == "random" || position == "random_free") {
    wish.position = DepartWish::Position::kRandom;
  } else {
    wish.position = DepartWish::Position::kNumber;
    wish.position_m = attribute_number(node, "departPos", 0.0, -1e6, 1e6);
  }
  static const std::set<std::string> fast{"max", "desired", "speedLimit", "last", "avg"};
  if (fast.count(speed) != 0) {
    wish.speed = DepartWish::Speed::kAsTrafficAllows;
  } else if (speed == "random") {
    wish.speed = DepartWish::Speed::kRandom;
  } else {
    wish.speed_mps = attribute_number(node, "departSpeed", 0.0, 0.0, 150.0);
  }
}

}  // namespace s4tp::scenario
