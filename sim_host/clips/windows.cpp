#include "sim_host/clips/windows.hpp"

#include <cmath>
#include <cstdio>

#include "sim_host/clips/forecaster.hpp"

namespace s4tp::clips {
namespace {

constexpr int kBetweenWindows = 5;
constexpr double kMoves_m = 1.0;
constexpr std::uint64_t kKeptOf = 5;

/// The traffic of a window, whichever clip shows it: frames differ, ids and speeds do not.
std::string key_of(const std::string& family, const ClipVehicle& vehicle, int step) {
  std::string key = family + '/' + vehicle.id;
  for (int k = step - kPastSteps; k <= step + kHorizonSteps; ++k) {
    char speed[16];
    std::snprintf(speed, sizeof speed, ",%.3f", vehicle.states.at(k).speed_mps);
    key += speed;
  }
  return key;
}

}  // namespace

std::vector<Window> Windows::of(const Clip& clip) {
  const std::string family = family_of(clip.id);
  std::vector<Window> result;
  std::set<std::string> here;  // within a clip nothing is shown twice
  for (std::size_t i = 0; i < clip.vehicles.size(); ++i) {
    const ClipVehicle& vehicle = clip.vehicles[i];
    if (!vehicle.motor || vehicle.states.empty()) continue;
    const int last = vehicle.states.rbegin()->first - kHorizonSteps;
    for (int step = vehicle.states.begin()->first + kPastSteps; step <= last; ++step) {
      const bool due = (step - vehicle.states.begin()->first) % kBetweenWindows == 0;
      if (!due || !vehicle.seen(step - kPastSteps, step + kHorizonSteps)) continue;
      const map::Vec2 begin = vehicle.states.at(step - kPastSteps).centre;
      const map::Vec2 end = vehicle.states.at(step + kHorizonSteps).centre;
      if (std::hypot(begin.x - end.x, begin.y - end.y) < kMoves_m) continue;
      const std::string key = key_of(family, vehicle, step);
      if (seen_.count(key) != 0) continue;
      here.insert(key);
      result.push_back({i, step});
    }
  }
  seen_.merge(here);
  return result;
}

// FNV-1a: the same on every machine.
std::uint64_t vehicle_number(const std::string& family, const std::string& id) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : family + '/' + id) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return hash ^ (hash >> 32U);
}

bool kept_for_judging(const std::string& family, const std::string& id) {
  return vehicle_number(family, id) % kKeptOf == 0;
}

}  // namespace s4tp::clips
