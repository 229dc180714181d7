#include "sim_host/train/rough_tracks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "sim_host/train/random_number.hpp"

namespace s4tp::train {
namespace {

using satp::NetworkInput;
using satp::PairFeature;

float of(const NetworkInput& input, int vehicle, PairFeature feature) {
  return input.pair[vehicle][static_cast<int>(feature)];
}

/// One vehicle that has driven straight ahead at `speed_mps` for a second, another that stands.
NetworkInput steady(float speed_mps) {
  NetworkInput input;
  input.hdvs = 2;
  for (int i = 0; i < 2; ++i) {
    const float v = i == 0 ? speed_mps : 0.0F;
    input.speed_mps[i] = v;
    input.pair[i][static_cast<int>(PairFeature::kSpeedMps)] = v;
    input.place[1 + i][3] = 1.0F;  // cosine of its heading in our frame
    input.place[1 + i][4] = v;
    for (int j = 0; j < kHistorySamples; ++j) {
      input.history[i][j][0] = v * kStepS * static_cast<float>(j - kHistorySamples + 1);
      input.history[i][j][3] = v;
    }
    input.history_valid[i] = (1U << kHistorySamples) - 1U;
  }
  input.ego_history[3][3] = 7.0F;
  return input;
}

bool same(const NetworkInput& a, const NetworkInput& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// A level of 0 changes no bit; the same seed gives the same bits, another one others.
TEST(RoughTracks, AreAFunctionOfLevelAndSeed) {
  const NetworkInput before = steady(10.0F);
  NetworkInput none = before;
  roughen_tracks(0.0, 1, none);
  EXPECT_TRUE(same(none, before));
  NetworkInput once = before, again = before, other = before;
  roughen_tracks(1.0, 1, once);
  roughen_tracks(1.0, 1, again);
  roughen_tracks(1.0, 2, other);
  EXPECT_TRUE(same(once, again));
  EXPECT_FALSE(same(once, before));
  EXPECT_FALSE(same(once, other));
}

// Where a vehicle is now, the ego and who stands stay as they are; a speed is the same wherever it is told.
TEST(RoughTracks, LeavePlacesAndStandingAlone) {
  const NetworkInput before = steady(10.0F);
  NetworkInput rough = before;
  roughen_tracks(1.0, 5, rough);
  constexpr int kNow = kHistorySamples - 1;
  EXPECT_EQ(rough.history[0][kNow][0], before.history[0][kNow][0]);
  EXPECT_EQ(rough.history[0][kNow][1], before.history[0][kNow][1]);
  EXPECT_EQ(std::memcmp(rough.ego_history, before.ego_history, sizeof before.ego_history), 0);
  EXPECT_EQ(std::memcmp(rough.history[1], before.history[1], sizeof before.history[1]), 0);
  EXPECT_EQ(std::memcmp(rough.pair[1], before.pair[1], sizeof before.pair[1]), 0);
  EXPECT_NEAR(of(rough, 0, PairFeature::kSpeedMps), rough.speed_mps[0], 1e-5F);
  EXPECT_NEAR(rough.history[0][kNow][3], rough.speed_mps[0], 1e-5F);
  EXPECT_NEAR(rough.place[1][4], rough.speed_mps[0], 1e-5F);
}

// Over 4000 seeds: speeds are off by 0.6 m/s; errors keep exp(-0.5 / 0.5) of themselves over half a second, so
// accelerations are by sqrt(2 * 0.36 * (1 - 0.368) / 0.25 + 0.16) = 1.41 m/s^2.
TEST(RoughTracks, AreAsRoughAsTheySay) {
  constexpr int kSeeds = 4000;
  double speed = 0.0, acceleration = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    NetworkInput rough = steady(10.0F);
    roughen_tracks(1.0, static_cast<std::uint64_t>(seed), rough);
    speed += std::pow(static_cast<double>(rough.speed_mps[0]) - 10.0, 2);
    acceleration += std::pow(static_cast<double>(of(rough, 0, PairFeature::kAcceleration)), 2);
  }
  EXPECT_NEAR(std::sqrt(speed / kSeeds), 0.6, 0.03);
  EXPECT_NEAR(std::sqrt(acceleration / kSeeds), 1.41, 0.06);
}

}  // namespace
}  // namespace s4tp::train
