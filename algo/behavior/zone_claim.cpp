#include "algo/behavior/zone_claim.hpp"

namespace s4tp::behavior {
namespace {

using Situation = ZoneClaimSituation;

/// A plan that leads in has entered by the end of its horizon, or made no progress.
constexpr std::uint16_t kClaimMs = kHorizonSteps * kStepMs;

bool passes(const Situation& s) {
  return s.passes;
}
bool leads_in(const Situation& s) {
  return s.leads_in;
}
bool passed(const Situation& s) {
  return s.passed;
}
bool stays_out(const Situation& s) {
  return !s.leads_in;
}
bool given_up(const Situation& s) {
  return !s.leads_in || s.overdue;
}
bool stops_before(const Situation& s) {
  return !s.passes && s.leads_in;
}
bool falls_back(const Situation& s) {
  return !s.passes;
}

}  // namespace

const Transition<ZoneClaim, Situation> kZoneClaimTable[kZoneClaimRows] = {
    {ZoneClaim::kConsidered, passes, ZoneClaim::kCommitted},
    {ZoneClaim::kConsidered, leads_in, ZoneClaim::kClaimed},
    {ZoneClaim::kClaimed, passes, ZoneClaim::kCommitted},
    {ZoneClaim::kClaimed, passed, ZoneClaim::kConsidered},
    {ZoneClaim::kClaimed, given_up, ZoneClaim::kWithdrawn},
    {ZoneClaim::kCommitted, passed, ZoneClaim::kCleared},
    {ZoneClaim::kCommitted, stops_before, ZoneClaim::kClaimed},
    {ZoneClaim::kCommitted, falls_back, ZoneClaim::kWithdrawn},
    {ZoneClaim::kCleared, passes, ZoneClaim::kCommitted},
    {ZoneClaim::kCleared, leads_in, ZoneClaim::kClaimed},
    {ZoneClaim::kCleared, stays_out, ZoneClaim::kConsidered},
    {ZoneClaim::kWithdrawn, passes, ZoneClaim::kCommitted},
    {ZoneClaim::kWithdrawn, passed, ZoneClaim::kConsidered},
    {ZoneClaim::kWithdrawn, stays_out, ZoneClaim::kConsidered},
};

ZoneClaimSituation zone_claim_situation(const ManoeuvreState& state, const PlanTaken& plan,
                                        const scene::Scene& scene, const Parameters& parameters) {
  const scene::EgoPath& path = scene.ego_paths[plan.path];
  float reached_s_m =
      path.frenet.s_m + 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
  for (int i = 1; i < kTrajectoryPoints; ++i)
    reached_s_m = reached_s_m + kStepS * plan.trajectory->points[i].speed_mps;
  ZoneClaimSituation situation;
  situation.passes = plan.passes_group && !path.zones.empty();
  situation.leads_in = !path.zones.empty() && reached_s_m > path.zones[0].entry_s_m;
  situation.passed = true;
  for (const scene::ConflictZone& zone : path.zones) {
    if (zone.other_lane == state.zone_lane) situation.passed = false;
  }
  situation.overdue = state.zone_claim_ms >= kClaimMs;
  return situation;
}

int claimed_lane(const PlanTaken& plan, const scene::Scene& scene) {
  const auto& zones = scene.ego_paths[plan.path].zones;
  const bool known = plan.passes_group && plan.passed_zones > 0 && plan.passed_zones <= zones.size();
  return zones[known ? plan.passed_zones - 1 : 0].other_lane;
}

}  // namespace s4tp::behavior
