// What the training makes small, on futures written by hand.

#include "sim_host/train/loss.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace s4tp::train {
namespace {

using torch::Tensor;

/// Futures that stay where they are, and what was predicted of them.
struct Futures {
  Batch batch = random_batch(satp::kMcuShape, 1);
  Encoded encoded;
  Decoded decoded;

  Futures() {
    batch.target.zero_();
    encoded.route = torch::full({batch.vehicles(), kPathsPerAgent}, 0.5F);
    decoded.pose = torch::zeros({batch.vehicles(), kMaxModes, kHorizonSteps, 3});
    decoded.score = torch::zeros({batch.vehicles(), kMaxModes});
    decoded.yields = torch::zeros({batch.vehicles(), kMaxModes});
  }
  /// All modes of the vehicle are so far off, sideways, at every step.
  void put_off(int vehicle, float off_m) { decoded.pose[vehicle].select(2, 1).fill_(off_m); }
  [[nodiscard]] Loss loss() const { return loss_of(batch, encoded, decoded); }
};

// TRAIN-017 Of kMaxAgents = 5 vehicles one is 2 m off, which smooth L1 counts as 1.5: 1.5 / 5 = 0.3. One that shares a
// zone with us counts as three: 3 * 1.5 / 7 = 0.643.
TEST(Loss, WhoSharesAZoneCountsMore) {
  Futures futures;
  futures.put_off(1, 2.0F);
  EXPECT_NEAR(futures.loss().position.item<float>(), 0.3F, 1e-4F);
  futures.batch.rule[1][0] = 1.0F;
  EXPECT_NEAR(futures.loss().position.item<float>(), 3.0F * 1.5F / 7.0F, 1e-4F);
}

// TRAIN-018 One mode in three, taken to be as likely as the others, is where the vehicle is, the others 2 m off:
// -log((1 + 2 exp(-2)) / 3) = 0.859; sure of it 0. At 7 m all of them cost the line beyond 5 m,
// (2 * 5 * 7 - 25) / 2 = 22.5, and not 24.5.
TEST(Loss, TheMixtureAtTheHorizonsEnd) {
  Futures futures;
  for (int vehicle = 0; vehicle < kMaxAgents; ++vehicle) futures.put_off(vehicle, 2.0F);
  futures.decoded.pose.select(1, 0).zero_();
  EXPECT_NEAR(futures.loss().likelihood.item<float>(), -std::log((1.0F + 2.0F * std::exp(-2.0F)) / 3.0F),
              1e-4F);
  futures.decoded.score.select(1, 0).fill_(30.0F);
  EXPECT_NEAR(futures.loss().likelihood.item<float>(), 0.0F, 1e-4F);
  for (int vehicle = 0; vehicle < kMaxAgents; ++vehicle) futures.put_off(vehicle, 7.0F);
  EXPECT_NEAR(futures.loss().likelihood.item<float>(), 22.5F, 1e-3F);
}

// TRAIN-018 Who is not seen any more at the horizon's end has no likelihood there.
TEST(Loss, WhoHasLeftHasNoLikelihood) {
  Futures futures;
  futures.put_off(1, 7.0F);
  futures.batch.target_mask[1][kHorizonSteps - 1] = 0.0F;
  EXPECT_NEAR(futures.loss().likelihood.item<float>(), 0.0F, 1e-4F);
}

/// What a teacher expects: that everybody stays where it is, in all three futures, and does not let us pass.
Decoded teacher_of(const Futures& futures) {
  const Tensor far_off = torch::full_like(futures.decoded.yields, -30.0F);
  return {torch::zeros_like(futures.decoded.pose), torch::zeros_like(futures.decoded.score), far_off};
}

// TRAIN-019 A teacher that expects what happens teaches nothing else: the total is the same.
TEST(Loss, ATeacherThatIsRightChangesNothing) {
  Futures futures;
  futures.put_off(1, 2.0F);
  futures.batch.target_mask.fill_(1.0F);
  futures.batch.route.fill_(-1);
  futures.batch.yields.zero_();
  const Decoded teacher = teacher_of(futures);
  const float alone = futures.loss().total.item<float>();
  const float both = loss_of(futures.batch, futures.encoded, futures.decoded, &teacher).total.item<float>();
  EXPECT_NEAR(both, alone, 1e-4F);
}

// TRAIN-019 Half is learned from the teacher, each of its futures by its probability. The network is right and surely so; of the
// teacher's futures one, of a third, is 2 m off for all. It counts 1.5 in the nearest, half of 1.5 in the expected and half of
// 2^2 / 2 = 2 in the likelihood: a half of a third of 3.25 more.
TEST(Loss, HalfIsLearnedFromTheTeacher) {
  Futures futures;
  futures.batch.target_mask.fill_(1.0F);
  futures.batch.route.fill_(-1);
  futures.batch.yields.zero_();
  futures.decoded.yields.fill_(-30.0F);
  Decoded teacher = teacher_of(futures);
  const float right = loss_of(futures.batch, futures.encoded, futures.decoded, &teacher).total.item<float>();
  teacher.pose.select(1, 2).select(2, 1).fill_(2.0F);
  const float off = loss_of(futures.batch, futures.encoded, futures.decoded, &teacher).total.item<float>();
  EXPECT_NEAR(off - right, 0.5F * (1.5F + 0.5F * 1.5F + 0.5F * 2.0F) / 3.0F, 1e-3F);
}

}  // namespace
}  // namespace s4tp::train
