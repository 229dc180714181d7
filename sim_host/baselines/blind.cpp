#include "sim_host/baselines/blind.hpp"

namespace s4tp::baselines {

Status BlindPlanner::plan(const PlannerInput& input, Plan& plan, Explanation& explanation) {
  PlannerInput empty_road = input;
  empty_road.tracks.clear();
  return planner_.plan(empty_road, plan, explanation);
}

}  // namespace s4tp::baselines
