#include "sim_host/train/loss.hpp"

#include <numbers>

namespace s4tp::train {
namespace {

using torch::Tensor;

// Attention that was given to no path at all is as unlikely as this.
constexpr float kLeastShare = 1e-4F;

Tensor weighted_mean(const Tensor& values, const Tensor& weights) {
  return (values * weights).sum() / weights.sum().clamp_min(1.0F);
}

}  // namespace

Tensor mean_distance_m(const Batch& batch, const Decoded& decoded) {
  const Tensor off = decoded.pose.slice(3, 0, 2) - batch.target.slice(2, 0, 2).unsqueeze(1);
  const Tensor distance = off.square().sum(3).sqrt();
  const Tensor seen = batch.target_mask.unsqueeze(1);
  return (distance * seen).sum(2) / seen.sum(2).clamp_min(1.0F);
}

Loss loss_of(const Batch& batch, const Encoded& encoded, const Decoded& decoded) {
  const Tensor best = [&] {
    const torch::NoGradGuard no_gradient;
    return mean_distance_m(batch, decoded).argmin(1, true);
  }();
  const std::int64_t horizon = decoded.pose.size(2);
  const Tensor pose = decoded.pose.gather(1, best.view({-1, 1, 1, 1}).expand({-1, 1, horizon, 3})).squeeze(1);
  const Tensor off = pose - batch.target;
  const Tensor turned =
      torch::remainder(off.select(2, 2) + std::numbers::pi, 2.0 * std::numbers::pi) - std::numbers::pi;
  const Tensor both = torch::cat({off.slice(2, 0, 2), turned.unsqueeze(2)}, 2);
  const Tensor smooth =
      torch::smooth_l1_loss(both, torch::zeros_like(both), torch::Reduction::None).sum(2) * batch.target_mask;
  const Tensor steps = batch.target_mask.sum(1);
  const Tensor seen = (steps > 0).to(torch::kFloat32);
  Loss loss;
  loss.position = weighted_mean(smooth.sum(1) / steps.clamp_min(1.0F), seen);
  loss.mode = weighted_mean(-torch::log_softmax(decoded.score, 1).gather(1, best).squeeze(1), seen);
  const Tensor known = (batch.route >= 0).to(torch::kFloat32);
  const Tensor taken = encoded.route.gather(1, batch.route.clamp_min(0).unsqueeze(1)).squeeze(1);
  loss.route = weighted_mean(-torch::log(taken.clamp_min(kLeastShare)), known);
  loss.total = loss.position + loss.mode + loss.route;
  return loss;
}

}  // namespace s4tp::train
