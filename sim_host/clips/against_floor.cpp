#include "sim_host/clips/against_floor.hpp"

#include <algorithm>
#include <random>
#include <vector>

namespace s4tp::clips {
namespace {

constexpr int kResamples = 2000;
constexpr double kTail = 0.025;

struct Pair {
  double of_m;
  double over_m;
};

}  // namespace

Ratio fde_ratio(const WindowSums& of, const WindowSums& over) {
  std::vector<Pair> vehicles;
  for (const auto& [vehicle, fde_m] : of.fde_by_vehicle_m)
    vehicles.push_back({fde_m, over.fde_by_vehicle_m.at(vehicle)});
  std::mt19937_64 random(1);
  std::vector<double> ratios;
  for (int i = 0; i < kResamples; ++i) {
    Pair sum{0.0, 0.0};
    for (std::size_t k = 0; k < vehicles.size(); ++k) {
      const Pair& drawn = vehicles[random() % vehicles.size()];
      sum.of_m += drawn.of_m;
      sum.over_m += drawn.over_m;
    }
    ratios.push_back(sum.of_m / sum.over_m);
  }
  std::sort(ratios.begin(), ratios.end());
  const auto at = [&](double share) { return ratios[static_cast<std::size_t>(share * (kResamples - 1))]; };
  return {of.fde_m / over.fde_m, at(kTail), at(1.0 - kTail)};
}

}  // namespace s4tp::clips
