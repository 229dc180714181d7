#include "algo/behavior/manoeuvres.hpp"

namespace s4tp::behavior {
namespace {

int side_of(scene::Manoeuvre manoeuvre) {
  if (manoeuvre == scene::Manoeuvre::kKeep) return 0;
  return manoeuvre == scene::Manoeuvre::kLeft ? 1 : -1;
}

void advance_lane_change(int side, const scene::Scene& scene, std::uint32_t now_ms,
                         const Parameters& parameters, ManoeuvreState& state) {
  const LaneChange next = next_state(kLaneChangeTable, state.lane_change,
                                     lane_change_situation(state, side, scene, now_ms, parameters));
  const bool leads = next == LaneChange::kPrepare || next == LaneChange::kCrossing;
  const bool turns = leads && side != state.side;
  if (next != state.lane_change || turns) state.lane_change_ms = now_ms;
  state.lane_change = next;
  if (leads) state.side = static_cast<std::int8_t>(side);
  if (next == LaneChange::kKeep) state.side = 0;
}

void advance_zone_claim(const PlanTaken& plan, const scene::Scene& scene, std::uint32_t now_ms,
                        const Parameters& parameters, ManoeuvreState& state) {
  const ZoneClaim next = next_state(kZoneClaimTable, state.zone_claim,
                                    zone_claim_situation(state, plan, scene, now_ms, parameters));
  if (next == state.zone_claim) return;
  state.zone_claim = next;
  state.zone_claim_ms = now_ms;
  const bool claims = next == ZoneClaim::kClaimed || next == ZoneClaim::kCommitted;
  if (claims) state.zone_lane = claimed_lane(plan, scene);
}

}  // namespace

ManoeuvreState advance(const ManoeuvreState& in_force, const PlanTaken& plan, const scene::Scene& scene,
                       std::uint32_t now_ms, const Parameters& parameters) {
  ManoeuvreState state = in_force;
  advance_lane_change(side_of(scene.ego_paths[plan.path].manoeuvre), scene, now_ms, parameters, state);
  const RequiredChange required =
      next_state(kRequiredChangeTable, state.required_change, required_change_situation(scene, parameters));
  if (required != state.required_change) state.required_change_ms = now_ms;
  state.required_change = required;
  advance_zone_claim(plan, scene, now_ms, parameters, state);
  return state;
}

}  // namespace s4tp::behavior
