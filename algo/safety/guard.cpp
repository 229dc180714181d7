#include "algo/safety/guard.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/safety/change_gaps.hpp"
#include "algo/safety/guard_own.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::safety {
namespace {

constexpr float kCrawlMps = 0.5F;
constexpr float kStopTubeM = 0.4F;
constexpr float kStoppingMps2 = -2.0F;
constexpr float kEndShare =
    0.5F;  // of that braking, at least, past the last place to stop before the road's end
constexpr int kWayOverStride = 2;  // points between those looked at

// Work (WorkMeter's units).
constexpr int kJudgeWork = 16;
constexpr int kGroupWork = 12;
constexpr int kThreatWork = 14;
constexpr int kFollowerWork = 115;
constexpr int kLatchWork = 2;
constexpr int kWayOverWork = 115;
constexpr int kSidewaysWork = 150;

}  // namespace

int Guard::judge_work(int path) const {
  const PathContext& context = contexts_[path];
  return kJudgeWork + kGroupWork * context.groups.size() + kThreatWork * context.threats.size() +
         kFollowerWork * context.behind.size() + kWayOverWork * context.on_way_over.size() +
         (context.changes || (context.settles && !context.behind.empty()) ? kSidewaysWork : 0);
}

int Guard::commit_work() const {
  int zones = 0;
  for (const scene::EgoPath& path : scene_->ego_paths)
    zones = path.zones.size() > zones ? path.zones.size() : zones;
  return kJudgeWork + kLatchWork * zones * scene_->agents.size();
}

bool Guard::is_latched(std::uint8_t track, LaneIndex lane) const {
  for (const Latch& latch : latched_) {
    if (latch.track == track && latch.lane == lane) return true;
  }
  return false;
}

bool Guard::is_bound(int path) const {
  if (path < 0 || path >= scene_->ego_paths.size()) return false;
  const PathContext& context = contexts_[path];
  for (const ZoneGroup& group : context.groups) {
    if (context.start_s_m + centre_m_ < group.exit_s_m) return context.stop_s_m > group.entry_s_m;
  }
  return false;
}

void Guard::commit(int path, const Verdict& verdict) {
  // Who is bound to go on keeps to the time its licences were taken for.
  if (!(goes_through_ && verdict.clears && is_bound(path))) {
    free_ms_ = scene_->time_ms;
    clear_by_ms_ = scene_->time_ms +
                   static_cast<std::uint32_t>(to_int(1e3F * (lead_s_ + verdict.clear_s), 0, 1'000'000));
  }
  goes_through_ = verdict.clears;
  stops_short_ = verdict.stops_short;
  fail_safe_ = verdict.fail_safe;
  start_ms_ = scene_->time_ms + static_cast<std::uint32_t>(to_int(1e3F * lead_s_ + 0.5F, 0, 1000));
  const scene::Manoeuvre manoeuvre = path >= 0 && path < scene_->ego_paths.size()
                                         ? scene_->ego_paths[path].manoeuvre
                                         : scene::Manoeuvre::kKeep;
  if (manoeuvre != scene::Manoeuvre::kKeep)
    change_ = {manoeuvre == scene::Manoeuvre::kLeft ? 1.0F : -1.0F, false, scene_->time_ms};
  // A licence lost before it was used is not in here any more.
  latched_.clear();
  if (!verdict.clears || path < 0 || path >= scene_->ego_paths.size()) return;
  // Groups further on are not entered yet: what holds there now need not hold then.
  const scene::EgoPath& ego_path = scene_->ego_paths[path];
  for (int z = 0; z < ego_path.zones.size() && z < verdict.cleared_end; ++z) {
    for (int i = 0; i < scene_->agents.size(); ++i) {
      const Latch latch{scene_->agents[i].track.id, ego_path.zones[z].other_lane};
      if ((contexts_[path].staying_out[z] >> i & 1U) != 0 && !is_latched(latch.track, latch.lane))
        (void)latched_.push(latch);
    }
  }
}

