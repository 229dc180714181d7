// What the guard sees of a scene before it judges plans: leader, followers, groups of zones, who may be in them.
#include <new>

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/safety/change_gaps.hpp"
#include "algo/safety/guard.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::safety {
namespace {

using occupancy::kNeverS;

constexpr float kWaitingRoomM = 1.0F;  // between two zones there is room to stand, clear of both
constexpr float kClearOfZoneM = 0.7F;  // before it
constexpr float kInStripM = 0.1F;      // so far our box may reach beyond the path's strip and still follow it
constexpr float kSwingM = 0.7F;        // room for that beside our box: a turn back swings out
constexpr float kSoonM = 10.0F;        // further than where we can stand, a plan may yet bring us
constexpr float kCurvesMps2 = 3.0F;
constexpr float kSeekM = 15.0F;  // each way of where we are along a path
constexpr int kCapSamples = 4;

// Work (WorkMeter's units).
constexpr int kMostWork = 15'000;  // beyond, the next path is not looked at any more
constexpr int kLookWork = 10;
constexpr int kPathWork = 20;
constexpr int kGroupWork = 50;
constexpr int kBehindWork = 30;  // what room somebody lacks
constexpr int kThreatWork = 5;   // whether a vehicle may be in a zone

}  // namespace

int Guard::look(const scene::Scene& scene, const TrajectoryPoint& start, float lead_s,
                const Parameters& parameters) {
  scene_ = &scene;
  parameters_ = &parameters;
  start_ = start;
  lead_s_ = lead_s;
  looked_ = false;
  // A licence is used by going: who has come to a stand asks anew.
  if (start.speed_mps < kStandingMps) {
    latched_.clear();
    free_ms_ = scene.time_ms;
  }
  centre_m_ = trajectory::rear_axle_to_centre_m(parameters);
  front_m_ = trajectory::rear_axle_to_front_m(parameters);
  const float driven_m =
      lead_s * max(0.0F, scene.ego.speed_mps + 0.5F * scene.ego.acceleration_mps2 * lead_s);
  ahead_m_ = max(0.0F, to_local(start.rear_axle, position(shift_ahead(scene.ego.rear_axle, driven_m))).x_m);
  work_ = kLookWork;
  if (scene.map == nullptr) return work_;
  occupancy::LaneReach reach[kMaxTracks];
  for (int i = 0; i < scene.agents.size(); ++i) work_ += reach[i].measure(*scene.map, scene.agents[i]);
  follow_change();
  for (int path = 0; path < scene.ego_paths.size(); ++path) {
    if (work_ > kMostWork) return work_;
    look_at_path(path);
    find_threats(scene.ego_paths[path], reach, contexts_[path]);
  }
  if (scene.known.left_out > 0) look_beyond(reach);
  looked_ = true;
  return work_;
}

void Guard::keep_nearest(InLaneList& list, const InLane& other, float own_s_m) {
  if (list.push(other)) return;
  const auto away_m = [&](const InLane& one) { return abs(one.bumper_s_m - own_s_m); };
  int furthest = 0;
  for (int k = 1; k < list.size(); ++k) {
    if (away_m(list[k]) > away_m(list[furthest])) furthest = k;
  }
  if (away_m(other) < away_m(list[furthest])) list[furthest] = other;
}

float Guard::Passing::least_s_m(float time_s) const {
  return stop_s_m - occupancy::stopping_way_m(max(0.0F, speed_mps - braking_mps2 * time_s), braking_mps2);
}

void Guard::find_swing(const scene::EgoPath& path, PathContext& context) {
  const Point front = position(shift_ahead(scene_->ego.rear_axle, front_m_));
  const float front_d_m =
      scene::project(*scene_->map, path.path, front, path.frenet.s_m + front_m_, kSeekM, work_).d_m;
  context.swing_right_m = min(path.lateral_offset_m, min(path.frenet.d_m, front_d_m));
  context.swing_left_m = max(path.lateral_offset_m, max(path.frenet.d_m, front_d_m));
}

