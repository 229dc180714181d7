#include "sim_host/train/branch_tracks.hpp"

#include <algorithm>
#include <cmath>

namespace s4tp::train {
namespace {

constexpr double kRange_m = 150.0;  // as the perception node's

}  // namespace

void BranchTracks::adopt(const scene::Scene& scene, const std::vector<traffic::CarState>& cars) {
  for (const scene::Agent& agent : scene.agents) {
    for (const traffic::CarState& car : cars) {
      const double off_m = std::hypot(car.centre.x - origin_.x - static_cast<double>(agent.track.centre.x_m),
                                      car.centre.y - origin_.y - static_cast<double>(agent.track.centre.y_m));
      if (off_m < 1.5) ids_.try_emplace(car.id, agent.track.id);
    }
    last_id_ = std::max(last_id_, static_cast<int>(agent.track.id));
  }
}

TrackList BranchTracks::of(const traffic::CarState& ego, std::vector<traffic::CarState> cars) {
  const auto away_m = [&](const traffic::CarState& car) {
    return std::hypot(car.centre.x - ego.centre.x, car.centre.y - ego.centre.y);
  };
  std::erase_if(cars, [&](const traffic::CarState& car) { return away_m(car) > kRange_m; });
  std::stable_sort(cars.begin(), cars.end(), [&](const traffic::CarState& a, const traffic::CarState& b) {
    return away_m(a) < away_m(b);
  });
  TrackList list;
  for (const traffic::CarState& car : cars) {
    if (list.full()) break;
    if (errors_.dropout > 0.0 && random_.uniform() < errors_.dropout) continue;
    (void)list.push(track_of(car));
  }
  return list;
}

double BranchTracks::noisy(double value, double deviation) {
  return deviation > 0.0 ? random_.normal(value, deviation) : value;
}

Track BranchTracks::track_of(const traffic::CarState& car) {
  const auto [known, fresh] = ids_.try_emplace(car.id, static_cast<std::uint8_t>(last_id_ % 254 + 1));
  if (fresh) last_id_ = known->second;
  Track track;
  track.id = known->second;
  track.centre = {static_cast<float>(noisy(car.centre.x - origin_.x, errors_.position_noise_m)),
                  static_cast<float>(noisy(car.centre.y - origin_.y, errors_.position_noise_m)),
                  static_cast<float>(
                      std::remainder(noisy(car.heading_rad, errors_.heading_noise_rad), 6.283185307179586))};
  track.centre.heading_rad = std::clamp(track.centre.heading_rad, -3.1415F, 3.1415F);
  track.speed_mps = static_cast<float>(std::clamp(noisy(car.speed_mps, errors_.speed_noise_mps), 0.0, 60.0));
  track.acceleration_mps2 = static_cast<float>(std::clamp(car.acceleration_mps2, -12.0, 12.0));
  track.yaw_rate_radps = static_cast<float>(std::clamp(car.yaw_rate_radps, -1.28, 1.27));
  track.length_m = static_cast<float>(car.length_m);
  track.width_m = static_cast<float>(car.width_m);
  return track;
}

}  // namespace s4tp::train
