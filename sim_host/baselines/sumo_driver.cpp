/// SUMO's own driver (Krauss following, its lane changes and junction rules) in the ego's place, from the
/// mission's start on: what a simulator takes for human, and a reference for time and success. It knows its
/// traffic from inside, so there is no ECU and no guard; what it does is recorded and judged as any drive is.

#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

const RegisterPlanner kRegistered{
    {"sumo_driver", "SUMO's own driver, in SUMO's traffic", nullptr, nullptr, true}};

}  // namespace
}  // namespace s4tp::baselines
