#include "sim_host/train/yields_row.hpp"

#include <torch/optim/lbfgs.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "algo/satp/decoder.hpp"
#include "sim_host/train/predict.hpp"

namespace s4tp::train {
namespace {

using torch::Tensor;

constexpr int kFeatures = 2 * satp::kHidden;
constexpr double kNearM = 0.1;         // as the training weighs the modes (loss.cpp)
constexpr std::size_t kUnplanned = 5;  // every fifth is decoded without plan
constexpr std::int64_t kIterations = 200;
constexpr float kQ15 = 32768.0F;

/// What the network made of vehicles whose order with us was settled.
struct Settled {
  Tensor state;        ///< [N, K, features]
  Tensor probability;  ///< [N, K]
  Tensor near;         ///< [N, K] shares of the modes near what happened
  Tensor yielded;      ///< [N]
};

satp::Weights checked(const std::vector<std::uint32_t>& image) {
  satp::Weights weights;
  const satp::WeightStatus status =
      satp::Weights::check(image.data(), static_cast<std::uint32_t>(4 * image.size()), weights);
  if (status != satp::WeightStatus::kOk)
    throw std::runtime_error(std::string("the image is refused: ") + satp::weight_status_name(status));
  return weights;
}

// Mean distance of a future over the steps seen.
double off_m(const Sample& sample, int vehicle, const Pose (&poses)[kHorizonSteps]) {
  double sum = 0.0;
  int steps = 0;
  for (int i = 0; i < kHorizonSteps; ++i) {
    if ((sample.target.valid[vehicle] >> static_cast<unsigned>(i) & 1U) == 0) continue;
    const float(&truth)[3] = sample.target.pose[vehicle][i];
    sum += std::hypot(static_cast<double>(poses[i].x_m - truth[0]),
                      static_cast<double>(poses[i].y_m - truth[1]));
    ++steps;
  }
  return steps == 0 ? 0.0 : sum / steps;
}

/// \param going  only where we go, and always under our plan
Settled settled(const satp::Weights& weights, const SampleSet& set, const std::vector<std::size_t>& samples,
                bool going) {
  const auto scratch = std::make_unique<satp::EncoderScratch>();
  const auto work = std::make_unique<satp::DecoderScratch>();
  const auto encoded = std::make_unique<satp::Encoded>();
  satp::Futures futures;
  std::vector<float> state, probability, distance, yielded;
  for (const std::size_t i : samples) {
    const Sample& sample = set[i];
    if ((sample.flags & kNoPlan) != 0 || (going && (sample.flags & kEgoGoes) == 0)) continue;
    bool any = false;
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) any = any || sample.yields[vehicle] >= 0;
    if (!any) continue;
    satp::encode(weights, sample.input, *scratch, *encoded);
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) {
      if (sample.yields[vehicle] < 0) continue;
      const bool planned = going || i % kUnplanned != 0;
      satp::decode(weights, *encoded, vehicle, planned ? sample.plan.step[vehicle] : nullptr, *work, futures);
      for (int mode = 0; mode < kMaxModes; ++mode) {
        for (const std::int16_t value : work->ends[mode]) state.push_back(static_cast<float>(value) / kQ15);
        probability.push_back(futures.probability[mode]);
        distance.push_back(static_cast<float>(off_m(sample, vehicle, futures.poses[mode])));
      }
      yielded.push_back(sample.yields[vehicle]);
    }
  }
  if (yielded.empty()) throw std::runtime_error("no vehicle's order with us was settled");
  const auto count = static_cast<std::int64_t>(yielded.size());
  return {torch::tensor(state).view({count, kMaxModes, kFeatures}),
          torch::tensor(probability).view({count, kMaxModes}),
          torch::softmax(torch::tensor(distance).view({count, kMaxModes}) / -kNearM, 1),
          torch::tensor(yielded)};
}

// Row and bias behind it.
std::pair<Tensor, Tensor> regression(const Settled& known) {
  Tensor row = torch::zeros({kFeatures}).requires_grad_(true);
  Tensor bias = torch::zeros({1}).requires_grad_(true);
  torch::optim::LBFGS solver(
      {row, bias}, torch::optim::LBFGSOptions(1.0).max_iter(kIterations).line_search_fn("strong_wolfe"));
  const Tensor label = known.yielded.unsqueeze(1).expand_as(known.near);
  solver.step([&] {
    solver.zero_grad();
    const Tensor wrong = torch::binary_cross_entropy_with_logits(torch::matmul(known.state, row) + bias,
                                                                 label, {}, {}, torch::Reduction::None);
    Tensor loss = (known.near * wrong).sum(1).mean();
    loss.backward();
    return loss;
  });
  return {row.detach(), bias.detach()};
}

// \param row, bias  of states in 2^-15
void write_row(const Tensor& row, double bias, const satp::Weights& weights,
               std::vector<std::uint32_t>& image) {
  const satp::Linear layer = weights.linear(satp::kHeadModes);
  const auto place = [&](const void* address) {
    return reinterpret_cast<char*>(image.data()) +
           (static_cast<const char*>(address) - reinterpret_cast<const char*>(image.data()));
  };
  const double most = std::max(row.abs().max().item<double>(), 1e-6);
  const auto scale = static_cast<float>(most / 127.0 / static_cast<double>(kQ15));
  for (int j = 0; j < kFeatures; ++j) {
    const auto q = static_cast<std::int8_t>(std::lround(row[j].item<double>() / most * 127.0));
    std::memcpy(place(&layer.weights[layer.stride + j]), &q, sizeof q);
  }
  const auto sum = static_cast<std::int32_t>(std::lround(bias / static_cast<double>(scale)));
  std::memcpy(place(&layer.bias[1]), &sum, sizeof sum);
  std::memcpy(place(&layer.multiplier[1]), &scale, sizeof scale);
  satp::seal(image.data());
}

}  // namespace

std::vector<std::uint32_t> fit_yields_row(std::vector<std::uint32_t> image, const SampleSet& set,
                                          const std::vector<std::size_t>& samples,
                                          const std::vector<std::size_t>& calibration) {
  const satp::Weights weights = checked(image);
  const auto [row, bias] = regression(settled(weights, set, samples, false));
  const Settled judged = settled(weights, set, calibration, true);
  const Rescale rescale =
      best_rescale(torch::matmul(judged.state, row) + bias, judged.probability, judged.yielded);
  write_row(row * rescale.scale, bias.item<double>() * rescale.scale + rescale.shift, weights, image);
  return image;
}

}  // namespace s4tp::train
