#pragma once
/// Who may go first where our way crosses another: the shared judgement of terminal condition and check.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// A driver who owes us the way is trusted to brake up to this hard for it; one who would need more is not.
inline constexpr float kTrustedBrakingMps2 = 4.0F;

/// A vehicle on its way to a conflict zone, along the one of its paths that gets there first.
struct Approach {
  bool reaches = false;
  float to_entry_m = 0.0F;  ///< of its box centre; <= 0: inside
  float to_exit_m = 0.0F;   ///< > 0
};
[[nodiscard]] Approach approach_to(const Agent& agent, const ConflictZone& zone);

/// Whether the vehicle can stop before the zone with kTrustedBrakingMps2.
[[nodiscard]] bool can_stop_for_us(const Agent& agent, const Approach& approach);

/// Seconds until vehicle `agent`, free to accelerate, can reach `zone`'s part of its lane; 0 when inside,
/// a large number (1e3) when it cannot reach it or has left it (TERM-011).
[[nodiscard]] float earliest_arrival_s(const Scene& scene, int agent, const ConflictZone& zone,
                                       const Parameters& parameters);

/// Whether vehicle `index` leaves us the zone while we are in it, from `in_s` to `out_s`.
/// \param committed  we are bound to be in it: then the other's present speed counts, not what it might do
[[nodiscard]] bool leaves_zone_to_us(const Scene& scene, int index, const ConflictZone& zone, float in_s,
                                     float out_s, bool committed, const Parameters& parameters);

/// Whether, at every zone of `path` that it may reach, the vehicle owes us the way or is already braking to a
/// stop before it, and can still do so. False when its way meets ours nowhere.
[[nodiscard]] bool will_yield(const EgoPath& path, const Agent& agent);

}  // namespace s4tp
