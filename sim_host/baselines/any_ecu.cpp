#include "sim_host/baselines/any_ecu.hpp"

#include <stdexcept>

#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const PlannerEntry& entry : planners()) names.push_back(entry.name);
  return names;
}

std::unique_ptr<AnyEcu> make_ecu(const std::string& planner, bool guarded, const Parameters& parameters,
                                 const ecu::Ports& ports, planner::Probe* probe) {
  const PlannerEntry& entry = find_planner(planner);
  if (entry.drives_in_sumo) {
    throw std::invalid_argument(planner + " is a driver of SUMO's and runs on no ECU");
  }
  return (guarded ? entry.guarded : entry.bare)(parameters, ports, probe);
}

}  // namespace s4tp::baselines
