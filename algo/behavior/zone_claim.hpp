#pragma once
/// The way through a group of conflict zones: who goes first is decided once, and given up only for a reason. Its transitions
/// stand in one table (zone_claim.cpp).
///
/// \code
///   considered ----> claimed ----> committed ----> cleared ----> considered
///        ^              |   ^           |
///        |              v   +-----------+  the fail-safe stops before it again
///        +--------- withdrawn <---------+  and the plan stays out
/// \endcode

#include "algo/behavior/transition.hpp"
#include "algo/core/manoeuvre.hpp"
#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::behavior {

/// What its transitions are decided by.
struct ZoneClaimSituation {
  bool leads_in = false;  ///< the plan taken enters the next group within its horizon
  bool passes = false;    ///< its fail-safe passes a group
  bool passed = false;    ///< the group claimed does not lie ahead any more
  bool overdue = false;   ///< a horizon after it was claimed the plan still only leads there
};

inline constexpr int kZoneClaimRows = 14;
extern const Transition<ZoneClaim, ZoneClaimSituation> kZoneClaimTable[kZoneClaimRows];

/// What is known of the plan taken.
struct PlanTaken {
  int path = 0;  ///< of Scene::ego_paths, which it follows
  const Trajectory* trajectory = nullptr;
  bool passes_group = false;  ///< its fail-safe does ...
  int passed_zones = 0;       ///< ... so many zones of the path
};

[[nodiscard]] ZoneClaimSituation zone_claim_situation(const ManoeuvreState& state, const PlanTaken& plan,
                                                      const scene::Scene& scene,
                                                      const Parameters& parameters);

/// The lane crossed last in the group that the plan leads into or its fail-safe passes. \pre there is one ahead
[[nodiscard]] int claimed_lane(const PlanTaken& plan, const scene::Scene& scene);

}  // namespace s4tp::behavior
