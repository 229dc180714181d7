#include "sim_host/clips/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::clips {
namespace {

constexpr double kMiss_m = 2.0;
constexpr double kManoeuvre_mps = 2.0;
constexpr double kManoeuvre_rad = 15.0 / 180.0 * std::numbers::pi;
// Spread around a future's places, the same for all predictors: as wide at 3 s as a miss is.
constexpr double kSpread_m = 0.2;
constexpr double kSpread_mps = 0.6;

double apart_m(map::Vec2 a, map::Vec2 b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

double ade_m(const ClipFuture& future, const ClipFuture& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.places.size(); ++i) sum += apart_m(future.places[i], truth.places[i]);
  return sum / static_cast<double>(truth.places.size());
}

/// Mean over the steps of -log of the mixture's density at the truth [log 1/m^2].
double nll_of(const std::vector<ClipFuture>& futures, const ClipFuture& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.places.size(); ++i) {
    const double spread_m =
        kSpread_m + kSpread_mps * static_cast<double>(kStepS) * static_cast<double>(i + 1);
    double density = 1e-12;  // of a surprise nobody counts on
    for (const ClipFuture& future : futures) {
      const double off = apart_m(future.places[i], truth.places[i]) / spread_m;
      density +=
          future.probability * std::exp(-0.5 * off * off) / (2.0 * std::numbers::pi * spread_m * spread_m);
    }
    sum -= std::log(density);
  }
  return sum / static_cast<double>(truth.places.size());
}

}  // namespace

void WindowSums::add(std::uint64_t vehicle, const std::vector<ClipFuture>& futures, const ClipFuture& truth) {
  ++windows;
  ade_m += clips::ade_m(futures.front(), truth);
  const double end_m = apart_m(futures.front().places.back(), truth.places.back());
  fde_m += end_m;
  fde_by_vehicle_m[vehicle] += end_m;
  double least_m = std::numeric_limits<double>::infinity();
  bool hit = false;
  for (const ClipFuture& future : futures) {
    least_m = std::min(least_m, clips::ade_m(future, truth));
    hit = hit || apart_m(future.places.back(), truth.places.back()) <= kMiss_m;
  }
  min_ade_m += least_m;
  missed += hit ? 0 : 1;
  nll += nll_of(futures, truth);
}

nlohmann::json WindowSums::figures() const {
  const double n = std::max(1, windows);
  return {{"windows", windows},         {"ade_3s", ade_m / n},        {"fde_3s", fde_m / n},
          {"min_ade_3", min_ade_m / n}, {"miss_rate_2m", missed / n}, {"nll", nll / n}};
}

void ClipFigures::add(const Clip& clip) {
  const std::string family = family_of(clip.id);
  for (const Window& window : windows_.of(clip)) {
    const ClipVehicle& vehicle = clip.vehicles[window.vehicle];
    if (kept_only_ && !kept_for_judging(family, vehicle.id)) continue;
    const ClipState& now = vehicle.states.at(window.step);
    const ClipState& end = vehicle.states.at(window.step + kHorizonSteps);
    ClipFuture truth;
    for (int k = 0; k < kHorizonSteps; ++k) {
      truth.places[static_cast<std::size_t>(k)] = vehicle.states.at(window.step + k + 1).centre;
    }
    const std::vector<ClipFuture> futures = forecaster_.forecast(clip, window.vehicle, window.step);
    const std::uint64_t number = vehicle_number(family, vehicle.id);
    families_[family].all.add(number, futures, truth);
    const bool turns = std::abs(map::wrap_angle(end.heading_rad - now.heading_rad)) > kManoeuvre_rad;
    if (turns || std::abs(end.speed_mps - now.speed_mps) > kManoeuvre_mps) {
      families_[family].manoeuvre.add(number, futures, truth);
    }
  }
}

}  // namespace s4tp::clips
