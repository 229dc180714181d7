#pragma once
/// How hard a car may drive at what it must not touch, and still keep the law (judge/law.hpp).

#include <span>

#include "sim_host/world/judge/law.hpp"

namespace s4tp::adversary {

/// What a car must not drive into: a line (standing) or somebody ahead in its lane.
struct Obstacle {
  double gap_m = 0.0;        ///< from the car's bumper
  double speed_mps = 0.0;    ///< it may brake with Rss::front_braking_mps2 at any time
  bool at_distance = false;  ///< D4: the RSS gap is owed; else D2: the duty's braking, once it has answered
  double answers_after_s = 0.0;  ///< D2: what is left of the reaction time
};

/// LAW-040 Whether a car that drives for `step_s` at an acceleration can then still do what it owes.
[[nodiscard]] bool keeps(const judge::Law& law, const Obstacle& obstacle, double speed_mps,
                         double acceleration_mps2, double step_s);

/// LAW-041 The hardest acceleration, up to `most_mps2`, that keeps the law towards all of them, in steps of
/// 0.25 m/s^2; where none does, the duty's braking.
[[nodiscard]] double hardest_mps2(const judge::Law& law, std::span<const Obstacle> obstacles,
                                  double speed_mps, double most_mps2, double step_s);

}  // namespace s4tp::adversary