float Guard::way_over_ends_s_m(std::uint8_t agent_index, const Trajectory& trajectory, const Own& own) const {
  const scene::Agent& agent = scene_->agents[agent_index];
  const float stop_m =
      occupancy::stopping_way_m(seen_mps(agent), parameters_->law.braking_max_mps2) - agent.coasted_m;
  const Box there{shift_ahead(agent.track.centre, stop_m), agent.track.length_m, agent.track.width_m};
  float room_m = trajectory::kStripM;
  for (int i = 0; i < kTrajectoryPoints; i += kWayOverStride) {
    const Pose rear_axle = shift_ahead(trajectory.points[i].rear_axle, ahead_m_);
    const float gap_m = separation(trajectory::ego_box(rear_axle, *parameters_), there);
    if (i == 0) room_m = min(room_m, gap_m - kRoundingM);  // whoever is nearer already comes no nearer
    if (gap_m < room_m) return own.s_m[i - kWayOverStride];
  }
  return trajectory::kNoDeadEndM;
}

float Guard::when_s(Sideways what, const scene::EgoPath& path, const Trajectory& trajectory,
                    const Own& own) const {
  const auto& vehicle = parameters_->vehicle;
  for (int i = 0; i < kTrajectoryPoints; i += kWayOverStride) {
    const scene::PathPoint there = scene::path_point(*scene_->map, path.path, own.s_m[i]);
    const Box box = trajectory::ego_box(trajectory.points[i].rear_axle, *parameters_);
    const Point beside = position(box.centre) - position(there.pose);
    const float turned = abs(sin(wrap_angle(box.centre.heading_rad - there.pose.heading_rad)));
    const float half_m = 0.5F * (vehicle.width_m + turned * vehicle.length_m);
    const float beside_m = abs(cross(direction(there.pose.heading_rad), beside));
    const bool so = what == Sideways::kReachesIn ? beside_m - half_m < 0.5F * there.width_m
                                                 : beside_m + half_m <= 0.5F * there.width_m;
    if (so) return static_cast<float>(i) * kStepS;
  }
  return kHorizonS;
}

