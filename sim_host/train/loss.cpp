#include "sim_host/train/loss.hpp"

#include <numbers>
#include <utility>

namespace s4tp::train {
namespace {

using torch::Tensor;

// Attention that was given to no path at all is as unlikely as this.
constexpr float kLeastShare = 1e-4F;

// Two modes whose distances differ by less are as good as each other: which of them is called the nearest is
// chance.
constexpr float kAlikeM = 0.1F;
constexpr float kExpectedWeight = 0.5F;
constexpr float kChoiceWeight = 0.5F;
constexpr float kLikelihoodWeight = 0.5F;
constexpr float kEgoWeight = 0.5F;

// Share of what happens, of modes and of odds that is learned from a teacher, where there is one.
constexpr float kTaughtShare = 0.5F;

// A vehicle that shares a zone with us counts as so many.
constexpr float kSharesZoneCount = 3.0F;

// The likelihood at the horizon's end: a round Gaussian a mode, and off it further than so many metres a
// straight line, so that one who turned off where nobody thought of does not outweigh all others.
constexpr float kWidthM = 1.0F;
constexpr float kFarM = 5.0F;

Tensor weighted_mean(const Tensor& values, const Tensor& weights) {
  return (values * weights).sum() / weights.sum().clamp_min(1.0F);
}

// Smooth L1 of poses: x, y, heading in the last dimension, which it sums. The heading is off by the shorter arc.
Tensor smooth_off(const Tensor& off) {
  const Tensor turned =
      torch::remainder(off.slice(-1, 2) + std::numbers::pi, 2.0 * std::numbers::pi) - std::numbers::pi;
  const Tensor both = torch::cat({off.slice(-1, 0, 2), turned}, -1);
  return torch::smooth_l1_loss(both, torch::zeros_like(both), torch::Reduction::None).sum(-1);
}

// -log of the mixture of modes at the horizon's end, its constant left out [V]. A mean over the steps says little of
// the few that are far off there, and a choice of the nearest nothing of how sure the others may be.
Tensor unlikeliness(const Tensor& target, const Decoded& decoded, const Tensor& log_probability) {
  const Tensor off = decoded.pose.select(2, kHorizonSteps - 1).slice(2, 0, 2) -
                     target.select(1, kHorizonSteps - 1).slice(1, 0, 2).unsqueeze(1);
  const Tensor cost =
      2.0F * torch::huber_loss(off.square().sum(2).clamp_min(1e-6F).sqrt(),
                               torch::zeros({1}, off.options()).expand({off.size(0), off.size(1)}),
                               torch::Reduction::None, kFarM);
  return -torch::logsumexp(log_probability - cost / (2.0F * kWidthM * kWidthM), 1);
}

// Mean distance over the steps seen, of each mode [V, K].
Tensor distance_m(const Tensor& target, const Tensor& mask, const Decoded& decoded) {
  const Tensor off = decoded.pose.slice(3, 0, 2) - target.slice(2, 0, 2).unsqueeze(1);
  const Tensor distance = off.square().sum(3).sqrt();
  const Tensor seen = mask.unsqueeze(1);
  return (distance * seen).sum(2) / seen.sum(2).clamp_min(1.0F);
}

// What happens to vehicles, or is taken for it.
struct Happening {
  Tensor target;   ///< [V, horizon, 3]
  Tensor mask;     ///< [V, horizon]
  Tensor counts;   ///< [V] weights
  Tensor yields;   ///< [V] probability of having let us pass
  Tensor settled;  ///< [V] weights of that
};

// Of the modes, which is nearest to what happens and how near each is: nothing to learn from itself.
struct Nearness {
  Tensor best;   ///< [V, 1]
  Tensor share;  ///< [V, K]
};
Nearness nearness_of(const Happening& happening, const Decoded& decoded) {
  const torch::NoGradGuard no_gradient;
  const Tensor distance = distance_m(happening.target, happening.mask, decoded);
  return {distance.argmin(1, true), torch::softmax(distance / -kAlikeM, 1)};
}

Tensor yields_loss(const Happening& happening, const Decoded& decoded, const Nearness& near) {
  const Tensor yielded = happening.yields.unsqueeze(1).expand_as(decoded.yields);
  const Tensor wrong =
      torch::binary_cross_entropy_with_logits(decoded.yields, yielded, {}, {}, torch::Reduction::None);
  return weighted_mean((near.share * wrong).sum(1), happening.settled);
}

// The parts of the loss that compare with what happens; route, yields, ego and total stay undefined.
Loss compare(const Happening& happening, const Decoded& decoded, const Nearness& near) {
  const Tensor steps = happening.mask.sum(1);
  const Tensor smooth =
      (smooth_off(decoded.pose - happening.target.unsqueeze(1)) * happening.mask.unsqueeze(1)).sum(2) /
      steps.clamp_min(1.0F).unsqueeze(1);  // [V, K]
  const Tensor log_probability = torch::log_softmax(decoded.score, 1);
  const Tensor weight = (steps > 0).to(torch::kFloat32) * happening.counts;
  Loss loss;
  loss.position = weighted_mean(smooth.gather(1, near.best).squeeze(1), weight);
  loss.expected = weighted_mean((log_probability.exp() * smooth).sum(1), weight);
  loss.mode = weighted_mean(-(near.share * log_probability).sum(1), weight);
  loss.likelihood = weighted_mean(unlikeliness(happening.target, decoded, log_probability),
                                  happening.mask.select(1, kHorizonSteps - 1) * happening.counts);
  return loss;
}

Tensor total_of(const Loss& loss, const Tensor& choice) {
  return loss.position + kExpectedWeight * loss.expected + kChoiceWeight * choice +
         kLikelihoodWeight * loss.likelihood;
}

// The total of each of the teacher's futures, taken for what happens as often as it is probable.
Tensor taught(const Happening& truth, const Decoded& decoded, const Decoded& teacher) {
  const std::int64_t modes = teacher.score.size(1);
  const Tensor probability = torch::softmax(teacher.score, 1);
  const auto by_mode = [&](const Tensor& weights) { return (weights.unsqueeze(1) * probability).flatten(); };
  const auto repeated = [&](const Tensor& values) { return values.repeat_interleave(modes, 0); };
  const Happening expected{teacher.pose.flatten(0, 1), torch::ones_like(repeated(truth.mask)),
                           by_mode(truth.counts), torch::sigmoid(teacher.yields).flatten(),
                           by_mode(truth.settled)};
  const Decoded own{repeated(decoded.pose), repeated(decoded.score), repeated(decoded.yields)};
  const Nearness near = nearness_of(expected, own);
  const Loss loss = compare(expected, own, near);
  return total_of(loss, loss.mode + yields_loss(expected, own, near));
}

}  // namespace

Tensor mean_distance_m(const Batch& batch, const Decoded& decoded) {
  return distance_m(batch.target, batch.target_mask, decoded);
}

Loss loss_of(const Batch& batch, const Encoded& encoded, const Decoded& decoded, const Decoded* teacher) {
  const Tensor counts = 1.0F + (kSharesZoneCount - 1.0F) * batch.rule.select(1, 0);
  const Happening truth{batch.target, batch.target_mask, counts, batch.yields.clamp_min(0),
                        (batch.yields >= 0).to(torch::kFloat32)};
  const Nearness near = nearness_of(truth, decoded);
  Loss loss = compare(truth, decoded, near);
  const Tensor known = (batch.route >= 0).to(torch::kFloat32);
  const Tensor taken = encoded.route.gather(1, batch.route.clamp_min(0).unsqueeze(1)).squeeze(1);
  loss.route = weighted_mean(-torch::log(taken.clamp_min(kLeastShare)), known);
  loss.yields = yields_loss(truth, decoded, near);
  loss.total = total_of(loss, loss.mode + loss.route + loss.yields);
  if (teacher != nullptr)
    loss.total = (1.0F - kTaughtShare) * loss.total + kTaughtShare * taught(truth, decoded, *teacher);
  if (encoded.ego.defined()) {
    // At the instants a sample tells, the ends of its plan steps.
    const Tensor told = encoded.ego.slice(1, satp::kStepsPerDecode - 1, kHorizonSteps, satp::kStepsPerDecode);
    loss.ego = weighted_mean(smooth_off(told - batch.ego_target).mean(1), batch.ego_known);
    loss.total = loss.total + kEgoWeight * loss.ego;
  } else {
    loss.ego = torch::zeros_like(loss.total);
  }
  return loss;
}

}  // namespace s4tp::train
