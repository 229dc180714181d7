#pragma once
/// Who may go first where our way crosses another: the shared judgement of terminal condition and check.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/safety/arrival.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// A driver who owes us the way is trusted to brake up to this hard for it; one who would need more is not.
inline constexpr float kTrustedBrakingMps2 = 4.0F;
/// Who waits keeps this far from the ground shared: others must see that it is free.
inline constexpr float kClearOfZoneM = 0.7F;

/// Whether the vehicle can stop before the zone with kTrustedBrakingMps2.
[[nodiscard]] bool can_stop_for_us(const Agent& agent, const Approach& approach);

/// How much a crossing is ours already.
enum class Resolve : std::uint8_t {
  kConsidering = 0,  ///< we can still stop before the zone as on any other day
  kUnderWay,         ///< only by braking hard, or in other vehicles' way
  kCommitted,        ///< we are bound to be in it: the other's present speed counts, not what it might do
};

/// How far along `path` a crossing is under way for who is at `own_s_m` with `own_mps`: to the last exit
/// before a place to wait clear of all zones; `own_s_m` itself when none is. It is under way from where it
/// takes more than 1.4 times comfortable braking to stop before its first zone, or inside it, and is then
/// one: to give it up half way is to stand in others' way (TERM-016). \param own_s_m  of our box centre
[[nodiscard]] float under_way_until_s_m(const EgoPath& path, float own_s_m, float own_mps,
                                        const Parameters& parameters);

/// Time that must be left between us and the next one with right of way (TERM-013). Who has waited long takes
/// gaps he would have let pass; a crossing begun is finished as long as the other, whatever it does, comes
/// after us.
[[nodiscard]] float zone_margin_s(const Scene& scene, Resolve resolve, const Parameters& parameters);

/// Whether a vehicle leaves us a zone while we are in it, and how that is known.
enum class Passage : std::uint8_t {
  kRefused = 0,
  kFree,     ///< it is not there while we are, or owes us the way
  kTrusted,  ///< it could be, but is counted on to let us: futures in which it does not are no reason to stay
};

/// Judges vehicle `index` at `zone` for our being there from `in_s` to `out_s`.
/// Free: it comes later than zone_margin_s() after us, or has plainly gone before (TERM-005); without right
/// of way, it can stop with kTrustedBrakingMps2, or comes later at its present speed (TERM-004). Trusted,
/// with right of way:
/// - who has stood for 2 s though nobody it gives way to is coming, if we are there half a second after it
///   could be at the latest, or later by a quarter of the time it has stood so: waiting for each other would
///   not end. So even one who stands in the zone already (TERM-022);
/// - who has stood for 1 s, if it comes 0.3 s before we have left at the earliest: it may start when we do,
///   for it may have waited for the same gap, but takes that long to get under way. To who has waited
///   safety.patience_s it is enough to be there 0.3 s before it. The same for who queues behind one who
///   stands (TERM-015);
/// - who is slow when our crossing is under way, if it can stop gently and we are there 0.3 s before it, or a
///   second where it is setting off as we are (TERM-016);
/// - for who has waited so long, or is under way: who can stop gently and, going on as it does on ways of
/// some
///   likelihood, comes zone_margin_s() after us. One who brakes or stands is expected to set off, and nobody
///   before the one in front (TERM-021).
/// Once we are in the zone, who can still stop with kTrustedBrakingMps2 is as good as who can gently. A
/// crossing under way turns free into trusted: who comes after us may have to see that he does.
[[nodiscard]] Passage judge_passage(const Scene& scene, int index, const ConflictZone& zone, float in_s,
                                    float out_s, Resolve resolve, const Parameters& parameters);

/// Whether who is at its stop line may wait further on, up to the ground shared: the gap needed is shorter by
/// what is driven already. But drivers with the right of way brake for a nose in the junction, and stand in
/// our way then: only who has waited for 20 s creeps (TERM-014).
[[nodiscard]] bool waits_beyond_line(const Scene& scene, float line_s_m, float start_s_m);

/// Whether, at every zone of `path` that it may reach, the vehicle owes us the way or is already braking to a
/// stop before it, and can still do so. False when its way meets ours nowhere.
[[nodiscard]] bool will_yield(const EgoPath& path, const Agent& agent);

}  // namespace s4tp
