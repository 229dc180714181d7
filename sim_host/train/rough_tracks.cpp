#include "sim_host/train/rough_tracks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim_host/train/random_number.hpp"

namespace s4tp::train {
namespace {

constexpr double kSpeedError_mps = 0.6;
constexpr double kLasting_s = 0.5;       // errors forget themselves in this time
constexpr double kAcrossError_m = 0.12;  // across, relative to where it is seen now
constexpr double kYawRateError_radps = 0.06;
constexpr double kAccelerationError_mps2 = 0.4;  // beyond that of the speeds it is taken from
constexpr double kFullFrom_mps = 3.0;            // slower ones are seen better
constexpr int kRateSteps = 5;                    // accelerations are means over this many steps

/// A stream of normal numbers (Box and Muller).
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : seed_(seed) {}
  double operator()(double deviation) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random_share(seed_, index_)));
    const double turn = 2.0 * std::numbers::pi * random_share(seed_, index_ + 1);
    index_ += 2;
    return deviation * radius * std::cos(turn);
  }

 private:
  std::uint64_t seed_;
  std::uint64_t index_ = 0;
};

using Errors = std::array<double, kHistorySamples>;

// Errors that last: each sample keeps a share of the last one's (a process of Ornstein and Uhlenbeck).
Errors lasting(double deviation, Normal& normal) {
  const double kept = std::exp(-static_cast<double>(kStepS) / kLasting_s);
  Errors errors{};
  errors[0] = normal(deviation);
  for (std::size_t j = 1; j < errors.size(); ++j)
    errors[j] = kept * errors[j - 1] + normal(deviation * std::sqrt(1.0 - kept * kept));
  return errors;
}

float& of(float (&row)[satp::kPairFeatures], satp::PairFeature feature) {
  return row[static_cast<int>(feature)];
}

// `speed` longer along the velocity (x, y).
void speed_up(double speed_mps, double heading_rad, float& x, float& y) {
  x += static_cast<float>(speed_mps * std::cos(heading_rad));
  y += static_cast<float>(speed_mps * std::sin(heading_rad));
}

void roughen_vehicle(double level, Normal& normal, int index, satp::NetworkInput& input) {
  constexpr std::size_t kNow = kHistorySamples - 1;
  const double speed_mps = static_cast<double>(input.speed_mps[index]);
  const double rough = level * std::min(1.0, speed_mps / kFullFrom_mps);
  const Errors faster = lasting(rough * kSpeedError_mps, normal);
  const Errors across = lasting(rough * kAcrossError_m, normal);
  double behind_m = 0.0;  // who was faster was further back
  for (std::size_t j = kHistorySamples; j-- > 0;) {
    if (j < kNow) behind_m += faster[j] * static_cast<double>(kStepS);
    if ((input.history_valid[index] >> j & 1) == 0) continue;
    float(&row)[satp::kHistoryFeatures] = input.history[index][j];
    const double heading_rad = static_cast<double>(row[2]);
    speed_up(std::max(faster[j], -speed_mps), heading_rad, row[3], row[4]);
    row[0] -= static_cast<float>(behind_m);
    row[1] += static_cast<float>(across[j] - across[kNow]);
  }
  const double seen_faster_mps = std::max(faster[kNow], -speed_mps);
  input.speed_mps[index] += static_cast<float>(seen_faster_mps);
  float(&place)[satp::kPlaceFeatures] = input.place[1 + index];
  speed_up(seen_faster_mps, std::atan2(place[2], place[3]), place[4], place[5]);
  float(&pair)[satp::kPairFeatures] = input.pair[index];
  const double rate_mps2 =
      (faster[kNow] - faster[kNow - kRateSteps]) / (kRateSteps * static_cast<double>(kStepS));
  of(pair, satp::PairFeature::kSpeedMps) += static_cast<float>(seen_faster_mps);
  of(pair, satp::PairFeature::kAcceleration) +=
      static_cast<float>(rate_mps2 + normal(rough * kAccelerationError_mps2));
  of(pair, satp::PairFeature::kYawRateRadps) += static_cast<float>(normal(rough * kYawRateError_radps));
  if (of(pair, satp::PairFeature::kLeader) > 0.0F) {
    float& leader_mps = of(pair, satp::PairFeature::kLeaderMps);
    leader_mps = std::max(0.0F, leader_mps + static_cast<float>(normal(rough * kSpeedError_mps)));
  }
}

}  // namespace

void roughen_tracks(double level, std::uint64_t seed, satp::NetworkInput& input) {
  if (level <= 0.0) return;
  for (int i = 0; i < input.hdvs; ++i) {
    Normal normal(random_number(seed, static_cast<std::uint64_t>(i)));
    roughen_vehicle(level, normal, i, input);
  }
}

}  // namespace s4tp::train
