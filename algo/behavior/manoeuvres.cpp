#include "algo/behavior/manoeuvres.hpp"

namespace s4tp::behavior {
namespace {

constexpr std::int32_t kLongestMs = 60'000;

int side_of(scene::Manoeuvre manoeuvre) {
  if (manoeuvre == scene::Manoeuvre::kKeep) return 0;
  return manoeuvre == scene::Manoeuvre::kLeft ? 1 : -1;
}

void pass_time(std::int32_t elapsed_ms, std::uint16_t& age_ms) {
  const std::int32_t left_ms = kLongestMs - age_ms;
  age_ms = static_cast<std::uint16_t>(elapsed_ms < left_ms ? age_ms + elapsed_ms : kLongestMs);
}

void advance_lane_change(int side, const scene::Scene& scene, const Parameters& parameters,
                         ManoeuvreState& state) {
  const LaneChange next =
      next_state(kLaneChangeTable, state.lane_change, lane_change_situation(state, side, scene, parameters));
  const bool leads = next == LaneChange::kPrepare || next == LaneChange::kCrossing;
  const bool turns = leads && side != state.side;
  if (next != state.lane_change || turns) state.lane_change_ms = 0;
  state.lane_change = next;
  if (leads) state.side = static_cast<std::int8_t>(side);
  if (next == LaneChange::kKeep) state.side = 0;
}

void advance_zone_claim(const PlanTaken& plan, const scene::Scene& scene, const Parameters& parameters,
                        ManoeuvreState& state) {
  const ZoneClaim next =
      next_state(kZoneClaimTable, state.zone_claim, zone_claim_situation(state, plan, scene, parameters));
  if (next == state.zone_claim) return;
  state.zone_claim = next;
  state.zone_claim_ms = 0;
  const bool claims = next == ZoneClaim::kClaimed || next == ZoneClaim::kCommitted;
  if (claims) state.zone_lane = static_cast<std::int16_t>(claimed_lane(plan, scene));
}

}  // namespace

void pass_time(std::int32_t elapsed_ms, ManoeuvreState& state) {
  if (elapsed_ms <= 0) return;
  pass_time(elapsed_ms, state.lane_change_ms);
  pass_time(elapsed_ms, state.required_change_ms);
  pass_time(elapsed_ms, state.zone_claim_ms);
}

void advance(const PlanTaken& plan, const scene::Scene& scene, const Parameters& parameters,
             ManoeuvreState& state) {
  advance_lane_change(side_of(scene.ego_paths[plan.path].manoeuvre), scene, parameters, state);
  const RequiredChange required =
      next_state(kRequiredChangeTable, state.required_change, required_change_situation(scene, parameters));
  if (required != state.required_change) state.required_change_ms = 0;
  state.required_change = required;
  advance_zone_claim(plan, scene, parameters, state);
}

}  // namespace s4tp::behavior
