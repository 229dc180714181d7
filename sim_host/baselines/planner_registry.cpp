#include "sim_host/baselines/planner_registry.hpp"

#include <algorithm>

#include "sim_host/world/scenario/listed.hpp"

namespace s4tp::baselines {
namespace {

std::vector<PlannerEntry>& registry() {
  static std::vector<PlannerEntry> entries;  // made by whoever registers first
  return entries;
}

bool before(const PlannerEntry& a, const PlannerEntry& b) {
  const bool a_second = a.name != "s4tp";
  const bool b_second = b.name != "s4tp";
  return a_second != b_second ? b_second : a.name < b.name;
}

}  // namespace

const std::vector<PlannerEntry>& planners() {
  return registry();
}

const PlannerEntry& find_planner(const std::string& name) {
  for (const PlannerEntry& entry : planners()) {
    if (entry.name == name) return entry;
  }
  throw std::invalid_argument("no planner '" + name +
                              "'; there are: " + scenario::listed(planners(), &PlannerEntry::name));
}

RegisterPlanner::RegisterPlanner(const PlannerEntry& entry) {
  const auto place = std::lower_bound(registry().begin(), registry().end(), entry, before);
  if (place != registry().end() && place->name == entry.name) {
    throw std::logic_error("two planners are called '" + entry.name + "'");
  }
  registry().insert(place, entry);
}

}  // namespace s4tp::baselines
