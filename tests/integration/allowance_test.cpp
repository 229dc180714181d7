// Drives with little or nothing of the work allowance, and with cycles that miss their deadline.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/campaign/trace.hpp"

namespace s4tp {
namespace {

constexpr int kPercents[] = {50, 10, 0};

std::string name_of(int percent) {
  return "allowance_" + std::to_string(percent);
}

/// The firmware's planner with that share of each stage's allowance.
template <int kPercent>
class Rationed final : public planner::PlanningCycle {
 public:
  Rationed() {
    for (int* const units : {&allowance.candidates, &allowance.prediction, &allowance.decisions,
                             &allowance.exact_risks, &allowance.optimizer_iterations}) {
      *units = *units * kPercent / 100;
    }
  }
};

template <int kPercent>
baselines::PlannerEntry entry() {
  return {name_of(kPercent), "for this test", baselines::ecu_with<Rationed<kPercent>>,
          baselines::ecu_with<Rationed<kPercent>>};
}

const baselines::RegisterPlanner kHalf{entry<50>()};
const baselines::RegisterPlanner kTenth{entry<10>()};
const baselines::RegisterPlanner kNone{entry<0>()};

scenario::Scenario scenario_of(const std::string& name, const std::string& flavour) {
  return scenario::load_scenario(std::string(S4TP_SOURCE_DIR) + "/sim_host/scenarios/" + name, flavour);
}

bool can_be_driven(const Plan& plan) {
  if (plan.kind == PlanKind::kNone) return false;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& point = plan.trajectory.points[i];
    const bool sound = std::isfinite(point.rear_axle.x_m) && std::isfinite(point.rear_axle.y_m) &&
                       std::abs(point.rear_axle.heading_rad) <= 3.15F && point.speed_mps >= 0.0F &&
                       point.speed_mps < 60.0F && std::abs(point.acceleration_mps2) <= 8.1F &&
                       std::abs(point.curvature_1pm) <= 0.25F;
    if (!sound) return false;
    if (i == 0) continue;
    const TrajectoryPoint& before = plan.trajectory.points[i - 1];
    const float moved_m =
        std::hypot(point.rear_axle.x_m - before.rear_axle.x_m, point.rear_axle.y_m - before.rear_axle.y_m);
    if (std::abs(moved_m - 0.05F * (point.speed_mps + before.speed_mps)) > 0.15F) return false;
  }
  return true;
}

class Allowance : public testing::TestWithParam<const char*> {};

// CORE-009, CORE-073: in every scenario, with half, a tenth and none of what each stage may spend: every plan of the
// drive can be driven, none used more than it was allowed, and nobody is touched through our fault. With none
// of it there is no candidate, and every plan is the minimum-risk manoeuvre.
TEST_P(Allowance, EveryCutGivesAPlan) {
  for (const char* const flavour : {"smarts", "social"}) {
    scenario::Scenario scenario = scenario_of(GetParam(), flavour);
    scenario.mission.time_limit_s = 15.0;
    for (const int percent : kPercents) {
      campaign::EpisodeOptions options;
      options.seed = 11;
      options.planner = name_of(percent);
      options.trace = true;
      const campaign::EpisodeResult result = run_episode(scenario, options);
      ASSERT_NE(result.trace, nullptr);
      EXPECT_GT(result.trace->cycles.size(), 20U);
      for (const campaign::CycleTrace& cycle : result.trace->cycles) {
        const planner::Explanation& explanation = cycle.record.explanation;
        ASSERT_TRUE(can_be_driven(cycle.record.plan))
            << options.planner << " at " << cycle.record.computed_ms;
        EXPECT_LE(explanation.candidate_count, kMaxCandidates * percent / 100);
        EXPECT_LE(explanation.work[static_cast<int>(planner::Stage::kOptimize)], 16 * percent / 100);
        EXPECT_LE(explanation.work[static_cast<int>(planner::Stage::kExactRisk)],
                  kMaxExactRisk * percent / 100);
        if (percent == 0) {
          EXPECT_EQ(cycle.record.plan.kind, PlanKind::kMinimumRisk);
        }
      }
      for (const traffic::Collision& collision : result.recording.collisions) {
        EXPECT_NE(collision.fault, traffic::Fault::kEgo)
            << options.planner << ": " << traffic::cause_words(collision.fault, collision.cause);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Allowance,
                         testing::Values("left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"),
                         [](const auto& scenario) { return std::string(scenario.param); });

// ECU-019 ECU-020 ECU-036 ECU-076 In a drive, one cycle in four that misses its deadline leaves the old plan
// in force and the car driving; from 8 s on every cycle misses, and 500 ms later the minimum-risk manoeuvre
// takes over and brings the car to rest.
TEST(DeadlineMisses, KeepTheOldPlanAndEndInTheLadder) {
  scenario::Scenario scenario = scenario_of("cruise", "smarts");
  scenario.mission.time_limit_s = 16.0;
  campaign::EpisodeOptions options;
  options.trace = true;
  for (int i = 4; i < 70; i += 4) options.deadline_misses_s.push_back(0.1 * i + 0.05);
  for (int i = 80; i < 160; ++i) options.deadline_misses_s.push_back(0.1 * i + 0.05);
  const campaign::EpisodeResult result = run_episode(scenario, options);
  bool lost = false;
  for (const traffic::Snapshot& snapshot : result.recording.snapshots) {
    if (snapshot.time_s > 2.0 && snapshot.time_s < 7.9) {
      EXPECT_GT(snapshot.ego.speed_mps, 5.0) << snapshot.time_s;
    }
  }
  for (const ecu::ModeRecord& mode : result.trace->modes) lost |= mode.to == ecu::Mode::kMinimumRisk;
  EXPECT_TRUE(lost);
  EXPECT_LT(result.recording.snapshots.back().ego.speed_mps, 0.1);
  EXPECT_TRUE(result.recording.collisions.empty());
}

}  // namespace
}  // namespace s4tp
