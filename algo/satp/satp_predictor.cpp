#include "algo/satp/satp_predictor.hpp"

#include <new>

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/satp/input_builder.hpp"

namespace s4tp::satp {
namespace {

constexpr float kFullTrust = 0.95F;  // above it nothing is blended in
constexpr float kNoTrust = 0.2F;     // below it the network is not asked
static_assert(kNetworkAgentWork == satp::kMcuShape.modes * satp::kDecoderSteps);
// Driven no further in 3 s, a vehicle goes on standing.
constexpr float kStaysM = kStandingMps * static_cast<float>(kHorizonSteps) * kStepS;

// What of a vehicle's mass goes on standing when none of its futures does. The network sees a second of the past:
// without such a future nothing that is seen for longer could speak for it.
constexpr float kStandsProbability = 0.05F;

// By where it ends: a network's poses jitter on the way.
float moved_m(const Mode& mode, const Pose& from) {
  return distance(position(from), position(mode.steps[kHorizonSteps - 1]));
}

// Room for one future more: the least likely one goes, its mass to the others.
void drop_least(AgentPrediction& futures) {
  int least = 0;
  for (int k = 1; k < futures.modes.size(); ++k) {
    if (futures.modes[k].probability < futures.modes[least].probability) least = k;
  }
  const float rest = 1.0F - futures.modes[least].probability;
  futures.modes.swap_remove(least);
  for (Mode& mode : futures.modes) mode.probability = mode.probability / rest;
}

// One that stands has a future in which it goes on standing.
void let_stand(const Pose& here, AgentPrediction& futures) {
  for (const Mode& mode : futures.modes) {
    if (moved_m(mode, here) < kStaysM) return;
  }
  drop_least(futures);
  for (Mode& mode : futures.modes) mode.probability = mode.probability * (1.0F - kStandsProbability);
  Mode stands;
  stands.probability = kStandsProbability;
  for (Pose& step : stands.steps) step = here;
  measure_steps(stands);
  (void)futures.modes.push(stands);
}

}  // namespace

void SatpPredictor::encode(const satp::Weights& weights, const scene::Scene& scene,
                           const Parameters& parameters, std::uint32_t start_ms, const YieldBeliefs* beliefs,
                           const PredictionTrust* trust, satp::EncoderScratch& scratch) {
  kinematic_.encode(scene, parameters, start_ms, beliefs);
  weights_ = weights;
  scene_ = &scene;
  parameters_ = &parameters;
  beliefs_ = beliefs;
  trust_ = trust;
  work_ = 0;
  if (!weights_.present()) {
    new (&room_.decoded) Decoded;
    return;
  }
  const auto lead_ms = static_cast<std::int32_t>(start_ms - scene.time_ms);
  lead_s_ = clamp(1e-3F * static_cast<float>(lead_ms), 0.0F, 1.0F);
  new (&room_.input) satp::NetworkInput;
  build_network_input(scene, parameters, lead_s_, kinematic_.hypotheses(), room_.input);
  satp::encode(weights_, room_.input, scratch, encoded_);
  new (&room_.decoded) Decoded;
}

// Bayes' rule: each future is as likely as the network says times how likely it makes what was seen.
void SatpPredictor::believe(int index, const satp::Futures& futures, AgentPrediction& result) const {
  const float(&pair)[satp::kPairFeatures] = encoded_.pair[index];
  const Track& track = scene_->agents[index].track;
  // Of whoever stands it was seen that it goes on standing, in the junction, too.
  const bool stands = track.speed_mps < kStandingMps;
  if (stands) let_stand(encoded_.anchor[index], result);
  if (!stands && pair[static_cast<int>(satp::PairFeature::kZone)] == 0.0F) return;
  const float seen_if_yielding = exp(beliefs_ == nullptr ? 0.0F : beliefs_->evidence(track.id));
  float sum = 0.0F;
  for (int k = 0; k < result.modes.size(); ++k) {
    Mode& mode = result.modes[k];
    const bool stays = stands && moved_m(mode, encoded_.anchor[index]) < kStaysM;
    const float prior = stands ? (stays ? 1.0F : 0.0F) : futures.yields[k];
    const float seen = prior * seen_if_yielding + (1.0F - prior);
    mode.probability = mode.probability * seen;
    mode.yields_percent =
        static_cast<std::uint8_t>(to_int(100.0F * (prior * seen_if_yielding / seen) + 0.5F, 0, 100));
    sum += mode.probability;
  }
  for (Mode& mode : result.modes) mode.probability = mode.probability / sum;
}

void SatpPredictor::decode_one(const satp::PlanInput* plan, int index, AgentPrediction& result) const {
  satp::Futures& futures = room_.decoded.decoding.futures;
  satp::decode(weights_, encoded_, index, plan == nullptr ? nullptr : plan->step[index],
               room_.decoded.decoding.scratch, futures);
  work_ += kNetworkAgentWork;
  result.agent = static_cast<std::uint8_t>(index);
  result.modes.clear();
  Mode mode;
  for (int k = 0; k < satp::kMcuShape.modes; ++k) {
    mode.probability = futures.probability[k];
    for (int i = 0; i < kHorizonSteps; ++i)
      mode.steps[i] = satp::from_anchor(encoded_.anchor[index], futures.poses[k][i]);
    measure_steps(mode);
    (void)result.modes.push(mode);
  }
  believe(index, futures, result);
}

// The kinematic predictor's likeliest future takes what trust is missing.
void SatpPredictor::blend(const EgoMotion& ego, int index, float trust, AgentPrediction& kinematic,
                          AgentPrediction& result) const {
  kinematic_.decode_one(ego, index, kinematic);
  drop_least(result);
  for (Mode& mode : result.modes) mode.probability = mode.probability * trust;
  kinematic.modes[0].probability = 1.0F - trust;
  (void)result.modes.push(kinematic.modes[0]);
}

void SatpPredictor::decode(const Trajectory* plan, int allowance, PredictionSet& prediction) const {
  if (!weights_.present()) {
    kinematic_.decode(plan, allowance, prediction);
    return;
  }
  prediction.conditioned = plan != nullptr;
  prediction.agents.clear();
  satp::PlanInput& plan_input = room_.decoded.decoding.plan;
  AgentPrediction& result = room_.decoded.decoding.result;
  if (plan != nullptr)
    build_plan_input(*plan, *parameters_, encoded_.hdvs, encoded_.anchor, encoded_.pair, plan_input);
  const EgoMotion ego(*scene_, *parameters_, lead_s_, plan);
  const int work_before = work();
  for (int i = 0; i < encoded_.hdvs; ++i) {
    if (work() - work_before + kMaxAgentWork + kNetworkAgentWork > allowance) break;
    const float trust = trust_ == nullptr ? 1.0F : trust_->of(scene_->agents[i].track.id);
    if (trust < kNoTrust) {
      kinematic_.decode_one(ego, i, result);
    } else {
      decode_one(plan == nullptr ? nullptr : &plan_input, i, result);
      if (trust < kFullTrust) blend(ego, i, trust, room_.decoded.decoding.kinematic, result);
      likeliest_first(result);
    }
    (void)prediction.agents.push(result);
  }
}

}  // namespace s4tp::satp
