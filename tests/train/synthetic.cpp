#include "tests/train/synthetic.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "sim_host/train/random_number.hpp"

namespace s4tp::train {
namespace {

using satp::PairFeature;

constexpr float kOurSpeedMps = 8.0F;
constexpr float kBrakeMps2 = 3.0F;

struct Numbers {
  std::uint64_t seed;
  std::uint64_t count = 0;
  float between(float low, float high) {
    return low + (high - low) * static_cast<float>(random_share(seed, count++));
  }
};

// Where a vehicle is that turns at a constant rate, in the frame of time 0.
Pose turning(float speed_mps, float rate_radps, float time_s) {
  const float turned = rate_radps * time_s;
  const float way_m = speed_mps * time_s;
  if (std::abs(turned) < 1e-4F) return {way_m, 0.0F, turned};
  const float radius_m = speed_mps / rate_radps;
  return {radius_m * std::sin(turned), radius_m * (1.0F - std::cos(turned)), turned};
}

void fill_history(float (&history)[kHistorySamples][satp::kHistoryFeatures], float speed_mps,
                  float rate_radps) {
  for (int j = 0; j < kHistorySamples; ++j) {
    const Pose pose = turning(speed_mps, rate_radps, kStepS * static_cast<float>(j + 1 - kHistorySamples));
    const float row[] = {pose.x_m, pose.y_m, pose.heading_rad, speed_mps * std::cos(pose.heading_rad),
                         speed_mps * std::sin(pose.heading_rad)};
    std::copy(std::begin(row), std::end(row), history[j]);
  }
}

void fill_lane(Sample& sample, int vehicle) {
  sample.input.lane_points[vehicle][0] = satp::kLanePoints;
  for (int point = 0; point < satp::kLanePoints; ++point) {
    float(&row)[satp::kLaneFeatures] = sample.input.lane[vehicle][0][point];
    row[0] = satp::kLaneSpacingM * static_cast<float>(point);
    row[3] = 13.89F;
  }
}

void fill_vehicle(Sample& sample, int vehicle, float speed_mps, float rate_radps) {
  satp::NetworkInput& input = sample.input;
  input.speed_mps[vehicle] = speed_mps;
  input.paths_meet[vehicle] = 1;
  input.history_valid[vehicle] = (1U << kHistorySamples) - 1U;
  fill_history(input.history[vehicle], speed_mps, rate_radps);
  fill_lane(sample, vehicle);
  input.pair[vehicle][static_cast<int>(PairFeature::kSpeedMps)] = speed_mps;
  input.pair[vehicle][static_cast<int>(PairFeature::kOurSpeedMps)] = kOurSpeedMps;
  const float place[] = {20.0F,
                         vehicle == 0 ? 10.0F : -20.0F,
                         vehicle == 0 ? 0.0F : 1.0F,
                         vehicle == 0 ? 1.0F : 0.0F,
                         vehicle == 0 ? speed_mps : 0.0F,
                         vehicle == 0 ? 0.0F : speed_mps,
                         4.5F,
                         1.8F};
  std::copy(std::begin(place), std::end(place), input.place[1 + vehicle]);
  sample.target.valid[vehicle] = (1U << kHorizonSteps) - 1U;
  sample.route[vehicle] = 0;
  // The comparison keeps speed and heading.
  sample.kinematic[vehicle].probability[0] = 1.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    sample.kinematic[vehicle].position_cm[0][i][0] =
        static_cast<std::int16_t>(std::lround(100.0F * speed_mps * kStepS * static_cast<float>(i + 1)));
  }
}

// We come from the left of vehicle 1, whose zone with us is 20 m ahead of it, and go or stop short of it.
void fill_branch(Sample& sample, float speed_mps, bool goes) {
  for (int step = 0; step < satp::kDecoderSteps; ++step) {
    const auto way_m = [&](int steps) {
      const float free_m = 0.5F * kOurSpeedMps * static_cast<float>(steps);
      return goes ? free_m : std::min(free_m, 6.0F);
    };
    const float begin_m = way_m(step);
    const float end_m = way_m(step + 1);
    const float speed_now = goes || end_m < 6.0F ? kOurSpeedMps : 0.0F;
    // Vehicle 0 drives as we do, 20 m ahead and 10 m to the left; vehicle 1 comes from our right.
    const float seen_by_0[] = {begin_m - 20.0F, -10.0F, 0.0F, end_m - 20.0F, -10.0F, 0.0F,
                               speed_now,       0.0F,   0.0F};
    const float seen_by_1[] = {20.0F,  20.0F - begin_m, -1.57F,        20.0F,        20.0F - end_m,
                               -1.57F, speed_now,       16.0F - end_m, 24.0F - end_m};
    std::copy(std::begin(seen_by_0), std::end(seen_by_0), sample.plan.step[0][step]);
    std::copy(std::begin(seen_by_1), std::end(seen_by_1), sample.plan.step[1][step]);
  }
  for (int i = 0; i < kHorizonSteps; ++i) {
    const float time_s = kStepS * static_cast<float>(i + 1);
    const float braking_s = goes ? std::min(time_s, speed_mps / kBrakeMps2) : 0.0F;
    sample.target.pose[1][i][0] =
        goes ? speed_mps * braking_s - 0.5F * kBrakeMps2 * braking_s * braking_s : speed_mps * time_s;
  }
  sample.yields[1] = goes ? 1 : 0;
  sample.flags = static_cast<std::uint8_t>(kForked | (goes ? kEgoGoes : 0));
}

}  // namespace

