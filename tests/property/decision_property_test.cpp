#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <vector>

#include "algo/planner/decision.hpp"

namespace s4tp::planner {
namespace {

struct Scored {
  DecisionKey key;
  float without_risk;
  float risk;
};

// Leaving out what open_to() declares beaten before its risk is known changes no shortlist: 24 candidates of
// 12 decisions, no two scores alike (the 24 differ modulo 32), with and without decisions that are reserved.
TEST(DecisionProperty, WhoIsBeatenWithoutRiskIsBeaten) {
  EXPECT_TRUE(rc::check([] {
    Reserved reserved;
    const int count = *rc::gen::inRange(1, 5);
    reserved.keeps_plan = *rc::gen::arbitrary<bool>();
    reserved.plan = 2;
    reserved.goes_on = *rc::gen::inRange(0, 3);
    const auto scored = rc::gen::apply(
        [](int key, int base, int risk) {
          return Scored{static_cast<DecisionKey>(key), static_cast<float>(base), static_cast<float>(risk)};
        },
        rc::gen::inRange(0, 12), rc::gen::inRange(0, 8), rc::gen::inRange(0, 8));
    const auto candidates = *rc::gen::container<std::vector<Scored>>(kMaxCandidates, scored);
    DecisionList all;
    DecisionList open;
    for (int i = 0; i < kMaxCandidates; ++i) {
      Scored one = candidates[static_cast<std::size_t>(i)];
      one.without_risk = 32.0F * one.without_risk + static_cast<float>(i);
      one.risk = 32.0F * one.risk;
      all.offer(one.key, i, one.without_risk + one.risk);
      const int path = path_of(one.key);
      const bool stays = (reserved.keeps_plan && one.key == reserved.plan) ||
                         (reserved.holds(path) && open.leads_path(path, one.without_risk));
      const int places = stays ? kMaxCandidates : count;
      if (open.open_to(one.key, one.without_risk, places))
        open.offer(one.key, i, one.without_risk + one.risk);
    }
    all.shortlist(count, reserved);
    open.shortlist(count, reserved);
    RC_ASSERT(open.size() == all.size());
    for (int i = 0; i < all.size(); ++i) RC_ASSERT(open[i].candidate == all[i].candidate);
  }));
}

}  // namespace
}  // namespace s4tp::planner
