#include "sim_host/train/predict.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim_host/train/loss.hpp"

namespace s4tp::train {
namespace {

using torch::Tensor;

constexpr std::size_t kScenesAtOnce = 128;

// Calls `use` with each batch, its decoding and where it begins in `samples`.
void decode_all(Network& network, const SampleSet& set, const std::vector<std::size_t>& samples,
                bool with_plan, const std::function<void(const Batch&, const Decoded&, std::size_t)>& use) {
  const torch::NoGradGuard no_gradient;
  const torch::Device device = network.parameters().front().device();
  for (std::size_t from = 0; from < samples.size(); from += kScenesAtOnce) {
    std::vector<const Sample*> scenes;
    int vehicles = 0;
    for (std::size_t i = from; i < std::min(from + kScenesAtOnce, samples.size()); ++i) {
      scenes.push_back(&set[samples[i]]);
      vehicles += scenes.back()->input.hdvs;
    }
    if (vehicles == 0) continue;
    const Batch batch = make_batch(scenes).to(device);
    const Tensor has_plan = with_plan ? plan_known(scenes).to(device) : torch::zeros_like(batch.speed_mps);
    use(batch, network.decode(batch, network.encode(batch), has_plan), from);
  }
}

}  // namespace

Forecasts network_forecasts(Network& network, const SampleSet& set, const std::vector<std::size_t>& samples,
                            bool with_plan, double temperature) {
  Forecasts result(samples.size());
  decode_all(network, set, samples, with_plan,
             [&](const Batch& batch, const Decoded& decoded, std::size_t from) {
               const Tensor slot = batch.slot.to(torch::kCPU);
               const Tensor share = torch::softmax(decoded.score / temperature, 1).to(torch::kCPU);
               const Tensor place = decoded.pose.slice(3, 0, 2).to(torch::kCPU).contiguous();
               const auto probability = share.accessor<float, 2>();
               const auto position = place.accessor<float, 4>();
               for (std::int64_t vehicle = 0; vehicle < batch.vehicles(); ++vehicle) {
                 const std::int64_t at = slot[vehicle].item<std::int64_t>();
                 const std::size_t scene = from + static_cast<std::size_t>(at / (1 + kMaxAgents));
                 Forecast& forecast = result[scene][static_cast<std::size_t>(at % (1 + kMaxAgents) - 1)];
                 for (int mode = 0; mode < network.shape().modes; ++mode) {
                   forecast.probability[mode] = probability[vehicle][mode];
                   for (int i = 0; i < kHorizonSteps; ++i) {
                     for (int axis = 0; axis < 2; ++axis) {
                       forecast.position_m[mode][i][axis] = position[vehicle][mode][i][axis];
                     }
                   }
                 }
               }
             });
  return result;
}

double calibrated_temperature(Network& network, const SampleSet& set,
                              const std::vector<std::size_t>& samples) {
  std::vector<Tensor> scores, nearest;
  decode_all(network, set, samples, true, [&](const Batch& batch, const Decoded& decoded, std::size_t) {
    const Tensor seen = (batch.target_mask.sum(1) > 0).nonzero().squeeze(1);
    scores.push_back(decoded.score.index_select(0, seen));
    nearest.push_back(mean_distance_m(batch, decoded).argmin(1).index_select(0, seen));
  });
  if (scores.empty()) return 1.0;
  const Tensor score = torch::cat(scores);
  const Tensor right = torch::cat(nearest);
  const auto loss = [&](double log_temperature) {
    const Tensor likelihood = torch::log_softmax(score / std::exp(log_temperature), 1);
    return -likelihood.gather(1, right.unsqueeze(1)).mean().item<double>();
  };
  double low = std::log(0.2);
  double high = std::log(5.0);
  for (int i = 0; i < 30; ++i) {  // thirds: 5e-6 of the range
    const double left = low + (high - low) / 3.0;
    const double right_end = high - (high - low) / 3.0;
    (loss(left) < loss(right_end) ? high : low) = loss(left) < loss(right_end) ? right_end : left;
  }
  return std::exp(0.5 * (low + high));
}

}  // namespace s4tp::train
