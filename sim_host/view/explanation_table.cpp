#include "sim_host/view/explanation_table.hpp"

#include <cstdio>

#include "sim_host/view/plan_numbers.hpp"

namespace s4tp::view {
namespace {

const char* intent_name(trajectory::Intent intent) {
  switch (intent) {
    case trajectory::Intent::kAccelerate:
      return "accelerate";
    case trajectory::Intent::kStop:
      return "stop";
    case trajectory::Intent::kFollow:
      return "follow";
    case trajectory::Intent::kPrevious:
      return "previous";
  }
  return "?";
}

/// What kept the plan from going further, as one word.
const char* cause_name(safety::Cause cause) {
  static constexpr const char* kCauses[] = {"",         "no path", "road end",     "leader",
                                            "follower", "zone",    "stops in zone"};
  return kCauses[static_cast<int>(cause)];
}

}  // namespace

void print_explanations(std::ostream& out, const campaign::Trace& trace, double pre_roll_s) {
  out << "  time s  status         plan   v m/s  path intent       a m/s2  cand infeas refused"
         "   progress  speed   jerk    lat   lane   risk   total  runner-up  risk from  blocked by\n";
  for (const campaign::CycleTrace& cycle : trace.cycles) {
    const planner::Explanation& e = cycle.record.explanation;
    const planner::CostBreakdown& c = e.chosen_cost;
    const Plan& plan = cycle.record.plan;
    const float accelerations = plan.trajectory.points[5].acceleration_mps2;
    char line[300];
    std::snprintf(line, sizeof line,
                  "%8.1f  %-13s  %-5s %6.2f  %4d %-11s %7.2f  %4d %6d %7d  %8.1f %6.1f %6.2f %6.2f "
                  "%6.1f %6.1f "
                  "%7.1f  %9.1f  %9d  %s %d\n",
                  plan.start_ms / 1000.0 - pre_roll_s, status_name(e.status),
                  plan.kind == PlanKind::kDrive ? "drive" : "stop",
                  static_cast<double>(plan.trajectory.points[0].speed_mps), e.chosen.path,
                  e.status == Status::kOk ? intent_name(e.chosen.intent) : "-",
                  static_cast<double>(accelerations), e.candidate_count,
                  rejected(e, trajectory::Rejection::kInfeasible),
                  rejected(e, trajectory::Rejection::kRefused), static_cast<double>(c.progress),
                  static_cast<double>(c.speed), static_cast<double>(c.jerk), static_cast<double>(c.lateral),
                  static_cast<double>(c.lane), static_cast<double>(c.risk), static_cast<double>(c.total()),
                  static_cast<double>(e.runner_up_cost.total()), e.dominating_track,
                  cause_name(e.blocking.verdict.cause), e.blocking.track);
    out << line;
  }
}

}  // namespace s4tp::view
