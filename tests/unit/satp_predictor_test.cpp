// The learned predictor behind the predictor's interface: fallback, beliefs, trust, and the planner that
// carries it.

#include "algo/satp/satp_predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "algo/planner/planner.hpp"
#include "algo/satp/shipped_weights.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/random_network.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::satp {
namespace {

using test::CrossJunction;

const Parameters kParameters;

/// Random weights, and a junction: we go straight north, one comes from the west, one from the north.
struct Junction {
  CrossJunction cross = test::cross_junction();
  std::vector<std::int32_t> words = std::vector<std::int32_t>(satp::kImageBytes / 4);
  satp::Weights weights;
  EgoState ego = test::ego_at(1.6F, -35.0F, 1.5707963F, 9.0F);
  std::vector<Track> tracks = {test::car(1, -35.0F, -1.6F, 0.0F, 10.0F),
                               test::car(2, -1.6F, 40.0F, -1.5707963F, 8.0F)};
  scene::Scene scene;
  satp::EncoderScratch scratch;
  SatpPredictor predictor;
  PredictionSet set;

  explicit Junction(std::uint64_t seed = 4) {
    test::make_random_image(seed, words.data());
    EXPECT_EQ(satp::Weights::check(words.data(), satp::kImageBytes, weights), satp::WeightStatus::kOk);
    scene = test::scene_of(cross.map, ego, tracks, kParameters, 1000);
  }
  const PredictionSet& predict(const satp::Weights& with, const Trajectory* plan,
                               const YieldBeliefs* beliefs = nullptr,
                               const PredictionTrust* trust = nullptr) {
    predictor.encode(with, scene, kParameters, scene.time_ms + 100, beliefs, trust, scratch);
    predictor.decode(plan, kMaxPredictionWork, set);
    return set;
  }
};

bool same(const PredictionSet& a, const PredictionSet& b) {
  if (a.agents.size() != b.agents.size()) return false;
  for (int i = 0; i < a.agents.size(); ++i) {
    if (a.agents[i].modes.size() != b.agents[i].modes.size()) return false;
    for (int k = 0; k < a.agents[i].modes.size(); ++k) {
      const Mode& mode = a.agents[i].modes[k];
      const Mode& other = b.agents[i].modes[k];
      if (mode.probability != other.probability || mode.yields_percent != other.yields_percent ||
          std::memcmp(mode.steps, other.steps, sizeof mode.steps) != 0)
        return false;
    }
  }
  return true;
}

// SATP-052 No weights: the kinematic predictor to the bit, with and without plan; weights: something else.
TEST(SatpPredictor, WithoutWeightsIsTheKinematicOne) {
  Junction junction;
  const Trajectory plan = test::plan_of(junction.ego);
  Predictor kinematic;
  kinematic.encode(junction.scene, kParameters, 1100);
  PredictionSet expected;
  for (const Trajectory* given : {static_cast<const Trajectory*>(nullptr), &plan}) {
    kinematic.decode(given, kMaxPredictionWork, expected);
    EXPECT_TRUE(same(junction.predict(satp::Weights{}, given), expected));
    EXPECT_FALSE(junction.predictor.learned());
    EXPECT_FALSE(same(junction.predict(junction.weights, given), expected));
    EXPECT_TRUE(junction.predictor.learned());
  }
}

// CORE-040 SATP-053 Of 60 random networks: each vehicle has three futures from where it is on, the likeliest
// first, whose probabilities add up to 1 whatever the belief says; strong evidence for letting us pass makes
// it likelier that it does, as far as the network leaves it open.
TEST(SatpPredictor, GivesFuturesAndBeliefsTheirMass) {
  int told_apart = 0;
  for (std::uint64_t seed = 100; seed < 160; ++seed) {
    Junction junction(seed);
    YieldBeliefs beliefs;
    YieldHypotheses hypotheses[kMaxAgents];
    for (YieldHypotheses& hypothesis : hypotheses) hypothesis = {true, 3.0F, 0.0F};  // nobody gains speed
    const auto mass = [&](const YieldBeliefs* believed, int agent) {
      const AgentPrediction& futures = junction.predict(junction.weights, nullptr, believed).agents[agent];
      EXPECT_EQ(futures.modes.size(), kMaxModes);
      float sum = 0.0F;
      float yields = 0.0F;
      for (const Mode& mode : futures.modes) {
        EXPECT_GE(futures.modes[0].probability, mode.probability);
        sum += mode.probability;
        yields += 0.01F * static_cast<float>(mode.yields_percent) * mode.probability;
        const Pose& here = junction.scene.agents[futures.agent].track.centre;
        EXPECT_LT(std::hypot(mode.steps[0].x_m - here.x_m, mode.steps[0].y_m - here.y_m), 5.0F);
      }
      EXPECT_NEAR(sum, 1.0F, 1e-5F);
      return yields;
    };
    for (int i = 0; i < 20; ++i) beliefs.observe(junction.scene, hypotheses);
    for (int agent = 0; agent < 2; ++agent) {
      const float prior = mass(nullptr, agent);
      const float believed = mass(&beliefs, agent);
      if (prior > 0.01F && prior < 0.9F) {
        EXPECT_GT(believed, prior);
        ++told_apart;
      }
    }
  }
  EXPECT_GT(told_apart, 0);
}

// SATP-053 The same of one that has stood for 30 s before us in the junction, or before it first in line, another behind it,
// by the weights a build carries: evidence makes the futures likelier in which it goes on standing.
class WhoStands : public testing::TestWithParam<float> {};

TEST_P(WhoStands, IsBelievedToStay) {
  const satp::ShippedWeights shipped = satp::shipped_weights();
  Junction junction;
  ASSERT_EQ(satp::Weights::check(shipped.image, shipped.size_bytes, junction.weights),
            satp::WeightStatus::kOk);
  junction.ego = test::ego_at(1.6F, -1.5F, 1.5707963F, 0.0F);
  const float x_m = GetParam();
  junction.tracks = {test::car(2, x_m, -1.6F, 0.0F, 0.0F), test::car(3, x_m - 7.0F, -1.6F, 0.0F, 0.0F)};
  scene::SceneBuilder builder;
  for (std::uint32_t now_ms = 1000; now_ms <= 31000; now_ms += 100) {
    (void)builder.build(now_ms, junction.ego, test::track_list(junction.tracks), now_ms, &junction.cross.map,
                        kParameters, junction.scene);
  }
  YieldBeliefs beliefs;
  YieldHypotheses hypotheses[kMaxAgents];
  for (YieldHypotheses& hypothesis : hypotheses) hypothesis = {true, 3.0F, 0.0F};
  for (int i = 0; i < 20; ++i) beliefs.observe(junction.scene, hypotheses);
  const auto stays = [&](const YieldBeliefs* believed) {
    float sum = 0.0F;
    for (const Mode& mode : junction.predict(junction.weights, nullptr, believed).agents[0].modes) {
      const Pose& end = mode.steps[kHorizonSteps - 1];
      if (std::hypot(end.x_m - x_m, end.y_m + 1.6F) < 0.9F) sum += mode.probability;
    }
    return sum;
  };
  const float prior = stays(nullptr);
  EXPECT_GT(prior, 0.01F);
  EXPECT_LT(prior, 0.95F);
  EXPECT_GT(stays(&beliefs), 0.97F);
}
INSTANTIATE_TEST_SUITE_P(InAndBeforeTheJunction, WhoStands, testing::Values(-1.0F, -10.0F));

// SATP-050 SATP-051 A prediction that comes true keeps full trust; one that is off by more than three times
// the usual error leaves half each time; a vehicle that is new, or gone and new again, is trusted.
TEST(PredictionTrust, IsLostAndWonBack) {
  Junction junction;
  PredictionTrust trust;
  const std::uint8_t id = junction.scene.agents[0].track.id;
  PredictionSet prediction = junction.predict(satp::Weights{}, nullptr);
  EXPECT_EQ(trust.of(id), 1.0F);
  const auto half_a_second = [&](float off_m) {
    trust.remember(junction.scene, prediction, junction.scene.time_ms + 100);
    scene::Scene later = junction.scene;
    later.time_ms += 600;
    for (int i = 0; i < later.watched; ++i) {
      later.agents[i].track.centre = prediction.agents[i].modes[0].steps[4];
      later.agents[i].track.centre.x_m += off_m;
    }
    trust.observe(later, 0.4F);
    return trust.of(id);
  };
  EXPECT_NEAR(half_a_second(0.0F), 1.0F, 1e-3F);
  EXPECT_NEAR(half_a_second(20.0F), 0.5F, 1e-3F);
  EXPECT_NEAR(half_a_second(20.0F), 0.25F, 1e-3F);
  EXPECT_NEAR(half_a_second(0.0F), 0.625F, 1e-3F);
  // Not yet due: nothing is learned.
  trust.remember(junction.scene, prediction, 5000);
  trust.observe(junction.scene, 0.4F);
  EXPECT_NEAR(trust.of(id), 0.625F, 1e-3F);
  prediction.agents.clear();
  trust.remember(junction.scene, prediction, 1100);
  EXPECT_EQ(trust.of(id), 1.0F);
}

// SATP-054 With half of the trust gone a third future is the kinematic one's likeliest and has that half;
// without any, all futures are the kinematic predictor's.
TEST(SatpPredictor, LostTrustGoesToTheKinematicFuture) {
  Junction junction;
  PredictionTrust trust;
  Predictor kinematic;
  kinematic.encode(junction.scene, kParameters, 1100);
  PredictionSet expected;
  kinematic.decode(nullptr, kMaxPredictionWork, expected);
  for (int loss = 1; loss <= 3; ++loss) {
    const PredictionSet prediction = junction.predict(satp::Weights{}, nullptr);
    trust.remember(junction.scene, prediction, junction.scene.time_ms + 100);
    scene::Scene later = junction.scene;
    later.time_ms += 600;
    for (int i = 0; i < later.watched; ++i) later.agents[i].track.centre.x_m += 500.0F;
    trust.observe(later, 0.4F);
    const PredictionSet& set = junction.predict(junction.weights, nullptr, nullptr, &trust);
    if (loss == 3) {  // an eighth is left
      EXPECT_TRUE(same(set, expected));
      break;
    }
    const float lost = loss == 1 ? 0.5F : 0.75F;
    for (int i = 0; i < set.agents.size(); ++i) {
      float sum = 0.0F;
      bool found = false;
      for (const Mode& mode : set.agents[i].modes) {
        sum += mode.probability;
        const bool kinematics =
            std::memcmp(mode.steps, expected.agents[i].modes[0].steps, sizeof mode.steps) == 0;
        EXPECT_TRUE(!kinematics || std::fabs(mode.probability - lost) < 1e-4F);
        found = found || kinematics;
      }
      EXPECT_TRUE(found);
      EXPECT_NEAR(sum, 1.0F, 1e-4F);
    }
  }
}

// SATP-055 The planner begins with what the build carries, takes an image and keeps it over the next init(),
// says so, still gives a plan; a broken one is refused and it is as it was.
TEST(SatpPlanner, UsesTheWeightsItIsGiven) {
  const LaneMap map = test::straight_road(2, 400.0F);
  std::vector<std::int32_t> words(satp::kImageBytes / 4);
  test::make_random_image(8, words.data());
  float risk = 0.0F;
  satp::Weights carried;
  const satp::ShippedWeights shipped = satp::shipped_weights();
  const auto first_plan = [&](const void* image, satp::WeightStatus expected) {
    const auto planner = std::make_unique<planner::Planner>();
    EXPECT_EQ(planner->init(kParameters), Status::kOk);
    EXPECT_EQ(planner->weight_status(), satp::Weights::check(shipped.image, shipped.size_bytes, carried));
    EXPECT_EQ(planner->use_weights(image, satp::kImageBytes), expected);
    EXPECT_EQ(planner->init(kParameters), Status::kOk);
    EXPECT_EQ(planner->weight_status(), expected);
    planner::PlannerInput input;
    input.now_ms = 1000;
    input.start_ms = 1100;
    input.ego = test::ego_at(100.0F, 0.0F, 0.0F, 12.0F);
    input.tracks =
        test::track_list({test::car(1, 130.0F, 0.0F, 0.0F, 9.0F), test::car(2, 80.0F, 3.2F, 0.0F, 13.0F)});
    input.tracks_ms = 1000;
    input.map = &map;
    Plan plan;
    planner::Explanation explanation;
    EXPECT_EQ(planner->plan(input, plan, explanation), Status::kOk);
    EXPECT_EQ(explanation.learned, expected == satp::WeightStatus::kOk);
    risk = explanation.chosen_cost.risk;
    return plan;
  };
  const Plan kinematic = first_plan(nullptr, satp::WeightStatus::kAbsent);
  const float kinematic_risk = risk;
  const Plan learned = first_plan(words.data(), satp::WeightStatus::kOk);
  EXPECT_NE(risk, kinematic_risk);
  EXPECT_EQ(learned.kind, PlanKind::kDrive);
  words[1000] ^= 4;
  const Plan refused = first_plan(words.data(), satp::WeightStatus::kChecksum);
  EXPECT_EQ(std::memcmp(&kinematic.trajectory, &refused.trajectory, sizeof kinematic.trajectory), 0);
}

}  // namespace
}  // namespace s4tp::satp
