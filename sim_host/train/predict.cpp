#include "sim_host/train/predict.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim_host/train/loss.hpp"

namespace s4tp::train {
namespace {

using torch::Tensor;

constexpr std::size_t kScenesAtOnce = 128;

constexpr double kMostShift = 4.0;  // log-odds

// Where between them a function with one minimum is smallest; by thirds: 5e-6 of the way.
double least(double low, double high, const std::function<double(double)>& of) {
  for (int i = 0; i < 30; ++i) {
    const double left = low + (high - low) / 3.0;
    const double right = high - (high - low) / 3.0;
    const bool falls = of(left) >= of(right);
    (falls ? low : high) = falls ? left : right;
  }
  return 0.5 * (low + high);
}

// Calls `use` with each batch, its decoding and where it begins in `samples`.
void decode_all(Network& network, const SampleSet& set, const std::vector<std::size_t>& samples,
                bool with_plan,
                const std::function<void(const Batch&, const Encoded&, const Decoded&, std::size_t)>& use) {
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
    const Batch batch = make_batch(scenes, network.shape()).to(device);
    const Tensor has_plan = with_plan ? plan_known(scenes).to(device) : torch::zeros_like(batch.speed_mps);
    const Encoded encoded = network.encode(batch);
    use(batch, encoded, network.decode(batch, encoded, has_plan), from);
  }
}

}  // namespace

Forecasts network_forecasts(Network& network, const SampleSet& set, const std::vector<std::size_t>& samples,
                            bool with_plan, double temperature) {
  Forecasts result(samples.size());
  decode_all(network, set, samples, with_plan,
             [&](const Batch& batch, const Encoded& encoded, const Decoded& decoded, std::size_t from) {
               const Tensor slot = batch.slot.to(torch::kCPU);
               const Tensor share = torch::softmax(decoded.score / temperature, 1).to(torch::kCPU);
               const Tensor lets_pass = torch::sigmoid(decoded.yields).to(torch::kCPU);
               const Tensor place = decoded.pose.slice(3, 0, 2).to(torch::kCPU).contiguous();
               const Tensor gate = encoded.gate.to(torch::kCPU);
               const auto probability = share.accessor<float, 2>();
               const auto yields = lets_pass.accessor<float, 2>();
               const auto position = place.accessor<float, 4>();
               for (std::int64_t vehicle = 0; vehicle < batch.vehicles(); ++vehicle) {
                 const std::int64_t at = slot[vehicle].item<std::int64_t>();
                 const std::size_t scene = from + static_cast<std::size_t>(at / (1 + kMaxAgents));
                 Forecast& forecast = result[scene][static_cast<std::size_t>(at % (1 + kMaxAgents) - 1)];
                 forecast.gate = gate[vehicle][0].item<float>();
                 for (int mode = 0; mode < network.shape().modes; ++mode) {
                   forecast.probability[mode] = probability[vehicle][mode];
                   forecast.yields[mode] = yields[vehicle][mode];
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
  decode_all(network, set, samples, true,
             [&](const Batch& batch, const Encoded&, const Decoded& decoded, std::size_t) {
               const Tensor seen = (batch.target_mask.sum(1) > 0).nonzero().squeeze(1);
               scores.push_back(decoded.score.index_select(0, seen));
               nearest.push_back(mean_distance_m(batch, decoded).argmin(1).index_select(0, seen));
             });
  if (scores.empty()) return 1.0;
  const Tensor score = torch::cat(scores);
  const Tensor right = torch::cat(nearest);
  return std::exp(least(std::log(0.2), std::log(5.0), [&](double log_temperature) {
    const Tensor likelihood = torch::log_softmax(score / std::exp(log_temperature), 1);
    return -likelihood.gather(1, right.unsqueeze(1)).mean().item<double>();
  }));
}

Rescale best_rescale(const Tensor& log_odds, const Tensor& share, const Tensor& yielded) {
  const auto loss = [&](double log_scale, double shift) {
    const Tensor expected =
        (share * torch::sigmoid(log_odds * std::exp(log_scale) + shift)).sum(1).clamp(1e-6, 1.0 - 1e-6);
    return torch::binary_cross_entropy(expected, yielded).item<double>();
  };
  const auto best_shift = [&](double log_scale) {
    return least(-kMostShift, kMostShift, [&](double shift) { return loss(log_scale, shift); });
  };
  const double log_scale =
      least(std::log(0.2), std::log(5.0), [&](double scale) { return loss(scale, best_shift(scale)); });
  return {std::exp(log_scale), best_shift(log_scale)};
}

void calibrate_yields(Network& network, const SampleSet& set, std::vector<std::size_t> samples,
                      double temperature) {
  std::erase_if(samples, [&](std::size_t i) { return (set[i].flags & kEgoGoes) == 0; });
  std::vector<Tensor> odds, shares, happened;
  decode_all(network, set, samples, true,
             [&](const Batch& batch, const Encoded&, const Decoded& decoded, std::size_t) {
               const Tensor settled = (batch.yields >= 0).nonzero().squeeze(1);
               odds.push_back(decoded.yields.index_select(0, settled));
               shares.push_back(torch::softmax(decoded.score / temperature, 1).index_select(0, settled));
               happened.push_back(batch.yields.index_select(0, settled));
             });
  if (odds.empty() || torch::cat(happened).numel() == 0) return;
  const Rescale rescale = best_rescale(torch::cat(odds), torch::cat(shares), torch::cat(happened));
  network.rescale_yields(rescale.scale, rescale.shift);
}

}  // namespace s4tp::train
