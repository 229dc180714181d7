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
// 6 decisions, no two scores alike (the 24 differ modulo 32), with and without a decision that must be kept.
TEST(DecisionProperty, WhoIsBeatenWithoutRiskIsBeaten) {
  EXPECT_TRUE(rc::check([] {
    const int count = *rc::gen::inRange(1, 5);
    const bool has_must_keep = *rc::gen::arbitrary<bool>();
    const DecisionKey must_keep = 2;
    const auto scored = rc::gen::apply(
        [](int key, int base, int risk) {
          return Scored{static_cast<DecisionKey>(key), static_cast<float>(base), static_cast<float>(risk)};
        },
        rc::gen::inRange(0, 6), rc::gen::inRange(0, 8), rc::gen::inRange(0, 8));
    const auto candidates = *rc::gen::container<std::vector<Scored>>(kMaxCandidates, scored);
    DecisionList all;
    DecisionList open;
    for (int i = 0; i < kMaxCandidates; ++i) {
      Scored one = candidates[static_cast<std::size_t>(i)];
      one.without_risk = 32.0F * one.without_risk + static_cast<float>(i);
      one.risk = 32.0F * one.risk;
      all.offer(one.key, i, one.without_risk + one.risk);
      const int places = has_must_keep && one.key == must_keep ? kMaxCandidates : count;
      if (open.open_to(one.key, one.without_risk, places))
        open.offer(one.key, i, one.without_risk + one.risk);
    }
    all.shortlist(count, has_must_keep, must_keep);
    open.shortlist(count, has_must_keep, must_keep);
    RC_ASSERT(open.size() == all.size());
    for (int i = 0; i < all.size(); ++i) RC_ASSERT(open[i].candidate == all[i].candidate);
  }));
}

}  // namespace
}  // namespace s4tp::planner
