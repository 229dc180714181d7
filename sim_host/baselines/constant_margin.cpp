#include "sim_host/baselines/constant_margin.hpp"

#include <algorithm>

#include "algo/trajectory/bicycle.hpp"
#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

constexpr int kStride = 2;  // steps between those looked at
constexpr float kRoundingM = 0.02F;

/// The likeliest future of an agent of the scene.
const satp::Mode& likeliest(const trajectory::Surroundings& seen, int agent) {
  const satp::PredictionSet& expected = seen.conditioned.agents.empty() ? seen.marginal : seen.conditioned;
  for (const satp::AgentPrediction& one : expected.agents) {
    if (one.agent == agent && !one.modes.empty()) return one.modes[0];
  }
  return seen.constant_velocity.agents[agent];
}

const RegisterPlanner kRegistered{
    {"constant_margin", "s4tp with a constant margin in place of the risk field",
     ecu_with<ConstantMarginPlanner<false>>, ecu_with<ConstantMarginPlanner<true>>}};

}  // namespace

Status ConstantMargin::init(const Parameters& parameters) {
  without_field_ = parameters;
  without_field_.scoring.risk = 0.0F;
  return planner::PlanningCycle::init(without_field_);
}

safety::Verdict ConstantMargin::keeps_margin(const Trajectory& trajectory) const {
  const trajectory::Surroundings seen = surroundings();
  for (int agent = 0; agent < seen.scene.agents.size(); ++agent) {
    const Track& track = seen.scene.agents[agent].track;
    const satp::Mode& future = likeliest(seen, agent);
    const auto gap_m = [&](int point, const Pose& centre) {
      return separation(trajectory::ego_box(trajectory.points[point].rear_axle, without_field_),
                        {centre, track.length_m, track.width_m});
    };
    const float least_m = std::min(without_field_.safety.margin_m, gap_m(0, track.centre) - kRoundingM);
    for (int step = kStride - 1; step < kHorizonSteps; step += kStride) {
      if (gap_m(step + 1, future.steps[step]) < least_m)
        return {safety::Cause::kLeader, static_cast<std::uint8_t>(agent)};
    }
  }
  return {};
}

}  // namespace s4tp::baselines