bool Guard::is_on_way_over(const scene::EgoPath& path, const PathContext& context, int agent,
                           trajectory::OnPath& seen) {
  if (context.swing_left_m - context.swing_right_m < kInStripM) return false;
  bool known = false;
  seen = trajectory::see_on_path(*scene_, path, scene_->agents[agent], *parameters_, true, known);
  work_ += seen.work;
  const float room_m = 0.5F * parameters_->vehicle.width_m + seen.half_width_m + kSwingM;
  return known && !seen.overlaps && !seen.crossing && seen.centre_d_m > context.swing_right_m - room_m &&
         seen.centre_d_m < context.swing_left_m + room_m;
}

float Guard::changing_s() const {
  return 1e-3F * static_cast<float>(static_cast<std::int32_t>(scene_->time_ms - change_.since_ms)) + lead_s_;
}

void Guard::follow_change() {
  if (changing_s() > occupancy::kSettleS || scene_->ego_paths.empty()) change_.side = 0.0F;
  if (change_.side == 0.0F) return;
  const scene::EgoPath& own = scene_->ego_paths[0];
  // In the lane it leads to we are short of the centre, in the one it leaves beyond it.
  const float beyond_m = change_.side * own.frenet.d_m;
  const float most_m =
      scene::kBesideShare * scene::path_point(*scene_->map, own.path, own.frenet.s_m).width_m;
  const bool comes_over = !change_.over && beyond_m < -most_m;
  if (comes_over) change_.since_ms = scene_->time_ms;
  change_.over = comes_over || (change_.over && beyond_m < most_m);
}

