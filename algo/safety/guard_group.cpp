// Whether a plan that goes through a group of conflict zones may.
#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/safety/guard.hpp"
#include "algo/safety/guard_own.hpp"

namespace s4tp::safety {
namespace {

using occupancy::Pace;

constexpr float kRoundingS = 0.5F * kStepS;  // plans are looked at in steps
constexpr float kGoesOnM = 0.05F;            // who comes no further goes on standing
constexpr float kLateS = 0.3F;               // so much later, who has let us go still waits

}  // namespace

float Guard::half_length_m(const Threat& threat) const {
  return threat.agent == kUnseen ? scene::kUsualHalfLengthM
                                 : 0.5F * scene_->agents[threat.agent].track.length_m;
}

float Guard::to_common_end_m(const Threat& threat) const {
  return threat.when.to_exit_m - (half_length_m(threat) - scene::kUsualHalfLengthM);
}

float Guard::seen_to_common_end_m(const Threat& threat) const {
  return to_common_end_m(threat) + (threat.agent != kUnseen ? scene_->agents[threat.agent].coasted_m : 0.0F);
}

bool Guard::is_ahead(const scene::ConflictZone& zone, const Threat& threat, const Own& own) const {
  return threat.when.to_entry_m <= 0.0F && zone.exit_s_m - own.s_m[0] > to_common_end_m(threat);
}

float Guard::behind_s_m(const scene::ConflictZone& zone, const Threat& threat) const {
  const float its_mps = threat.agent != kUnseen ? seen_mps(scene_->agents[threat.agent]) : 0.0F;
  const float its_stop_s_m = zone.exit_s_m - seen_to_common_end_m(threat) +
                             occupancy::stopping_way_m(its_mps, parameters_->law.braking_max_mps2);
  return its_stop_s_m - half_length_m(threat) - 0.5F * parameters_->vehicle.length_m -
         parameters_->guard.margin_m;
}

bool Guard::passes_threat(const scene::EgoPath& path, const PathContext& context, const Threat& threat,
                          const Own& own, Verdict& verdict) const {
  const scene::ConflictZone& zone = path.zones[threat.zone];
  const ZoneOccupancy& when = threat.when;
  if (when.claim != Claim::kMayCome) return true;
  float cap_mps = 0.0F;
  for (const ZoneGroup& group : context.groups) {
    if (threat.zone >= group.first && threat.zone < group.end) cap_mps = group.cap_mps;
  }
  const float in_s = own.time_at_s(zone.entry_s_m, cap_mps);
  const float out_s = own.latest_time_at_s(zone.exit_s_m, cap_mps, parameters_->guard.braking_mps2);
  if (when.until_s < in_s) return true;  // it is certain to have left
  if (!zone.merging && when.from_s > out_s) return true;
  if (zone.merging) {
    if (is_ahead(zone, threat, own)) {
      if (own.stop_s_m(parameters_->guard.braking_mps2) <= behind_s_m(zone, threat)) return true;
    } else {
      const float half_m = 0.5F * parameters_->vehicle.length_m + half_length_m(threat);
      // Counted from the last sight.
      const bool told = threat.agent != kUnseen;
      const std::uint16_t age_ms = told ? scene_->agents[threat.agent].age_ms : scene_->known.age_ms;
      const float since_s = lead_s_ + 1e-3F * static_cast<float>(age_ms);
      const float its_to_exit_m = seen_to_common_end_m(threat);
      const float respond_s = max(in_s, 0.0F) + parameters_->law.duty_response_s;
      const Pace fastest =
          threat.agent == kUnseen
              ? fastest_legal(*scene_, threat.lane, unseen_mps(threat.lane, threat.kind), zone, *parameters_)
              : fastest_legal(*scene_, scene_->agents[threat.agent], zone, *parameters_);
      const float its_mps = occupancy::speed_after_mps(fastest, respond_s + since_s);
      const auto gap_m = [&](float time_s) {
        return its_to_exit_m - occupancy::way_after_m(fastest, time_s + since_s) -
               (zone.exit_s_m - own.place_at_m(time_s, cap_mps));
      };
      const float slower_mps = max(0.0F, its_mps - own.speed_at_mps(respond_s, cap_mps));
      // Nor may it come in beside us or before us, nor stop further on than we do once whoever leads brakes hard.
      const float apart_m = half_m + parameters_->guard.margin_m;
      const float both_in_s = max(in_s, max(when.from_s, 0.0F));
      const float duty_mps2 = parameters_->law.duty_braking_mps2;
      const float stand_s_m = context.leader_stop_s_m - context.front_m - parameters_->guard.margin_m;
      const float going_m = gap_m(respond_s);
      const float standing_m = going_m + stand_s_m - own.place_at_m(respond_s, cap_mps);
      // Before that way on is begun nobody is asked to brake hard for it.
      const bool begun = goes_through_ && context.stop_s_m > zone.entry_s_m;
      const float asked_mps2 = begun ? duty_mps2 : parameters_->comfort.braking_mps2;
      if (going_m >= apart_m + occupancy::stopping_way_m(slower_mps, asked_mps2) &&
          standing_m >= apart_m + occupancy::stopping_way_m(its_mps, duty_mps2) &&
          gap_m(both_in_s) >= apart_m)
        return true;
    }
  }
  verdict = {Cause::kZone, threat.agent, when.from_s, out_s};
  return false;
}

float Guard::time_left_s() const {
  return 1e-3F * static_cast<float>(static_cast<std::int32_t>(clear_by_ms_ - scene_->time_ms)) - lead_s_;
}

bool Guard::leaves_in_time(const ZoneGroup& group, const Own& own, float late_s) const {
  if (goes_through_ && own.time_at_s(group.exit_s_m, group.cap_mps) <= time_left_s() + late_s) return true;
  for (int i = 1; i < kTrajectoryPoints && own.s_m[i - 1] < group.exit_s_m; ++i) {
    if (own.speed_mps[i] < own.speed_mps[0]) return false;
  }
  return !goes_through_;
}

bool Guard::passes_group(const scene::EgoPath& path, const PathContext& context, const ZoneGroup& group,
                         const Own& own, Verdict& verdict) const {
  const bool inside = own.s_m[0] > group.entry_s_m;
  const bool entered = inside || (goes_through_ && context.stop_s_m > group.entry_s_m);
  const bool stands = own.end_s_m() < group.exit_s_m && own.speed_mps[kHorizonSteps] < kStandingMps;
  if (!entered && group.yields) {
    if (stands) {
      verdict = {Cause::kNoRoom};
      return false;
    }
    // Room beyond it, if whoever is ahead, or merges ahead of us, brakes hard.
    const float rear_to_front_m = front_m_ - centre_m_;
    if (context.leader_stop_s_m - rear_to_front_m - parameters_->guard.margin_m < group.exit_s_m) {
      verdict = {Cause::kNoRoom, context.leader};
      return false;
    }
    for (const Threat& threat : context.threats) {
      if (threat.zone < group.first || threat.zone >= group.end) continue;
      const scene::ConflictZone& zone = path.zones[threat.zone];
      if (!zone.merging || behind_s_m(zone, threat) >= group.exit_s_m) continue;
      const bool goes_first =
          is_ahead(zone, threat, own) || threat.when.until_s < own.time_at_s(zone.entry_s_m, group.cap_mps);
      if (!goes_first) continue;
      verdict = {Cause::kNoRoom, threat.agent};
      return false;
    }
  }
  if (inside && own.speed_mps[0] < kStandingMps && own.end_s_m() - own.s_m[0] < kGoesOnM) {
    verdict.stops_short = true;  // nothing is safer
    return true;
  }
  if (context.too_many && !inside) {
    verdict = {Cause::kZone};
    return false;
  }
  const float bound_s_m = own.nearest_stop_s_m(parameters_->vehicle.braking_max_mps2);
  for (const Threat& threat : context.threats) {
    if (threat.zone < group.first || threat.zone >= group.end) continue;
    const scene::ConflictZone& zone = path.zones[threat.zone];
    if (own.s_m[0] > zone.exit_s_m) continue;
    if (threat.kind == ThreatKind::kLicensed && (own.blocked || leaves_in_time(group, own, kLateS))) continue;
    Verdict refused = verdict;
    if (passes_threat(path, context, threat, own, refused)) continue;
    // Who cannot stay out any more leaves it as soon as it was to.
    const bool bound = bound_s_m > zone.entry_s_m;
    // Along the common way, from our centre to its.
    const float ahead_m = zone.exit_s_m - own.s_m[0] - to_common_end_m(threat);
    const float apart_m = 0.5F * parameters_->vehicle.length_m + half_length_m(threat);
    // Who stands beside one that merges lets it pass.
    const bool is_before = ahead_m <= -apart_m;
    const bool behind_it =
        zone.merging && threat.when.to_entry_m <= 0.0F && (own.speed_mps[0] >= kStandingMps || is_before);
    const bool goes_on = behind_it || own.blocked || leaves_in_time(group, own, kRoundingS);
    // One that passes us there, ahead by less than a length and faster, is let go first.
    const bool passes_us = zone.merging && threat.kind == ThreatKind::kTold && ahead_m > 0.0F &&
                           ahead_m < apart_m &&
                           seen_mps(scene_->agents[threat.agent]) > max(own.speed_mps[0], kStandingMps);
    const bool lets_it = own.stop_s_m(parameters_->guard.braking_mps2) <= own.braked_stop_s_m(*parameters_);
    if (bound && goes_on && (lets_it || !passes_us)) continue;
    // Who entered by right stops short of one that comes after all: before we were to be gone.
    const float left_s = time_left_s();
    const bool no_reason = goes_through_ && !stops_short_ && !own.blocked && !zone.merging && left_s > 0.0F &&
                           threat.when.from_s > left_s;
    // Who has let us go is not stopped before, but for whoever has not.
    const bool before_any = own.blocked || threat.kind != ThreatKind::kLicensed;
    verdict.stops_short = entered && !no_reason && stops_short(path, context, group, own, before_any);
    refused.only_we_can_stop = !bound && !threat.when.can_stop;
    if (!verdict.stops_short) verdict = refused;
    return verdict.stops_short;
  }
  return true;
}

bool Guard::stops_short(const scene::EgoPath& path, const PathContext& context, const ZoneGroup& group,
                        const Own& own, bool before_any) const {
  const float stop_s_m = own.stop_s_m(parameters_->guard.braking_mps2);
  const float bound_s_m = own.nearest_stop_s_m(parameters_->vehicle.braking_max_mps2);
  for (const Threat& threat : context.threats) {
    if (threat.zone < group.first || threat.zone >= group.end) continue;
    const scene::ConflictZone& zone = path.zones[threat.zone];
    const bool stands_there = own.s_m[0] <= zone.exit_s_m && stop_s_m > zone.entry_s_m;
    // D2 binds the others to ground we are on, or cannot stay out of; to no more.
    const bool ours = bound_s_m > zone.entry_s_m && (before_any || threat.kind != ThreatKind::kLicensed);
    if (stands_there && !(ours && threat.when.can_stop)) return false;
  }
  return true;
}

}  // namespace s4tp::safety
