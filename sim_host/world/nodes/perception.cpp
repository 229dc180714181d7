#include "sim_host/world/nodes/perception.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::nodes {
namespace {

constexpr int kFramesPerTick = 12;
constexpr double kListPeriod_s = 0.1;
constexpr std::uint8_t kLastId = 254;

float clamped(double value, double low, double high) {
  return static_cast<float>(std::clamp(value, low, high));
}

double distance_m(const traffic::CarState& a, const traffic::CarState& b) {
  return std::hypot(a.centre.x - b.centre.x, a.centre.y - b.centre.y);
}

}  // namespace

Perception::Perception(const scenario::PerceptionOptions& options, map::Vec2 origin, std::uint64_t seed)
    : options_(options), origin_(origin), random_(seed) {}

double Perception::noisy(double value, double deviation) {
  return deviation > 0.0 ? random_.normal(value, deviation) : value;
}

std::uint8_t Perception::wire_id(int car) {
  const auto known = ids_.find(car);
  const bool switched =
      options_.id_switches_per_s > 0.0 && random_.uniform() < options_.id_switches_per_s * kListPeriod_s;
  if (known != ids_.end() && !switched) {
    return known->second;
  }
  const auto taken = [&](std::uint8_t id) {
    return std::any_of(ids_.begin(), ids_.end(), [&](const auto& entry) { return entry.second == id; });
  };
  do {
    last_id_ = static_cast<std::uint8_t>(last_id_ >= kLastId ? 1 : last_id_ + 1);
  } while (taken(last_id_));
  return ids_[car] = last_id_;
}

wire::Track Perception::track_of(const traffic::CarState& car) {
  wire::Track track;
  track.id = wire_id(car.id);
  track.x_m = clamped(noisy(car.centre.x - origin_.x, options_.position_noise_m), -1310.0, 1310.0);
  track.y_m = clamped(noisy(car.centre.y - origin_.y, options_.position_noise_m), -1310.0, 1310.0);
  track.heading_rad =
      clamped(map::wrap_angle(noisy(car.heading_rad, options_.heading_noise_rad)), -3.1408, 3.1408);
  track.speed_mps = clamped(noisy(car.speed_mps, options_.speed_noise_mps), 0.0, 60.0);
  track.acceleration_mps2 = clamped(car.acceleration_mps2, -12.8, 12.7);
  track.yaw_rate_radps = clamped(car.yaw_rate_radps, -1.28, 1.27);
  track.length_m = clamped(car.length_m, 0.0, 25.5);
  track.width_m = clamped(car.width_m, 0.0, 3.1);
  return track;
}

void Perception::observe(const traffic::CarState& ego, const std::vector<traffic::CarState>& others,
                         std::uint32_t vehicle_time_ms) {
  std::vector<traffic::CarState> seen;
  for (const traffic::CarState& car : others) {
    const bool missed = options_.dropout > 0.0 && random_.uniform() < options_.dropout;
    if (!missed && distance_m(ego, car) <= options_.range_m &&
        !(options_.occlusion && traffic::hidden(ego, car, others))) {
      seen.push_back(car);
    }
  }
  const auto list_distance_m = [&](const traffic::CarState& car) {
    const double x_mps =
        car.speed_mps * std::cos(car.heading_rad) - ego.speed_mps * std::cos(ego.heading_rad);
    const double y_mps =
        car.speed_mps * std::sin(car.heading_rad) - ego.speed_mps * std::sin(ego.heading_rad);
    return distance_m(ego, car) - wire::kListLeadS * std::hypot(x_mps, y_mps);
  };
  std::ranges::stable_sort(seen, {}, list_distance_m);
  Pending pending;
  pending.due_ms = vehicle_time_ms + 10U * static_cast<std::uint32_t>(std::max(0, options_.latency_ticks));
  const std::size_t count = std::min<std::size_t>(seen.size(), wire::kMaxTracks);
  pending.tracks.vehicle_time_ms = static_cast<std::uint16_t>(vehicle_time_ms & 0xFFFFU);
  pending.tracks.count = static_cast<std::uint8_t>(count);
  pending.tracks.left_out = static_cast<std::uint8_t>(std::min<std::size_t>(seen.size() - count, 31));
  for (std::size_t i = 0; i < count; ++i) {
    pending.tracks.items[i] = track_of(seen[i]);
  }
  // An id is remembered while its car is anywhere around: a gap of a few lists is no new car.
  std::erase_if(ids_, [&](const auto& entry) {
    return std::none_of(others.begin(), others.end(),
                        [&](const traffic::CarState& car) { return car.id == entry.first; });
  });
  pending_.push_back(std::move(pending));
}

void Perception::publish(std::uint32_t vehicle_time_ms, std::vector<wire::Frame>& frames) {
  if (!pending_.empty() && pending_.front().due_ms <= vehicle_time_ms) {
    sender_.start(pending_.front().tracks);
    pending_.pop_front();
  }
  wire::Frame frame;
  for (int i = 0; i < kFramesPerTick && sender_.next(frame); ++i) {
    frames.push_back(frame);
  }
}

}  // namespace s4tp::nodes