void write_rule_traffic(const std::filesystem::path& file, std::uint64_t seed, int roads, int each) {
  SampleWriter writer(file);
  Numbers numbers{seed};
  for (int road = 0; road < roads; ++road) {
    for (int instant = 0; instant < each; ++instant) {
      const auto sample = std::make_unique<Sample>();
      sample->road = static_cast<std::uint64_t>(road);
      sample->fork = static_cast<std::uint64_t>(road) * 1000U + static_cast<std::uint64_t>(instant);
      sample->scenario = SampleScenario::kLeftTurn;
      sample->input.hdvs = 2;
      sample->input.ego_history_valid = (1U << kHistorySamples) - 1U;
      fill_history(sample->input.ego_history, kOurSpeedMps, 0.0F);
      const float place[] = {0.0F, 0.0F, 0.0F, 1.0F, kOurSpeedMps, 0.0F, 4.5F, 1.8F};
      std::copy(std::begin(place), std::end(place), sample->input.place[0]);
      const float rate_radps = numbers.between(-0.4F, 0.4F);
      const float turning_mps = numbers.between(4.0F, 14.0F);
      const float crossing_mps = numbers.between(4.0F, 16.0F);
      fill_vehicle(*sample, 0, turning_mps, rate_radps);
      fill_vehicle(*sample, 1, crossing_mps, 0.0F);
      sample->input.pair[0][static_cast<int>(PairFeature::kYawRateRadps)] = rate_radps;
      float(&pair)[satp::kPairFeatures] = sample->input.pair[1];
      pair[static_cast<int>(PairFeature::kZone)] = 1.0F;
      pair[static_cast<int>(PairFeature::kEntryM)] = 18.0F;
      pair[static_cast<int>(PairFeature::kExitM)] = 22.0F;
      pair[static_cast<int>(PairFeature::kOurEntryM)] = 16.0F;
      pair[static_cast<int>(PairFeature::kOurExitM)] = 24.0F;
      pair[static_cast<int>(PairFeature::kYields)] = 1.0F;
      sample->rule[1] = SampleRule::kYields;
      sample->interacts[1] = 1;
      sample->yields[0] = -1;
      for (int i = 0; i < kHorizonSteps; ++i) {
        const Pose pose = turning(turning_mps, rate_radps, kStepS * static_cast<float>(i + 1));
        sample->target.pose[0][i][0] = pose.x_m;
        sample->target.pose[0][i][1] = pose.y_m;
        sample->target.pose[0][i][2] = pose.heading_rad;
      }
      for (int branch = 0; branch < 2; ++branch) {
        sample->branch = static_cast<std::uint8_t>(branch);
        fill_branch(*sample, crossing_mps, branch == 0);
        writer.add(*sample);
      }
    }
  }
  writer.close();
}

}  // namespace s4tp::train
