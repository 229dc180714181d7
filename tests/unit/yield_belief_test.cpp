// What a vehicle's driving says about whether it lets us go first.

#include "algo/satp/yield_belief.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace s4tp::satp {
namespace {

/// One watched vehicle: it would gain 1 m/s^2 to go first and brake with 2 to let us go.
struct Watch {
  scene::Scene scene;
  YieldBeliefs beliefs;
  YieldHypotheses expected[kMaxAgents];

  Watch() {
    scene::Agent agent;
    agent.track.id = 7;
    (void)scene.agents.push(agent);
    scene.watched = 1;
    expected[0] = {true, 1.0F, -2.0F};
  }
  /// `cycles` of driving with that acceleration. \return the log-odds afterwards
  float see(float acceleration_mps2, int cycles = 1) {
    scene.agents[0].track.acceleration_mps2 = acceleration_mps2;
    for (int i = 0; i < cycles; ++i) beliefs.observe(scene, expected);
    return beliefs.evidence(scene.agents[0].track.id);
  }
};

// BELIEF-001 Halfway, at -0.5, nothing is learned; a spread of 1.5 makes -0.8 speak with (1.8^2 - 1.2^2)
// / 4.5 = 0.4 for letting go; 0.1 with (0.9^2 - 2.1^2) / 4.5 = -0.8 against it.
TEST(YieldBelief, DrivingSpeaksForTheNearerHypothesis) {
  EXPECT_NEAR(Watch().see(-0.5F), 0.0F, 1e-6F);
  EXPECT_NEAR(Watch().see(-0.8F), 0.4F, 1e-4F);
  EXPECT_NEAR(Watch().see(0.1F), -0.8F, 1e-4F);
}

// BELIEF-001 However plainly it is seen, a cycle counts for at most 1, and all of them for at most 7.
TEST(YieldBelief, OneCycleIsNoProof) {
  EXPECT_FLOAT_EQ(Watch().see(-12.0F), 1.0F);
  EXPECT_FLOAT_EQ(Watch().see(12.0F), -1.0F);
  EXPECT_LE(Watch().see(-12.0F, 1000), 7.0F);
  EXPECT_GT(Watch().see(-12.0F, 1000), 6.0F);
  EXPECT_GE(Watch().see(12.0F, 1000), -7.0F);
  EXPECT_LT(Watch().see(12.0F, 1000), -6.0F);
}

// BELIEF-002 With nothing to be told apart, evidence for letting us go fades by 0.02 a cycle, against it by
// 0.005: 50 cycles leave 0.98^50 = 0.364 and 0.995^50 = 0.778 of it.
TEST(YieldBelief, EvidenceFades) {
  for (const float seen_mps2 : {-12.0F, 12.0F}) {
    Watch watch;
    const float before = watch.see(seen_mps2, 5);
    watch.expected[0].differ = false;
    EXPECT_NEAR(watch.see(seen_mps2, 50) / before, seen_mps2 < 0.0F ? 0.364F : 0.778F, 0.002F);
  }
}

// BELIEF-002 Hypotheses 0.4 m/s^2 apart are not told apart, whatever is seen; nor is anything learned of one
// who stands behind somebody (its hypotheses are said not to differ).
TEST(YieldBelief, WeakDifferencesAreNoEvidence) {
  Watch weak;
  weak.expected[0] = {true, 0.2F, -0.2F};
  EXPECT_EQ(weak.see(-3.0F, 20), 0.0F);
  Watch queued;
  queued.expected[0] = {false, 1.0F, -2.0F};
  EXPECT_EQ(queued.see(0.0F, 20), 0.0F);
}

// BELIEF-002 First in line with the way open it would set off with 1.5 m/s^2, and stands: (1.5^2 - 0) / 4.5 =
// 0.5 a cycle; after a second the odds are for it.
TEST(YieldBelief, StandingWithTheWayOpenIsEvidence) {
  Watch watch;
  watch.expected[0] = {true, 1.5F, 0.0F};
  EXPECT_NEAR(watch.see(0.0F), 0.5F, 1e-4F);
  EXPECT_GT(watch.see(0.0F, 9), 4.0F);
}

// BELIEF-003 Beliefs go with the track, not with its place in the list; a track that is no longer watched is
// forgotten, and so is everything at a reset.
TEST(YieldBelief, BeliefsBelongToTracks) {
  Watch watch;
  const float known = watch.see(-12.0F, 3);
  scene::Agent first;
  first.track.id = 9;
  const scene::Agent second = watch.scene.agents[0];
  watch.scene.agents.clear();
  (void)watch.scene.agents.push(first);
  (void)watch.scene.agents.push(second);
  watch.scene.watched = 2;
  watch.expected[0] = watch.expected[1] = {};
  watch.beliefs.observe(watch.scene, watch.expected);
  EXPECT_NEAR(watch.beliefs.evidence(7), 0.98F * known, 1e-4F);
  EXPECT_EQ(watch.beliefs.evidence(9), 0.0F);
  watch.scene.watched = 1;
  watch.beliefs.observe(watch.scene, watch.expected);
  EXPECT_EQ(watch.beliefs.evidence(7), 0.0F);
  (void)watch.see(-12.0F);
  watch.beliefs.reset();
  EXPECT_EQ(watch.beliefs.evidence(9), 0.0F);
}

// BELIEF-001 No evidence leaves a prior as it is; log-odds of ln 3 make 0.5 into 0.75; nothing makes it less
// than 0.02 or more than 0.98, whatever the prior.
TEST(YieldBelief, ThePriorWithEvidence) {
  EXPECT_NEAR(with_evidence(0.3F, 0.0F), 0.3F, 1e-6F);
  EXPECT_NEAR(with_evidence(0.5F, std::log(3.0F)), 0.75F, 1e-5F);
  EXPECT_NEAR(with_evidence(0.75F, -std::log(3.0F)), 0.5F, 1e-5F);
  for (const float prior : {0.0F, 0.5F, 1.0F}) {
    EXPECT_NEAR(with_evidence(prior, 20.0F), 0.98F, 1e-6F);
    EXPECT_NEAR(with_evidence(prior, -20.0F), 0.02F, 1e-6F);
  }
}

}  // namespace
}  // namespace s4tp::satp
