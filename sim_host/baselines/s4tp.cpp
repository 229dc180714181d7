// The firmware's planner. Its guard is inside: a plan that would not pass is never chosen, so bare is the
// same planner told so.

#include "sim_host/campaign/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

class BarePlanner : public Planner {
 public:
  BarePlanner() { guarded = false; }
};

const campaign::RegisterPlanner kRegistered{
    {"s4tp", "what the firmware has", campaign::ecu_with<BarePlanner>, campaign::ecu_with<Planner>}};

}  // namespace
}  // namespace s4tp::baselines
