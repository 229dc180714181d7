// The firmware's predictors on a clip.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "algo/satp/satp_predictor.hpp"
#include "algo/satp/shipped_weights.hpp"
#include "sim_host/clips/clip_scene.hpp"
#include "sim_host/clips/forecaster.hpp"

namespace s4tp::clips {
namespace {

/// Without weights SatpPredictor is the kinematic predictor to the bit (SATP-052).
class Firmware final : public Forecaster {
 public:
  /// \param bank  what the weights lie in, where it is not the build
  explicit Firmware(const satp::Weights& weights, std::unique_ptr<hal::sim::MemoryFlashBank> bank = nullptr)
      : weights_(weights), bank_(std::move(bank)) {}

  std::vector<ClipFuture> forecast(const Clip& clip, std::size_t vehicle, int step) const override {
    LaneMap map;
    scene::Scene scene;
    const map::Vec2 origin = see(clip, vehicle, step, parameters_, map, scene);
    const auto predictor = std::make_unique<satp::SatpPredictor>();  // too large for the stack
    const auto scratch = std::make_unique<satp::EncoderScratch>();
    predictor->encode(weights_, scene, parameters_, scene.time_ms, nullptr, nullptr, *scratch);
    satp::PredictionSet prediction;
    predictor->decode(nullptr, satp::kMaxPredictionWork, prediction);
    for (const satp::AgentPrediction& agent : prediction.agents) {
      if (scene.agents[agent.agent].track.id != kAskedTrack) continue;
      std::vector<ClipFuture> futures;
      for (const satp::Mode& mode : agent.modes) {
        ClipFuture future;
        future.probability = static_cast<double>(mode.probability);
        for (std::size_t i = 0; i < future.places.size(); ++i) {
          future.places[i] = {static_cast<double>(mode.steps[i].x_m) + origin.x,
                              static_cast<double>(mode.steps[i].y_m) + origin.y};
        }
        futures.push_back(future);
      }
      return futures;
    }
    return make_forecaster("constant_velocity")->forecast(clip, vehicle, step);
  }

 private:
  satp::Weights weights_;
  std::unique_ptr<hal::sim::MemoryFlashBank> bank_;
  Parameters parameters_;
};

}  // namespace

std::unique_ptr<Forecaster> make_kinematic_forecaster() {
  return std::make_unique<Firmware>(satp::Weights{});
}

std::unique_ptr<Forecaster> make_satp_forecaster() {
  const satp::ShippedWeights shipped = satp::shipped_weights();
  satp::Weights weights;
  const satp::WeightStatus status = satp::Weights::check(shipped.image, shipped.size_bytes, weights);
  if (status != satp::WeightStatus::kOk) {
    throw std::invalid_argument(std::string("no predictor 'satp': this build's weights are ") +
                                satp::weight_status_name(status) +
                                "; configure with -DS4TP_LEARNED_PREDICTOR=ON to carry them");
  }
  return std::make_unique<Firmware>(weights);
}

std::unique_ptr<Forecaster> make_satp_forecaster(std::unique_ptr<hal::sim::MemoryFlashBank> bank) {
  satp::Weights weights;
  const satp::WeightStatus status = satp::Weights::check(bank->mapped(), bank->size(), weights);
  if (status != satp::WeightStatus::kOk) {
    throw std::invalid_argument(std::string("the weights are refused: ") + satp::weight_status_name(status));
  }
  return std::make_unique<Firmware>(weights, std::move(bank));
}

}  // namespace s4tp::clips
