// The firmware's planner. Its guard is inside: a plan that would not pass is never chosen, so bare is the
// same cycle without it.

#include "sim_host/baselines/bare.hpp"
#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

const RegisterPlanner kRegistered{
    {"s4tp", "what the firmware has", ecu_with<BarePlanner>, ecu_with<planner::Planner>}};

}  // namespace
}  // namespace s4tp::baselines
