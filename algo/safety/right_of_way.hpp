#pragma once
/// Who may go first where our way crosses another: the shared judgement of terminal condition and check.

#include <cstdint>

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
  int path = 0;             ///< of the agent's
};
[[nodiscard]] Approach approach_to(const Agent& agent, const ConflictZone& zone);

/// Whether the vehicle can stop before the zone with kTrustedBrakingMps2.
[[nodiscard]] bool can_stop_for_us(const Agent& agent, const Approach& approach);

/// Seconds until vehicle `agent`, free to accelerate, can reach `zone`'s part of its lane; 0 when inside,
/// a large number (1e3) when it cannot reach it or has left it (TERM-011).
[[nodiscard]] float earliest_arrival_s(const Scene& scene, int agent, const ConflictZone& zone,
                                       const Parameters& parameters);

/// How much a crossing is ours already.
enum class Resolve : std::uint8_t {
  kConsidering = 0,  ///< we can still stop before the zone as on any other day
  kUnderWay,         ///< only by braking hard, or in other vehicles' way
  kCommitted,        ///< we are bound to be in it: the other's present speed counts, not what it might do
};

/// Time that must be left between us and the next one with right of way. Who has waited long takes gaps he
/// would have let pass. A crossing begun is finished as long as the other, whatever it does, comes after us:
/// to give it up is to stand in its way.
[[nodiscard]] float zone_margin_s(const Scene& scene, Resolve resolve, const Parameters& parameters);

/// Whether vehicle `index` leaves us the zone while we are in it, from `in_s` to `out_s`. With right of way
/// it does so
/// - by coming later than safety.zone_margin_s after us, zone_margin_waited_s for who has waited patience_s,
/// and
///   just after us when our crossing is under way: giving it up would leave us in its way (TERM-013);
/// - by having stood for 2 s though nobody it gives way to is coming, if we are there half a second after it
/// could
///   be at the latest: waiting for each other would not end;
/// - by having stood for 1 s, if it comes 0.3 s before we have left at the earliest: it may start when we do,
/// for
///   it may have waited for the same gap, but takes that long to get under way. The same for who queues
///   behind one who stands (TERM-015);
/// - by being slow when our crossing is under way, if we are there first and it can stop gently (TERM-016).
[[nodiscard]] bool leaves_zone_to_us(const Scene& scene, int index, const ConflictZone& zone, float in_s,
                                     float out_s, Resolve resolve, const Parameters& parameters);

/// Whether a slow vehicle, which can still stop gently before all ground shared, comes to it after us, whose
/// crossing is under way: it sees us there.
/// \param own_s_m  of our box centre along `path`
[[nodiscard]] bool lets_us_finish(const Scene& scene, const EgoPath& path, float own_s_m, float own_mps,
                                  const Agent& agent, const Parameters& parameters);

/// Whether who stood at the junction and is at its stop line may wait further on, up to the ground shared:
/// nobody's way is blocked there, and the gap needed is shorter by what is driven already (TERM-014).
[[nodiscard]] bool waits_beyond_line(const Scene& scene, float line_s_m, float start_s_m);

/// Whether, at every zone of `path` that it may reach, the vehicle owes us the way or is already braking to a
/// stop before it, and can still do so. False when its way meets ours nowhere.
[[nodiscard]] bool will_yield(const EgoPath& path, const Agent& agent);

}  // namespace s4tp
