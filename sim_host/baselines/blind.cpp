#include "sim_host/baselines/blind.hpp"

#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

const RegisterPlanner kRegistered{
    planner<BlindPlanner>("blind", "s4tp with every other car withheld from it")};

}  // namespace

Status BlindPlanner::plan(const planner::PlannerInput& input, Plan& plan, planner::Explanation& explanation) {
  planner::PlannerInput empty_road = input;
  empty_road.tracks.clear();
  return planner_.plan(empty_road, plan, explanation);
}

}  // namespace s4tp::baselines
