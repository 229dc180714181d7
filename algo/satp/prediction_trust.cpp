#include "algo/satp/prediction_trust.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::satp {
namespace {

constexpr int kStepsAhead = 5;           // 0.5 s
constexpr std::int32_t kTooLateMs = 50;  // half a cycle: the vehicle is then somewhere else already
constexpr float kUsual = 1.0F;           // times the usual error: full trust up to here, ...
constexpr float kUnusual = 3.0F;         // ... none from here on
constexpr float kShareOfNews = 0.5F;
constexpr float kLeastResidualM = 0.1F;  // what tracks are known to

}  // namespace

int PredictionTrust::find(std::uint8_t track) const {
  for (int i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].track == track) return i;
  }
  return -1;
}

float PredictionTrust::of(std::uint8_t track) const {
  const int index = find(track);
  return index < 0 ? 1.0F : tracks_[index].trust;
}

void PredictionTrust::observe(const scene::Scene& scene, float usual_residual_m) {
  const float usual_m = max(usual_residual_m, kLeastResidualM);
  for (int i = 0; i < scene.watched; ++i) {
    const scene::Agent& agent = scene.agents[i];
    const int index = find(agent.track.id);
    if (index < 0 || tracks_[index].expected.empty()) continue;
    Entry& entry = tracks_[index];
    const auto late_ms = static_cast<std::int32_t>(scene.time_ms - entry.due_ms);
    if (late_ms < 0) continue;
    // Whom we only coast has shown nothing.
    if (late_ms <= kTooLateMs && agent.age_ms <= kStepMs) {
      const Point here = position(agent.track.centre);
      float residual_m = distance(here, entry.expected[0]);
      for (const Point& expected : entry.expected) residual_m = min(residual_m, distance(here, expected));
      const float fit = clamp((kUnusual - residual_m / usual_m) / (kUnusual - kUsual), 0.0F, 1.0F);
      entry.trust = lerp(entry.trust, fit, kShareOfNews);
    }
    entry.expected.clear();
  }
}

void PredictionTrust::remember(const scene::Scene& scene, const PredictionSet& prediction,
                               std::uint32_t start_ms) {
  BoundedVector<Entry, kMaxAgents> now;
  for (const AgentPrediction& futures : prediction.agents) {
    const std::uint8_t track = scene.agents[futures.agent].track.id;
    const int index = find(track);
    Entry entry;
    if (index >= 0) entry = tracks_[index];
    entry.track = track;
    if (entry.expected.empty()) {
      entry.due_ms = start_ms + kStepsAhead * kStepMs;
      for (const Mode& mode : futures.modes) (void)entry.expected.push(position(mode.steps[kStepsAhead - 1]));
    }
    (void)now.push(entry);
  }
  tracks_ = now;
}

}  // namespace s4tp::satp
