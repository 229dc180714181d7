#include "algo/satp/predictor.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/satp/path_motion.hpp"

namespace s4tp::satp {
namespace {

using occupancy::kNeverS;

constexpr float kZoneMarginS = 0.5F;
constexpr float kZoneMarginM = 1.0F;
constexpr float kCertain = 0.95F;
// Who owes us the way, who has it, and where the first comes: up to this much braking they do for us, beyond that they do not.
constexpr float kOwedEasyMps2 = 3.0F;
constexpr float kOwedHardMps2 = 7.0F;
constexpr float kPriorityEasyMps2 = 1.5F;
constexpr float kPriorityHardMps2 = 4.0F;
constexpr float kFirstComeEasyMps2 = 2.0F;
constexpr float kFirstComeHardMps2 = 5.0F;
// Chance to be minded by one with priority: there at the same time, for each second there before it, and at most.
constexpr float kMindedAtOnce = 0.4F;
constexpr float kMindedPerS = 0.3F;
constexpr float kMindedAtMost = 0.97F;
constexpr float kShortestRoomM = 0.3F;
constexpr float kGoesOnStanding = 0.05F;  // prior chance, where its way is open

// Straight on, or on the arc it drives.
void place_on_arc(const Track& track, float lead_s, Mode& mode) {
  Pose pose = track.centre;
  const auto advance = [&](float seconds) {
    const float half_turn_rad = 0.5F * track.yaw_rate_radps * seconds;
    pose.heading_rad = wrap_angle(pose.heading_rad + half_turn_rad);
    pose = shift_ahead(pose, track.speed_mps * seconds);
    pose.heading_rad = wrap_angle(pose.heading_rad + half_turn_rad);
  };
  advance(lead_s);
  for (Pose& step : mode.steps) {
    advance(kStepS);
    step = pose;
  }
  measure_steps(mode);
}

// Chance that the driver brakes for us at a conflict, by the braking it takes: 1 up to `easy`, 0 from `hard`.
float willingness(float braking_mps2, float easy, float hard) {
  return clamp((hard - braking_mps2) / (hard - easy), 0.0F, 1.0F);
}

// Chance that whoever has priority minds us in the zone first by so much.
float seen_first(float lead_s) {
  return clamp(kMindedAtOnce + kMindedPerS * lead_s, 0.0F, kMindedAtMost);
}

// Prior chance that the driver lets us pass somewhere along its hypothesis, and where it then waits; < 0: we do not
// meet. The right of way and the braking it takes decide.
float yielding(const EgoMotion& ego, const PathHypothesis& hypothesis, const PathMotion& undisturbed,
               Hold& hold) {
  float chance = -1.0F;
  for (const PathConflict& conflict : hypothesis.conflicts) {
    const TimeInZone ours = ego.time_in_zone(conflict);
    if (ours.entry_s > ours.exit_s) continue;
    const float their_entry_s = time_at(hypothesis, undisturbed, conflict.entry_s_m);
    const float their_exit_s = time_at(hypothesis, undisturbed, conflict.exit_s_m);
    const bool meet =
        ours.entry_s < their_exit_s + kZoneMarginS && their_entry_s < ours.exit_s + kZoneMarginS;
    const float room_m = conflict.entry_s_m - kZoneMarginM - hypothesis.start_s_m;
    if (!meet || room_m <= 0.0F) continue;
    const float braking_mps2 = 0.5F * square(hypothesis.speed_mps) / max(room_m, kShortestRoomM);
    const bool we_first = ours.entry_s < their_entry_s;
    float here = 0.0F;
    if (ego.inside(conflict) || conflict.priority == Priority::kFirstYields) {
      here = willingness(braking_mps2, kOwedEasyMps2, kOwedHardMps2);
    } else if (ego.conditioned() && we_first) {
      const bool has_priority = conflict.priority == Priority::kFirstHasPriority;
      here = has_priority ? seen_first(their_entry_s - ours.entry_s) *
                                willingness(braking_mps2, kPriorityEasyMps2, kPriorityHardMps2)
                          : willingness(braking_mps2, kFirstComeEasyMps2, kFirstComeHardMps2);
    }
    if (here <= chance) continue;
    chance = here;
    hold = {hypothesis.start_s_m + room_m, ours.exit_s};
  }
  return chance;
}

}  // namespace

void Predictor::encode(const scene::Scene& scene, const Parameters& parameters, std::uint32_t start_ms,
                       const YieldBeliefs* beliefs) {
  beliefs_ = beliefs;
  scene_ = &scene;
  parameters_ = &parameters;
  const std::int32_t lead_ms = static_cast<std::int32_t>(start_ms - scene.time_ms);
  lead_s_ = clamp(1e-3F * static_cast<float>(lead_ms), 0.0F, 1.0F);
  work_ = 0;
  for (int i = 0; i < scene.watched; ++i) {
    for (int k = 0; k < scene.agents[i].paths.size(); ++k)
      hypotheses_[i][k] = read_path_hypothesis(scene, i, k, lead_s_);
  }
}

void Predictor::decode(const Trajectory* plan, int allowance, PredictionSet& prediction) const {
  S4TP_ASSERT(scene_ != nullptr);
  prediction.conditioned = plan != nullptr;
  prediction.agents.clear();
  const EgoMotion ego(*scene_, *parameters_, lead_s_, plan);
  const int work_before = work_;
  for (int i = 0; i < scene_->watched; ++i) {
    if (work_ - work_before + kMaxAgentWork > allowance) break;
    AgentPrediction futures;
    decode_one(ego, i, futures);
    (void)prediction.agents.push(futures);
  }
}

void Predictor::decode_one(const EgoMotion& ego, int index, AgentPrediction& futures) const {
  const scene::Agent& agent = scene_->agents[index];
  futures.agent = static_cast<std::uint8_t>(index);
  futures.modes.clear();
  const int paths = agent.paths.size();
  int room = kMaxModes - paths;  // for second futures along the same path
  Mode mode;
  if (paths == 0) {
    mode.probability = 1.0F;
    place_on_arc(agent.track, lead_s_, mode);
    (void)futures.modes.push(mode);
    work_ += kHorizonSteps;
  }
  for (int k = 0; k < paths; ++k) {
    const PathHypothesis& hypothesis = hypotheses_[index][k];
    const EgoOnPath on_path = ego.on_path(agent.paths[k], hypothesis.start_s_m, agent.track);
    PathMotion motion;
    drive(hypothesis, agent.track, on_path, Hold{}, motion);
    work_ += kHorizonSteps;
    Hold hold;
    float prior = yielding(ego, hypothesis, motion, hold);
    if (prior < 0.0F && agent.track.speed_mps < kStandingMps) {
      prior = kGoesOnStanding;
      hold = {hypothesis.start_s_m, kNeverS};
    }
    float yields =
        prior < 0.0F ? 0.0F
                     : with_evidence(prior, beliefs_ == nullptr ? 0.0F : beliefs_->evidence(agent.track.id));
    const bool both = room > 0 && yields > 1.0F - kCertain && yields < kCertain;
    if (!both) yields = yields >= 0.5F ? 1.0F : 0.0F;
    if (yields < 1.0F) {
      mode.probability = agent.path_probability[k] * (1.0F - yields);
      mode.yields_percent = 0;
      place(*scene_->map, agent.paths[k], agent.frenet[k], agent.track, motion, mode);
      (void)futures.modes.push(mode);
    }
    if (yields > 0.0F) {
      drive(hypothesis, agent.track, on_path, hold, motion);
      work_ += kHorizonSteps;
      mode.probability = agent.path_probability[k] * yields;
      mode.yields_percent = 100;
      place(*scene_->map, agent.paths[k], agent.frenet[k], agent.track, motion, mode);
      (void)futures.modes.push(mode);
    }
    if (both) --room;
  }
  likeliest_first(futures);
}

void Predictor::hypotheses(YieldHypotheses (&result)[kMaxAgents]) const {
  S4TP_ASSERT(scene_ != nullptr);
  for (int i = 0; i < scene_->watched; ++i) {
    const scene::Agent& agent = scene_->agents[i];
    result[i] = YieldHypotheses{};
    for (int k = 0; k < agent.paths.size() && !result[i].differ; ++k) {  // the likeliest first
      const PathHypothesis& hypothesis = hypotheses_[i][k];
      for (const PathConflict& conflict : hypothesis.conflicts) {
        const float room_m = conflict.entry_s_m - kZoneMarginM - hypothesis.start_s_m;
        if (room_m <= 0.0F) continue;
        const float goes_mps2 = undisturbed_acceleration(hypothesis, agent.track);
        const float stops_mps2 = -0.5F * square(hypothesis.speed_mps) / room_m;
        result[i] = {true, goes_mps2, min(goes_mps2, stops_mps2)};
        break;
      }
    }
    // Whoever stands in the junction may go on standing.
    if (!result[i].differ && !agent.paths.empty() && agent.track.speed_mps < kStandingMps)
      result[i] = {true, undisturbed_acceleration(hypotheses_[i][0], agent.track), 0.0F};
  }
}

void Predictor::constant_velocity(KinematicSet& prediction) const {
  S4TP_ASSERT(scene_ != nullptr);
  prediction.agents.clear();
  for (const scene::Agent& agent : scene_->agents) {
    Mode mode;
    mode.probability = 1.0F;
    if (agent.paths.empty()) {
      place_on_arc(agent.track, lead_s_, mode);
    } else {
      PathMotion motion;
      for (int i = 0; i < kHorizonSteps; ++i) {
        const float time_s = lead_s_ + kStepS * static_cast<float>(i + 1);
        motion.s_m[i] = agent.frenet[0].s_m + agent.track.speed_mps * time_s;
      }
      place(*scene_->map, agent.paths[0], agent.frenet[0], agent.track, motion, mode);
    }
    (void)prediction.agents.push(mode);
    work_ += kHorizonSteps;
  }
}

}  // namespace s4tp::satp
