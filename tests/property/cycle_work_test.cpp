// Whatever the scene, a cycle keeps to its allowance of work.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <memory>
#include <random>

#include "algo/planner/planner.hpp"
#include "algo/trajectory/plan_limits.hpp"
#include "tests/target/cost_scene.hpp"

namespace s4tp::planner {
namespace {

/// A scene of up to sixteen vehicles that mostly come to one place.
test::Genome random_genome(unsigned seed) {
  std::mt19937 random(seed);
  test::Genome genome;
  for (std::uint8_t& gene : genome.genes) gene = static_cast<std::uint8_t>(random());
  return genome;
}

/// What the dearest of its cycles was charged; every one has a plan that keeps to the limits.
std::int32_t dearest_cycle(Planner& planner, const test::Genome& genome) {
  const auto scene = std::make_unique<test::CostScene>();
  scene->make(genome);
  EXPECT_EQ(planner.init(Parameters{}), Status::kOk);
  std::int32_t most = 0;
  Plan plan;
  Explanation explanation;
  for (int cycle = 0; cycle < test::kSceneCycles; ++cycle) {
    if (cycle > 0) scene->advance(plan);
    const Status status = planner.plan(scene->input(), plan, explanation);
    EXPECT_NE(status, Status::kInvalidInput);
    if (status == Status::kOk) {
      EXPECT_TRUE(trajectory::keeps_limits(plan.trajectory, Parameters{}));
    }
    most = std::max(most, planner.allowance.cycle - planner.work().left());
  }
  return most;
}

// CORE-076: no random scene takes more of a cycle than allowed, nor of its ranking and of each exact risk; some of
// them would.
TEST(CycleWork, StaysWithinTheAllowance) {
  const auto planner = std::make_unique<Planner>();
  const auto boundless = std::make_unique<Planner>();
  boundless->allowance.cycle = boundless->allowance.ranking = boundless->allowance.exact_risk = 100'000'000;
  int beyond = 0;
  EXPECT_TRUE(rc::check([&](unsigned seed) {
    const test::Genome genome = random_genome(seed);
    RC_ASSERT(dearest_cycle(*planner, genome) <= kCycleWork);
    RC_ASSERT(planner->work().spent(Stage::kExactRisk) <= kMaxExactRisk * (kExactWork + work::kTouches));
    if (dearest_cycle(*boundless, genome) > kCycleWork) ++beyond;
  }));
  EXPECT_GT(beyond, 0);
}

// CORE-009: in random scenes, with any share of a cycle's work, every plan keeps to the limits (dearest_cycle() looks);
// with none of it there is only the minimum-risk manoeuvre.
TEST(CycleWork, AnyShareOfItGivesAPlan) {
  const auto planner = std::make_unique<Planner>();
  EXPECT_TRUE(rc::check([&](unsigned seed, unsigned share) {
    planner->allowance.cycle = static_cast<std::int32_t>(share % (kCycleWork + 1));
    (void)dearest_cycle(*planner, random_genome(seed));
  }));
  test::CostScene scene;
  scene.make(random_genome(1));
  planner->allowance.cycle = 0;
  ASSERT_EQ(planner->init(Parameters{}), Status::kOk);
  Plan plan;
  Explanation explanation;
  (void)planner->plan(scene.input(), plan, explanation);
  EXPECT_EQ(plan.kind, PlanKind::kMinimumRisk);
}

}  // namespace
}  // namespace s4tp::planner