Verdict Guard::judge(int path_index, const Trajectory& trajectory) const {
  Verdict verdict;
  if (!looked_ || scene_->map == nullptr || path_index < 0 || path_index >= scene_->ego_paths.size()) {
    verdict.cause = Cause::kNoPath;
    return verdict;
  }
  const scene::EgoPath& path = scene_->ego_paths[path_index];
  const PathContext& context = contexts_[path_index];
  const auto& guard = parameters_->guard;
  Own own;
  own.s_m[0] = context.start_s_m + centre_m_;
  own.speed_mps[0] = trajectory.points[0].speed_mps;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    own.speed_mps[i] = trajectory.points[i].speed_mps;
    own.s_m[i] = own.s_m[i - 1] + 0.5F * (own.speed_mps[i - 1] + own.speed_mps[i]) * kStepS;
  }
  const int branch = to_int(guard.takeover_s / kStepS - 0.5F, 0, kHorizonSteps - 1);
  const float on_s = guard.takeover_s - static_cast<float>(branch) * kStepS;
  own.branch_mps = lerp(own.speed_mps[branch], own.speed_mps[branch + 1], on_s / kStepS);
  own.start_mps2 = trajectory.points[0].acceleration_mps2;
  own.branch_mps2 = lerp(trajectory.points[branch].acceleration_mps2,
                         trajectory.points[branch + 1].acceleration_mps2, on_s / kStepS);
  own.branch_s_m = own.s_m[branch] + 0.5F * on_s * (own.speed_mps[branch] + own.branch_mps);
  const float stop_s_m = own.stop_s_m(guard.braking_mps2);

  verdict.fail_safe = {guard.takeover_s, guard.braking_mps2};
  const float front_m = context.front_m;
  // Who cannot stop before the end any more brakes; at rest it stays.
  const float last_s_m = context.end_s_m - front_m;
  const float at_once_s_m = own.at_once_s_m(guard.braking_mps2);
  const bool past = at_once_s_m > last_s_m;
  if (stop_s_m > (past ? own.at_once_s_m(kEndShare * guard.braking_mps2) + kRoundingM : last_s_m)) {
    verdict.cause = Cause::kRoadEnd;
    return verdict;
  }
  // Behind a leader. The fail-safe in force stops behind whoever keeps to the law; a moving one nearer than
  // that has broken it: then it only must not get worse, and behind a slower one, or one that stands, that takes braking.
  const float coasting_s_m = at_once_s_m + own.speed_mps[0] * guard.takeover_s;
  const auto reachable_s_m = [&](float free_s_m, float its_mps) {
    if (own.nearest_stop_s_m(guard.braking_mps2) <= free_s_m) return free_s_m;
    const bool slower = its_mps < max(own.speed_mps[0], kStandingMps);
    return max(free_s_m, slower ? own.braked_stop_s_m(*parameters_) : coasting_s_m + kRoundingM);
  };
  float free_s_m = reachable_s_m(context.leader_stop_s_m - front_m - guard.margin_m, context.leader_mps);
  std::uint8_t ahead = context.leader;
  for (const InLane& other : context.on_way_over) {
    const float ends_s_m = reachable_s_m(way_over_ends_s_m(other.agent, trajectory, own), other.speed_mps);
    if (ends_s_m >= free_s_m) continue;
    free_s_m = ends_s_m;
    ahead = other.agent;
  }
  own.blocked = coasting_s_m > free_s_m;
  own.find_due(free_s_m, guard.braking_mps2);
  if (stop_s_m > free_s_m) {
    verdict = {Cause::kLeader, ahead};
    return verdict;
  }
  // While our box is in the lane of others who are not used to it.
  Between between;
  if (context.changes && !context.half_over) {
    between.from_s = when_s(Sideways::kReachesIn, path, trajectory, own);
    if (own.place_at_m(between.from_s, 0.0F) + front_m + guard.margin_m >
        context.beside.least_s_m(between.from_s)) {
      verdict = {Cause::kLeader, context.beside.agent};
      return verdict;
    }
  } else if (context.settles && change_.over) {
    between.from_s = -changing_s();
  } else if (context.settles && !context.behind.empty()) {
    between.until_s = when_s(Sideways::kIsBack, path, trajectory, own);
  }
  for (const ZoneGroup& group : context.groups) {
    if (own.s_m[0] >= group.exit_s_m) continue;
    // A stop that is being driven may use up the tube. Whoever stands nearer than that may go on standing, but
    // comes no nearer: a start that is broken off needs the room.
    const float used_m = trajectory.points[branch].acceleration_mps2 < kStoppingMps2 ? kStopTubeM : 0.0F;
    const float crawled_m = kStepS * min(own.speed_mps[0], kCrawlMps);
    // Who set off and has not used its licence yet may use up all the room before the group.
    const bool set_off = goes_through_ && context.stop_s_m <= group.entry_s_m;
    const float wait_s_m = set_off
                               ? group.entry_s_m
                               : max(group.stop_s_m + used_m, min(own.s_m[0] + crawled_m, group.entry_s_m));
    if (stop_s_m <= wait_s_m) {
      // It can still be given up, but no longer at ease: that is worth knowing.
      if (own.stop_s_m(parameters_->comfort.braking_mps2) > wait_s_m) {
        Verdict claim;
        verdict.hard = !passes_group(path, context, group, own, claim);
      }
      break;
    }
    const float clear_s = own.time_at_s(group.exit_s_m, group.cap_mps);
    if (!verdict.clears) verdict.clear_s = clear_s;
    verdict.fail_safe.branch_s = max(verdict.fail_safe.branch_s, min(clear_s, own.due_s()));
    verdict.clears = true;
    verdict.cleared_end = group.end;
    if (!passes_group(path, context, group, own, verdict)) return verdict;
    if (verdict.stops_short) break;  // the fail-safe comes no further
  }
  if (verdict.stops_short) verdict.fail_safe.branch_s = guard.takeover_s;
  if (context.changes || (context.settles && !context.behind.empty())) {
    bool brakes = false;
    for (int k = 0; k < kStopCount && !brakes; ++k) {
      const FailSafe stop = stop_after_change(k);
      const float stops_s_m =
          stop.branch_s > guard.takeover_s
              ? own.place_at_m(stop.branch_s, 0.0F) +
                    occupancy::stopping_way_m(own.speed_at_mps(stop.branch_s, 0.0F), stop.braking_mps2)
              : own.stop_s_m(stop.braking_mps2);
      if (stops_s_m > free_s_m) continue;
      brakes = followers_can_brake(context, trajectory, own, stop, between, verdict);
      if (brakes) verdict.fail_safe = {max(verdict.fail_safe.branch_s, stop.branch_s), stop.braking_mps2};
    }
    if (!brakes) {
      if (verdict.cause == Cause::kNone) verdict.cause = Cause::kFollower;
      return verdict;
    }
    verdict.cause = Cause::kNone;
    verdict.agent = 255;
  }
  return verdict;
}

}  // namespace s4tp::safety
