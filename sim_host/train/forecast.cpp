#include "sim_host/train/forecast.hpp"

#include <algorithm>
#include <iterator>

namespace s4tp::train {
namespace {

constexpr float kPaces[kMaxModes] = {1.0F, 0.8F, 1.2F};

template <class OneVehicle>
Forecasts of_all(const SampleSet& set, const std::vector<std::size_t>& samples,
                 const OneVehicle& one_vehicle) {
  Forecasts result(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = set[samples[i]];
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) {
      one_vehicle(sample, vehicle, result[i][static_cast<std::size_t>(vehicle)]);
    }
  }
  return result;
}

// A future at another pace: the place it would have reached by then, on its way beyond the last step straight
// on.
void at_pace(const Forecast& from, int mode, float pace, float (&position_m)[kHorizonSteps][2]) {
  const auto& way = from.position_m[mode];
  const auto at = [&](int step, int axis) { return step < 0 ? 0.0F : way[step][axis]; };
  for (int i = 0; i < kHorizonSteps; ++i) {
    const float passed = static_cast<float>(i + 1) * pace;  // steps; step s stands at index s - 1
    const int before = std::min(static_cast<int>(passed), kHorizonSteps - 1);
    const float share = passed - static_cast<float>(before);
    for (int axis = 0; axis < 2; ++axis) {
      position_m[i][axis] = at(before - 1, axis) + share * (at(before, axis) - at(before - 1, axis));
    }
  }
}

}  // namespace

double Forecast::yield_probability() const {
  double sum = 0.0;
  for (int mode = 0; mode < kMaxModes; ++mode)
    sum += static_cast<double>(probability[mode]) * static_cast<double>(yields[mode]);
  return std::min(sum, 1.0);
}

int Forecast::likeliest() const {
  return static_cast<int>(std::distance(std::begin(probability),
                                        std::max_element(std::begin(probability), std::end(probability))));
}

std::array<double, 2> Forecast::mean_end() const {
  std::array<double, 2> mean{};
  for (int mode = 0; mode < kMaxModes; ++mode) {
    for (int axis = 0; axis < 2; ++axis) {
      mean[axis] += static_cast<double>(probability[mode]) * position_m[mode][kHorizonSteps - 1][axis];
    }
  }
  return mean;
}

Forecasts kinematic_forecasts(const SampleSet& set, const std::vector<std::size_t>& samples) {
  return of_all(set, samples, [](const Sample& sample, int vehicle, Forecast& forecast) {
    const KinematicFuture& future = sample.kinematic[vehicle];
    for (int mode = 0; mode < kMaxModes; ++mode) {
      forecast.probability[mode] = future.probability[mode];
      forecast.yields[mode] = future.yields[mode];
      for (int i = 0; i < kHorizonSteps; ++i) {
        for (int axis = 0; axis < 2; ++axis) {
          forecast.position_m[mode][i][axis] = 0.01F * static_cast<float>(future.position_cm[mode][i][axis]);
        }
      }
    }
  });
}

Forecasts kinematic_variants(const SampleSet& set, const std::vector<std::size_t>& samples) {
  Forecasts result = kinematic_forecasts(set, samples);
  for (SceneForecast& scene : result) {
    for (Forecast& forecast : scene) {
      const Forecast from = forecast;
      for (int mode = 0; mode < kMaxModes; ++mode) {
        forecast.probability[mode] = 1.0F / kMaxModes;
        at_pace(from, from.likeliest(), kPaces[mode], forecast.position_m[mode]);
      }
    }
  }
  return result;
}

Forecasts steady_forecasts(const SampleSet& set, const std::vector<std::size_t>& samples) {
  return of_all(set, samples, [](const Sample& sample, int vehicle, Forecast& forecast) {
    forecast.probability[0] = 1.0F;
    for (int i = 0; i < kHorizonSteps; ++i) {
      forecast.position_m[0][i][0] = sample.input.speed_mps[vehicle] * kStepS * static_cast<float>(i + 1);
    }
  });
}

}  // namespace s4tp::train