void Guard::look_at_path(int path_index) {
  const scene::EgoPath& path = scene_->ego_paths[path_index];
  PathContext& context = contexts_[path_index];
  new (&context) PathContext;  // assigned, it would be made on the stack first
  const scene::Frenet start =
      scene::project(*scene_->map, path.path, position(start_.rear_axle), path.frenet.s_m, kSeekM, work_);
  context.start_s_m = start.s_m + max(0.0F, ahead_m_ - parameters_->guard.margin_m);
  const float turned = abs(sin(wrap_angle(start_.rear_axle.heading_rad - start.heading_rad)));
  context.front_m = front_m_ - centre_m_ + 0.5F * turned * parameters_->vehicle.width_m;
  context.stop_s_m = context.start_s_m + centre_m_ + parameters_->guard.takeover_s * start_.speed_mps +
                     occupancy::stopping_way_m(start_.speed_mps, parameters_->guard.braking_mps2);
  context.end_s_m = trajectory::dead_end_s_m(*scene_, path);
  context.leader_stop_s_m = trajectory::kNoDeadEndM;
  context.beside.stop_s_m = trajectory::kNoDeadEndM;
  const scene::PathPoint here = scene::path_point(*scene_->map, path.path, path.frenet.s_m);
  const float half_lane_m = 0.5F * here.width_m;
  context.fastest_mps = parameters_->law.over_limit * here.speed_limit_mps;
  context.changes = path.manoeuvre != scene::Manoeuvre::kKeep;
  work_ += kPathWork;
  context.half_over = abs(path.frenet.d_m) < half_lane_m;
  context.settles = !context.changes && change_.side != 0.0F;
  // In a lane we have not set out for, a list that is not fresh vouches for nobody.
  const bool sets_out = context.changes && abs(path.frenet.d_m) > 2.0F * half_lane_m - kInStripM;
  if (sets_out && scene_->known.age_ms > scene::kFreshMs) expect_beside(context);
  const float centre_s_m = path.frenet.s_m + centre_m_;
  find_swing(path, context);
  for (int i = 0; i < scene_->agents.size(); ++i) {
    const scene::Agent& agent = scene_->agents[i];
    bool known = false;
    const bool joining = trajectory::joins(*scene_, path, agent);
    const trajectory::OnPath seen =
        trajectory::see_on_path(*scene_, path, agent, *parameters_, joining, known);
    work_ += seen.work;
    trajectory::OnPath beside;
    if (is_on_way_over(path, context, i, beside)) {
      const float along_mps = max(0.0F, beside.along_mps);
      InLane other{static_cast<std::uint8_t>(i)};
      other.speed_mps = along_mps;
      other.bumper_s_m = beside.centre_s_m - beside.half_length_m - agent.coasted_m;
      // Ahead, as far as a plan may bring us before we can stand.
      if (beside.centre_s_m > centre_s_m) {
        if (other.bumper_s_m < context.stop_s_m + front_m_ + kSoonM)
          keep_nearest(context.on_way_over, other, centre_s_m);
      } else if (context.settles && !change_.over && beside.along_mps >= 0.0F) {
        // Whoever is beside us already is left by going back.
        other.bumper_s_m = beside.centre_s_m + beside.half_length_m + along_mps * lead_s_;
        if (other.bumper_s_m <
            context.start_s_m - parameters_->vehicle.rear_overhang_m - parameters_->guard.margin_m)
          keep_nearest(context.behind, other, centre_s_m);
      }
    }
    if (!known || !(seen.overlaps || joining) || seen.crossing) continue;
    const float along_mps = max(0.0F, seen.along_mps);
    if (seen.centre_s_m > centre_s_m) {
      // It may have begun to brake when it was last seen.
      const float seen_s_m = seen.centre_s_m - seen.half_length_m - agent.coasted_m;
      // Of one that stands askew beside our front it is the boxes that tell, unless they touch.
      if (seen_s_m < context.start_s_m + centre_m_ + context.front_m && seen_mps(agent) < kStandingMps &&
          separation(trajectory::ego_box(start_.rear_axle, *parameters_),
                     {agent.track.centre, agent.track.length_m, agent.track.width_m}) > 0.0F) {
        keep_nearest(context.on_way_over, {static_cast<std::uint8_t>(i), 0, seen_s_m, along_mps}, centre_s_m);
        continue;
      }
      const float last_mps = max(0.0F, along_mps - agent.coasted_mps);
      const float stop_s_m =
          seen_s_m + occupancy::stopping_way_m(last_mps, parameters_->law.braking_max_mps2);
      const float braking_mps2 = parameters_->law.braking_max_mps2;
      const Passing passing{static_cast<std::uint8_t>(i), stop_s_m,
                            max(0.0F, last_mps - braking_mps2 * lead_s_), braking_mps2};
      if (passing.least_s_m(kOverLineS) < context.beside.least_s_m(kOverLineS)) context.beside = passing;
      if (stop_s_m >= context.leader_stop_s_m) continue;
      context.leader_stop_s_m = stop_s_m;
      context.leader = static_cast<std::uint8_t>(i);
      context.leader_mps = along_mps;
    } else if ((context.changes || (context.settles && change_.over)) && seen.along_mps >= 0.0F) {
      InLane behind;
      behind.agent = static_cast<std::uint8_t>(i);
      behind.bumper_s_m = seen.centre_s_m + seen.half_length_m + along_mps * lead_s_;
      behind.speed_mps = along_mps;
      keep_nearest(context.behind, behind, centre_s_m);
    }
  }
  find_lacking(half_lane_m + 0.5F * parameters_->vehicle.width_m - abs(path.frenet.d_m), context);
  work_ += kBehindWork * context.behind.size();
  find_groups(path, context);
  work_ += kGroupWork * context.groups.size();
}

void Guard::find_groups(const scene::EgoPath& path, PathContext& context) const {
  for (int i = 0; i < path.zones.size(); ++i) {  // in the order of their entries
    const scene::ConflictZone& zone = path.zones[i];
    const bool yields = zone.priority != Priority::kFirstHasPriority;
    if (!context.groups.empty()) {
      ZoneGroup& last = context.groups[context.groups.size() - 1];
      if (zone.entry_s_m < last.exit_s_m + kWaitingRoomM) {
        last.exit_s_m = max(last.exit_s_m, zone.exit_s_m);
        last.end = static_cast<std::uint8_t>(i + 1);
        last.yields = last.yields || yields;
        continue;
      }
    }
    ZoneGroup group;
    group.entry_s_m = zone.entry_s_m;
    group.exit_s_m = zone.exit_s_m;
    group.stop_s_m = zone.entry_s_m - kClearOfZoneM;
    group.first = static_cast<std::uint8_t>(i);
    group.end = static_cast<std::uint8_t>(i + 1);
    group.yields = yields;
    (void)context.groups.push(group);  // there are no more groups than zones
  }
  for (ZoneGroup& group : context.groups) {
    group.cap_mps = kNeverS;
    for (int k = 0; k < kCapSamples; ++k) {
      const float share = static_cast<float>(k) / static_cast<float>(kCapSamples - 1);
      const scene::PathPoint there =
          scene::path_point(*scene_->map, path.path, lerp(group.entry_s_m, group.exit_s_m, share));
      const float bend_mps = sqrt(kCurvesMps2 / max(abs(there.curvature_1pm), 1e-3F));
      group.cap_mps = min(group.cap_mps, min(there.speed_limit_mps, bend_mps));
    }
  }
}

