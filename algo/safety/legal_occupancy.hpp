#pragma once
/// Legal occupancy (method.md 4.9): when a vehicle that keeps to the law can be on ground we share with it.
/// Knows tracks and map; never predictions, beliefs or manoeuvres.
/// LEGAL-001 A vehicle is in a zone from when it can be there at the earliest, bends counted, until it has
/// left at the latest, its own length counted; who gains speed faster than the law lets it may go on doing so.
/// LEGAL-002 D1: who owes us the way stops before the zone if the duty's braking does it; its response runs
/// once. LEGAL-003 L1: who has priority and gains no speed stays out if it can stop gently from as fast as it
/// may be. LEGAL-004 L2: so does who stands before the zone and has seen us stand; in one
/// that is crossed once all have stood for 2 s; where lanes merge, never.
/// LEGAL-006 Who is in a lane beside our way owes us nothing there, and leaves nothing to us, but for who stands short
/// of it once all have stood for 2 s.
/// LEGAL-005 Whoever is not seen any more can be all that the law allows from its last sight on.
///
/// \code
///   may come        [from ......................... until)    until: only when it cannot stop before
///   owes us (D1)    stops before the zone: never there
///   licensed (L1)   driving as fast as it may, it can still stop gently: never there
///   licensed (L2)   stands in sight of us, who stand, too: never there before it sets off
/// \endcode

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/occupancy/lane_reach.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::safety {

/// Why a vehicle is, or is not, expected in a zone.
enum class Claim : std::uint8_t {
  kNone = 0,  ///< no legal way of its leads there, or it has left
  kMayCome,   ///< with priority, or too near to give way
  kOwes,      ///< D1: it stops before the zone
  kCanStop,   ///< L1: it has priority, and can stop gently from as fast as it may be
  kStands,    ///< L2: it has priority, stands, and has seen us stand
};

/// One vehicle at one zone; times from plan start.
struct ZoneOccupancy {
  Claim claim = Claim::kNone;
  float from_s = occupancy::kNeverS;   ///< earliest time it can be in the zone; <= 0: is in it
  float until_s = occupancy::kNeverS;  ///< when it is certain to have left
  float to_entry_m = 0.0F;             ///< at the scene's time, of its box for a usual car's zone
  float to_exit_m = 0.0F;
  bool can_stop = false;  ///< D2: before it, for whoever is there by right
};

/// Its speed when it was last seen: from then on the law alone bounds where a vehicle can be.
[[nodiscard]] float seen_mps(const scene::Agent& agent);

/// Speed, gain and top speed of a vehicle that drives as fast as the law lets it to the zone's lane.
[[nodiscard]] occupancy::Pace fastest_legal(const scene::Scene& scene, const scene::Agent& agent,
                                            const scene::ConflictZone& zone, const Parameters& parameters);

/// The same for one that was last seen at `speed_mps` on `lane`, or on none.
[[nodiscard]] occupancy::Pace fastest_legal(const scene::Scene& scene, LaneIndex lane, float speed_mps,
                                            const scene::ConflictZone& zone, const Parameters& parameters);

/// \param reach  measured for the agent
/// \param lead_s  plan start after the scene's time
[[nodiscard]] ZoneOccupancy zone_occupancy(const scene::Scene& scene, const scene::Agent& agent,
                                           const occupancy::LaneReach& reach, const scene::ConflictZone& zone,
                                           float lead_s, const Parameters& parameters);

}  // namespace s4tp::safety
