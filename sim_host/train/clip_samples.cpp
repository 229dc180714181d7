#include "sim_host/train/clip_samples.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "algo/satp/input_builder.hpp"
#include "algo/satp/predictor.hpp"
#include "sim_host/clips/clip_scene.hpp"

namespace s4tp::train {
namespace {

float single(double value) {
  return static_cast<float>(value);
}

std::int16_t centimetres(float metres) {
  return static_cast<std::int16_t>(std::clamp(std::lround(metres * 100.0F), -32767L, 32767L));
}

int index_of(const scene::Scene& scene) {
  for (int i = 0; i < scene.watched; ++i) {
    if (scene.agents[i].track.id == clips::kAskedTrack) return i;
  }
  return -1;
}

void expect(const scene::Scene& scene, const Parameters& parameters, Sample& sample) {
  const auto predictor = std::make_unique<satp::Predictor>();
  predictor->encode(scene, parameters, scene.time_ms);
  satp::PredictionSet prediction;
  predictor->decode(nullptr, satp::kMaxPredictionWork, prediction);
  for (const satp::AgentPrediction& agent : prediction.agents) {
    KinematicFuture& future = sample.kinematic[agent.agent];
    for (int k = 0; k < agent.modes.size(); ++k) {
      future.probability[k] = agent.modes[k].probability;
      for (int i = 0; i < kHorizonSteps; ++i) {
        const Pose local = satp::to_anchor(sample.input.anchor[agent.agent], agent.modes[k].steps[i]);
        future.position_cm[k][i][0] = centimetres(local.x_m);
        future.position_cm[k][i][1] = centimetres(local.y_m);
      }
    }
  }
}

}  // namespace

void make_clip_samples(const clips::Clip& clip, clips::Windows& windows, const Parameters& parameters,
                       const std::function<void(const Sample&)>& sink) {
  const std::string family = clips::family_of(clip.id);
  for (const clips::Window& window : windows.of(clip)) {
    const clips::ClipVehicle& vehicle = clip.vehicles[window.vehicle];
    if (clips::kept_for_judging(family, vehicle.id)) continue;
    LaneMap map;
    const auto scene = std::make_unique<scene::Scene>();
    const map::Vec2 origin = clips::see(clip, window.vehicle, window.step, parameters, map, *scene);
    const int asked = index_of(*scene);
    if (asked < 0) continue;
    const auto sample = std::make_unique<Sample>();
    sample->road = clips::vehicle_number(family, vehicle.id);
    sample->time_ms =
        static_cast<std::uint32_t>(std::max(0, window.step)) * static_cast<std::uint32_t>(kStepMs);
    sample->flags = kNoPlan;
    std::fill(std::begin(sample->yields), std::end(sample->yields), std::int8_t{-1});
    std::fill(std::begin(sample->route), std::end(sample->route), std::int8_t{-1});
    satp::build_network_input(*scene, parameters, 0.0F, sample->input);
    expect(*scene, parameters, *sample);
    for (int k = 0; k < kHorizonSteps; ++k) {
      const clips::ClipState& then = vehicle.states.at(window.step + k + 1);
      const Pose local = satp::to_anchor(
          sample->input.anchor[asked],
          {single(then.centre.x - origin.x), single(then.centre.y - origin.y), single(then.heading_rad)});
      sample->target.pose[asked][k][0] = local.x_m;
      sample->target.pose[asked][k][1] = local.y_m;
      sample->target.pose[asked][k][2] = local.heading_rad;
      sample->target.valid[asked] |= std::uint32_t{1} << k;
    }
    sink(*sample);
  }
}

}  // namespace s4tp::train
