#include "sim_host/baselines/static_drf.hpp"

#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

const RegisterPlanner kRegistered{{"static_drf", "s4tp with every other car frozen where it is",
                                   ecu_with<StaticDrfPlanner<false>>,
                                   ecu_with<Guarded<StaticDrfPlanner<true>>>}};

}  // namespace
}  // namespace s4tp::baselines
