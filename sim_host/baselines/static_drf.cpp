#include "sim_host/baselines/static_drf.hpp"

#include "sim_host/campaign/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

const campaign::RegisterPlanner kRegistered{{"static_drf", "s4tp with every other car frozen where it is",
                                             campaign::ecu_with<StaticDrfPlanner<false>>,
                                             campaign::ecu_with<Guarded<StaticDrfPlanner<true>>>}};

}  // namespace
}  // namespace s4tp::baselines