void Guard::find_threats(const scene::EgoPath& path, const occupancy::LaneReach (&reach)[kMaxTracks],
                         PathContext& context) {
  const int count = scene_->agents.size();
  work_ += kThreatWork * count * path.zones.size();
  bool merging = false;
  for (const scene::ConflictZone& zone : path.zones) merging = merging || zone.merging;
  // D3: whoever changes into the lane we merge into leaves us our distances.
  occupancy::LaneReach straight_on[kMaxTracks];
  for (int i = 0; i < count && merging; ++i)
    work_ += straight_on[i].measure(*scene_->map, scene_->agents[i], false);
  for (int z = 0; z < path.zones.size(); ++z) {
    ZoneOccupancy when[kMaxTracks];
    const auto expect = [&](int i, bool licensed) {
      const Threat threat{static_cast<std::uint8_t>(z), static_cast<std::uint8_t>(i), scene_->agents[i].lane,
                          licensed ? ThreatKind::kLicensed : ThreatKind::kTold, when[i]};
      if (!context.threats.push(threat)) context.too_many = true;
    };
    // Two who set off at once have both seen the other stand: who can still stop has not used its licence.
    // Where the first comes nobody owes anything before somebody is there.
    float used_from_s_m = path.zones[z].entry_s_m;
    for (const ZoneGroup& group : context.groups) {
      const bool in_it = z >= group.first && z < group.end;
      if (in_it && path.zones[z].priority != Priority::kFirstCome) used_from_s_m = group.entry_s_m;
    }
    const bool bound = context.stop_s_m > used_from_s_m;
    for (int i = 0; i < count; ++i) {
      const scene::Agent& agent = scene_->agents[i];
      when[i] = zone_occupancy(*scene_, agent, path.zones[z].merging ? straight_on[i] : reach[i],
                               path.zones[z], lead_s_, *parameters_);
      const bool latched = bound && when[i].to_entry_m > 0.0F &&
                           (is_latched(agent.track.id, path.zones[z].other_lane) ||
                            (when[i].can_stop && has_come_since(agent)));
      if (when[i].claim == Claim::kMayCome && latched) {
        expect(i, true);
        when[i].claim = Claim::kStands;
      }
      const bool stays_out = when[i].claim != Claim::kMayCome && when[i].claim != Claim::kNone;
      if (stays_out) context.staying_out[z] |= static_cast<std::uint16_t>(1U << i);
    }
    for (int i = 0; i < count; ++i) {
      if (when[i].claim != Claim::kMayCome || is_behind(when, i)) continue;
      expect(i, false);
    }
  }
}

bool Guard::has_come_since(const scene::Agent& agent) const {
  const auto bound_ms = static_cast<std::int32_t>(scene_->time_ms - free_ms_);
  return goes_through_ && static_cast<std::int32_t>(agent.known_ms) < bound_ms;
}

bool Guard::is_behind(const ZoneOccupancy (&when)[kMaxTracks], int index) const {
  // Nobody drives through the one ahead in its lane, who stays out.
  const LaneIndex lane = scene_->agents[index].lane;
  if (lane == kNoLaneIndex || when[index].to_entry_m <= 0.0F) return false;
  for (int i = 0; i < scene_->agents.size(); ++i) {
    const bool stays_out = when[i].claim != Claim::kMayCome && when[i].claim != Claim::kNone;
    const bool before_zone = when[i].to_entry_m > 0.0F;  // further on it leaves room for the next one
    if (stays_out && before_zone && scene_->agents[i].lane == lane &&
        when[i].to_entry_m < when[index].to_entry_m)
      return true;
  }
  return false;
}

}  // namespace s4tp::safety
