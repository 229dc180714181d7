#include "algo/satp/yield_belief.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::satp {
namespace {

constexpr float kSpreadMps2 = 1.5F;  // of what drivers do about what the model says
constexpr float kWeakMps2 = 0.5F;    // hypotheses nearer than this are not told apart
constexpr float kMostAStep = 1.0F;   // log-odds
constexpr float kMost = 7.0F;
constexpr float kToGoing = 0.2F * kStepS;  // share of evidence for yielding that is forgotten a cycle
constexpr float kToYielding = 0.05F * kStepS;
constexpr float kSurest = 0.98F;

}  // namespace

float YieldBeliefs::evidence(std::uint8_t track) const {
  for (const Belief& belief : beliefs_) {
    if (belief.track == track) return belief.log_odds;
  }
  return 0.0F;
}

void YieldBeliefs::observe(const scene::Scene& scene, const YieldHypotheses (&hypotheses)[kMaxAgents]) {
  BoundedVector<Belief, kMaxAgents> now;
  for (int i = 0; i < scene.watched; ++i) {
    const Track& track = scene.agents[i].track;
    Belief belief{track.id, evidence(track.id)};
    belief.log_odds = belief.log_odds * (1.0F - (belief.log_odds > 0.0F ? kToGoing : kToYielding));
    const YieldHypotheses& expected = hypotheses[i];
    if (expected.differ && expected.goes_mps2 - expected.yields_mps2 > kWeakMps2) {
      const float seen_mps2 = track.acceleration_mps2;
      const float step = (square(seen_mps2 - expected.goes_mps2) - square(seen_mps2 - expected.yields_mps2)) /
                         (2.0F * square(kSpreadMps2));
      belief.log_odds = clamp(belief.log_odds + clamp(step, -kMostAStep, kMostAStep), -kMost, kMost);
    }
    (void)now.push(belief);
  }
  beliefs_ = now;
}

float with_evidence(float prior, float log_odds) {
  const float known = clamp(prior, 1.0F - kSurest, kSurest);
  const float odds = known / (1.0F - known) * exp(log_odds);
  return clamp(odds / (1.0F + odds), 1.0F - kSurest, kSurest);
}

}  // namespace s4tp::satp
