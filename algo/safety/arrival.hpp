#pragma once
/// When others come to ground that our way and theirs share, and when they have left it.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// Stands for "not within any time that matters" [s].
inline constexpr float kNeverS = 1e3F;
/// Gentler braking is no sign of an intention to stop.
inline constexpr float kPlainBrakingMps2 = -1.0F;

/// A vehicle on its way to a conflict zone, along the one of its paths that gets there first.
struct Approach {
  bool reaches = false;
  float to_entry_m = 0.0F;  ///< of its box centre; <= 0: inside
  float to_exit_m = 0.0F;   ///< > 0
  int path = 0;             ///< of the agent's
};
/// Of the ways at least as probable as `least_probability`.
[[nodiscard]] Approach approach_to(const Agent& agent, const ConflictZone& zone,
                                   float least_probability = 0.0F);

/// Seconds until vehicle `agent`, free to accelerate, can reach `zone`'s part of its lane; 0 when inside,
/// kNeverS when it cannot reach it or has left it (TERM-011).
[[nodiscard]] float earliest_arrival_s(const Scene& scene, int agent, const ConflictZone& zone,
                                       const Parameters& parameters);

/// The same for the last `way_m` of its way, wherever in the zone's lane they end.
[[nodiscard]] float earliest_time_s(const Scene& scene, const Agent& agent, const ConflictZone& zone,
                                    float way_m, const Parameters& parameters);

/// Seconds until it has covered `way_m` going on as it does: at its speed, or gaining as it gains, up to its
/// lane's limit; one who brakes or stands is expected to set off at an ordinary pace half a second from now.
[[nodiscard]] float expected_time_s(const Scene& scene, const Agent& agent, const ConflictZone& zone,
                                    float way_m);

/// When it will have covered `way_m` if it goes on braking as it does, or gaining half as much; kNeverS when
/// it stops, or nearly, before.
[[nodiscard]] float clear_time_s(const Track& track, float way_m);

}  // namespace s4tp
