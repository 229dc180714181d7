#pragma once
/// What a driver of the adversary does with the room that the law leaves it.

#include <cstdint>

#include "sim_host/world/judge/law.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::adversary {

/// What a driver is up to, from one decision to the next.
struct Mood {
  double drives_until_s = 0.0;  ///< has stood for long: no braking for its own sake
  int action = 0;
  double action_until_s = 0.0;
  std::uint64_t draws = 0;
};

/// A driver's situation.
struct DriverSituation {
  const traffic::RoadIndex& road;
  const judge::Law& law;
  const traffic::Actor& self;  ///< with its way, ...
  const traffic::Actor& ego;   ///< ... and so is the ego
  double time_s;
  double step_s;  ///< to the next decision
  double stood_s;
  bool changing;       ///< into a lane: it rolls
  std::uint64_t seed;  ///< its own
};

/// LAW-042 Within the law's bounds half of the drivers change their mind at random (full power, rolling on, braking
/// gently or as hard as can be), the others do what brings them nearest to the ego within 3 s. Nobody stands for
/// ever: after `kStands_s` without a reason a car drives on.
/// \param most_mps2  that the law allows
[[nodiscard]] double chosen_mps2(const DriverSituation& at, double most_mps2, Mood& mood);

}  // namespace s4tp::adversary
