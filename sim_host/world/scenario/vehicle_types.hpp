#pragma once
/// SUMO's vehicle types as drivers and cars of ours.

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "sim_host/world/scenario/traffic_demand.hpp"

namespace s4tp::scenario {

/// kElsewhere: rail, ships, pedestrians: not on the road at all.
enum class RoadUse { kCar, kOtherOnTheRoad, kElsewhere };

struct VehicleType {
  DriverModel model;
  RoadUse use = RoadUse::kCar;
};

/// <vType> and <vTypeDistribution> by id; what is not said is SUMO's default for the class.
class VehicleTypes {
 public:
  VehicleTypes();
  /// Takes every type among the children of `parent`. \throws std::runtime_error "ELEMENT: what was expected"
  void read(const pugi::xml_node& parent);
  /// \return the kinds by weight; null: there is no such type
  [[nodiscard]] const std::vector<VehicleType>* find(const std::string& id) const;

 private:
  VehicleType read_type(const pugi::xml_node& node);
  std::map<std::string, std::vector<VehicleType>> types_;
};

/// speedFactor="1.1", "norm(1,0.1)", "normc(1,0.1,0.2,2)". \throws std::runtime_error without the element
void read_speed_factor(const pugi::xml_node& node, DriverModel& model);

/// "<vType id="x">", as errors name it.
[[nodiscard]] std::string element_name(const pugi::xml_node& node);

/// \throws std::runtime_error "ELEMENT: ATTRIBUTE="TEXT": expected a number from LOW to HIGH"
[[nodiscard]] double attribute_number(const pugi::xml_node& node, const char* name, double missing,
                                      double low, double high);

}  // namespace s4tp::scenario
