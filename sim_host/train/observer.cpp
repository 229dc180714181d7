#include "sim_host/train/observer.hpp"

#include <algorithm>
#include <cmath>

#include "algo/satp/input_builder.hpp"

namespace s4tp::train {
namespace {

std::int16_t centimetres(float metres) {
  return static_cast<std::int16_t>(std::clamp(std::lround(metres * 100.0F), -32767L, 32767L));
}

}  // namespace

bool Observer::look(std::uint32_t now_ms, const EgoState& ego, const TrackList& tracks,
                    std::uint32_t tracks_ms, const LaneMap& map) {
  if (builder_.build(now_ms, ego, tracks, tracks_ms, &map, parameters_, scene_) != Status::kOk) return false;
  satp::Predictor predictor;
  predictor.encode(scene_, parameters_, now_ms + kLeadMs, &beliefs_);
  satp::YieldHypotheses hypotheses[kMaxAgents];
  predictor.hypotheses(hypotheses);
  beliefs_.observe(scene_, hypotheses);
  return true;
}

void Observer::expect(const satp::NetworkInput& input, KinematicFuture (&futures)[kMaxAgents]) const {
  satp::Predictor predictor;
  predictor.encode(scene_, parameters_, scene_.time_ms + kLeadMs, &beliefs_);
  satp::PredictionSet prediction;
  predictor.decode(nullptr, satp::kMaxPredictionWork, prediction);
  for (const satp::AgentPrediction& agent : prediction.agents) {
    KinematicFuture& future = futures[agent.agent];
    for (int k = 0; k < agent.modes.size(); ++k) {
      future.probability[k] = agent.modes[k].probability;
      future.yields[k] = agent.modes[k].yields_percent >= 50 ? 1 : 0;
      for (int i = 0; i < kHorizonSteps; ++i) {
        const Pose local = satp::to_anchor(input.anchor[agent.agent], agent.modes[k].steps[i]);
        future.position_cm[k][i][0] = centimetres(local.x_m);
        future.position_cm[k][i][1] = centimetres(local.y_m);
      }
    }
  }
}

}  // namespace s4tp::train
