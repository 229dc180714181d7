#include "sim_host/baselines/idm_lane.hpp"

#include <algorithm>
#include <cmath>

#include "algo/occupancy/pace.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/path_walk.hpp"
#include "algo/trajectory/roll_out.hpp"
#include "algo/trajectory/speed_profile.hpp"
#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

using occupancy::kNeverS;

const RegisterPlanner kRegistered{
    planner<IdmLanePlanner>("idm_lane", "a plain driver: IDM, gap acceptance, needed lane changes")};

constexpr float kFarM = 1e6F;
constexpr std::uint8_t kNobody = 255;
constexpr float kClearM = 0.7F;             // of a zone we wait before
constexpr float kRoadEndM = 1.0F;           // of the road's end
constexpr float kChangeRoomM = 20.0F;       // for a lane change from rest
constexpr float kPressingM = 30.0F;         // so near to where a change must be made, more is asked of others
constexpr float kOvertakingRoomM = 100.0F;  // before that point: enough to overtake and come back
constexpr float kReturnM = 60.0F;           // for each change due, where even a slower lane is gone back to
constexpr float kAdjustMps2 = -2.0F;        // braking to fall in behind somebody beside us
constexpr float kLookS = 20.0F;             // how far ahead in time zones are judged
constexpr float kLookStepS = 0.2F;
constexpr float kStandingMps = 0.5F;   // who stands before a zone is not coming
constexpr float kUnlikely = 0.15F;     // ways of others less likely than this are ignored: they signal
constexpr float kStartingMps2 = 1.5F;  // who is slow may be gaining speed
constexpr float kUsualHalfLengthM = 2.5F;
constexpr int kStretches = 4;
constexpr float kStretch = 1.7F;

const scene::EgoPath* path_with(const scene::Scene& scene, scene::Manoeuvre manoeuvre) {
  for (const scene::EgoPath& path : scene.ego_paths) {
    if (path.manoeuvre == manoeuvre) return &path;
  }
  return nullptr;
}

/// The change the route needs from the lane of `path`.
scene::Manoeuvre needed_change(const scene::EgoPath& path) {
  if (path.changes_needed == 0) return scene::Manoeuvre::kKeep;
  return path.changes_needed > 0 ? scene::Manoeuvre::kLeft : scene::Manoeuvre::kRight;
}

}  // namespace

Status IdmLanePlanner::init(const Parameters& parameters) {
  int first_bad = 0;
  parameters_ = parameters;
  scene_builder_.reset();
  changing_ = scene::Manoeuvre::kKeep;
  going_ = false;
  return validate(parameters, first_bad);
}

Status IdmLanePlanner::plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation) {
  explanation = planner::Explanation{};
  const Plan running = input.running != nullptr ? *input.running : Plan{};
  start_ = trajectory::plan_start(input.ego, input.now_ms, running, input.start_ms, parameters_);
  plan.start_ms = input.start_ms;
  plan.kind = PlanKind::kDrive;
  const Status status = scene_builder_.build(input.now_ms, input.ego, input.tracks, input.tracks_ms,
                                             input.map, parameters_, scene_);
  explanation.status = status;
  if (status != Status::kOk) {  // it knows no way: it brakes
    plan.trajectory.points[0] = start_;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      plan.trajectory.points[i] = trajectory::bicycle_step(plan.trajectory.points[i - 1],
                                                           -parameters_.comfort.braking_mps2, 0.0F, kStepS);
    }
    return status;
  }
  const scene::EgoPath& path = choose_path();
  look_ahead(path, 1e-3F * static_cast<float>(input.start_ms - input.now_ms));
  stop_s_m_ = std::min(stop_s_m_, stop_for_zones(path, explanation));
  drive(plan.trajectory);
  return Status::kOk;
}

float IdmLanePlanner::prospect_mps2(const scene::EgoPath& path, const trajectory::Leader& ahead) const {
  const float limit_mps = scene::path_point(*scene_.map, path.path, path.frenet.s_m).speed_limit_mps;
  const float free_mps2 = idm_free(driver, start_.speed_mps, limit_mps);
  if (ahead.agent < 0) return free_mps2;
  return std::min(free_mps2, idm_behind(driver, start_.speed_mps, ahead.gap_m, ahead.speed_mps));
}

const scene::EgoPath& IdmLanePlanner::choose_path() {
  const scene::EgoPath& keep = scene_.ego_paths[0];
  const scene::Manoeuvre under_way = changing_;
  changing_ = scene::Manoeuvre::kKeep;
  const scene::Manoeuvre needed = needed_change(keep);
  const float here_mps2 =
      prospect_mps2(keep, trajectory::find_leader(scene_, keep, keep.frenet.s_m, parameters_));
  for (const scene::EgoPath& path : scene_.ego_paths) {
    if (path.manoeuvre == scene::Manoeuvre::kKeep) continue;
    const bool towards_route = path.manoeuvre == needed;
    const bool going_on = path.manoeuvre == under_way;
    if (!towards_route && !going_on && change_room_s_m(path) - path.frenet.s_m < kOvertakingRoomM) continue;
    IdmDriver mood = driver;
    const float room_m = change_room_s_m(keep) - keep.frenet.s_m;
    if (going_on || (towards_route && room_m < kPressingM))
      mood.asked_braking_mps2 = driver.pressed_braking_mps2;
    const trajectory::Leader ahead = trajectory::find_leader(scene_, path, path.frenet.s_m, parameters_);
    const trajectory::Leader behind = trajectory::find_follower(scene_, path, path.frenet.s_m, parameters_);
    if (!change_accepted(mood, start_.speed_mps, ahead, behind)) continue;
    const float gain_mps2 = prospect_mps2(path, ahead) - here_mps2;
    const float return_m = kReturnM * static_cast<float>(std::abs(keep.changes_needed));
    const bool worth_it = towards_route ? room_m < return_m || gain_mps2 > -driver.change_gain_mps2
                                        : gain_mps2 > driver.change_gain_mps2;
    if (!worth_it && !going_on) continue;
    changing_ = path.manoeuvre;
    return path;
  }
  return keep;
}

float IdmLanePlanner::change_room_s_m(const scene::EgoPath& path) const {
  if (path.changes_needed == 0) return kFarM;
  const float front_m = trajectory::rear_axle_to_front_m(parameters_);
  const float changes = static_cast<float>(std::abs(path.changes_needed));
  const scene::EgoPath* next =
      path.manoeuvre == scene::Manoeuvre::kKeep ? path_with(scene_, needed_change(path)) : nullptr;
  if (next == nullptr) return path.route_end_s_m - front_m - kChangeRoomM * changes;
  // The lane may end where the next one goes on: then only this change is due there.
  const float next_end_s_m = next->route_end_s_m - next->frenet.s_m + path.frenet.s_m;
  return std::min(path.route_end_s_m - kChangeRoomM, next_end_s_m - kChangeRoomM * changes) - front_m;
}

void IdmLanePlanner::look_ahead(const scene::EgoPath& path, float lead_s) {
  const float guess_s_m = path.frenet.s_m + lead_s * scene_.ego.speed_mps;
  const scene::Frenet frenet =
      scene::project(*scene_.map, path.path, position(start_.rear_axle), guess_s_m, 10.0F);
  trajectory::build_reference(*scene_.map, path.path, frenet.s_m, start_.speed_mps, parameters_, line_);
  where_ = trajectory::locate_on(line_, position(start_.rear_axle), frenet.s_m);

  leaders_.clear();
  const auto add_leader = [&](const scene::EgoPath& of, float least_mps2) {
    const trajectory::Leader leader = trajectory::find_leader(scene_, of, of.frenet.s_m, parameters_);
    if (leader.agent < 0) return;
    const float touch_s_m = path.frenet.s_m + leader.gap_m + lead_s * leader.speed_mps;
    (void)leaders_.push({touch_s_m, leader.speed_mps, least_mps2});
  };
  add_leader(path, -parameters_.vehicle.braking_max_mps2);
  const scene::EgoPath& keep = scene_.ego_paths[0];
  if (&path != &keep) add_leader(keep, -driver.pressed_braking_mps2);  // not left yet
  const scene::Manoeuvre next = needed_change(path);
  const scene::EgoPath* beside =
      &path == &keep && next != scene::Manoeuvre::kKeep ? path_with(scene_, next) : nullptr;
  if (beside != nullptr) add_leader(*beside, kAdjustMps2);

  const float front_m = trajectory::rear_axle_to_front_m(parameters_);
  const float end_s_m = trajectory::dead_end_s_m(scene_, path);
  stop_s_m_ = end_s_m < trajectory::kNoDeadEndM ? end_s_m - front_m - kRoadEndM : kFarM;
  if (path.changes_needed != 0)
    stop_s_m_ = std::min(stop_s_m_ - trajectory::change_room_m(scene_, path), change_room_s_m(path));
}

float IdmLanePlanner::wanted_mps2(float time_s, float s_m, float speed_mps) const {
  float wanted = idm_free(driver, speed_mps, trajectory::reference_at(line_, s_m).speed_cap_mps);
  for (const Ahead& leader : leaders_) {
    const float gap_m = leader.touch_s_m + leader.speed_mps * time_s - s_m;
    wanted =
        std::min(wanted, std::max(leader.least_mps2, idm_behind(driver, speed_mps, gap_m, leader.speed_mps)));
  }
  // A stop is a standing leader whose standstill gap ends at it.
  if (stop_s_m_ < kFarM)
    wanted = std::min(wanted, idm_behind(driver, speed_mps, stop_s_m_ - s_m + driver.standstill_gap_m, 0.0F));
  return wanted;
}

float IdmLanePlanner::stop_for_zones(const scene::EgoPath& path, planner::Explanation& explanation) {
  // Our motion if every gap were accepted.
  constexpr int kSteps = static_cast<int>(kLookS / kLookStepS);
  float s_m[kSteps + 1] = {where_.s_m};
  float speed_mps = start_.speed_mps;
  for (int i = 0; i < kSteps; ++i) {
    const float wanted = std::max(wanted_mps2(kLookStepS * static_cast<float>(i), s_m[i], speed_mps),
                                  -parameters_.vehicle.braking_max_mps2);
    const float next_mps = std::max(0.0F, speed_mps + kLookStepS * wanted);
    s_m[i + 1] = s_m[i] + 0.5F * kLookStepS * (speed_mps + next_mps);
    speed_mps = next_mps;
  }
  const auto time_at = [&](float goal_s_m) {
    for (int i = 1; i <= kSteps; ++i) {
      if (s_m[i] < goal_s_m) continue;
      const float part = (goal_s_m - s_m[i - 1]) / std::max(s_m[i] - s_m[i - 1], 1e-3F);
      return kLookStepS * (static_cast<float>(i - 1) + std::max(part, 0.0F));
    }
    return kNeverS;
  };

  const float centre_m = trajectory::rear_axle_to_centre_m(parameters_);
  const float front_m = trajectory::rear_axle_to_front_m(parameters_);
  const float margin_s = going_ ? driver.going_margin_s : driver.gap_margin_s;
  going_ = false;
  float free_until_s_m =
      kFarM;                // we can wait before this: where the first of the zones not yet entered begins
  float left_s_m = -kFarM;  // and then not before this: where the last of those passed so far ends
  for (const scene::ConflictZone& zone : path.zones) {
    const float entry_s_m = zone.entry_s_m - centre_m;
    const float exit_s_m = zone.exit_s_m - centre_m;
    if (where_.s_m >= exit_s_m) continue;
    if (where_.s_m > entry_s_m) {
      going_ = true;
      continue;
    }
    float wait_s_m = entry_s_m - kClearM;
    if (zone.stop_s_m - front_m >= where_.s_m - kClearM)
      wait_s_m = std::min(wait_s_m, zone.stop_s_m - front_m);
    if (wait_s_m > left_s_m) free_until_s_m = wait_s_m;  // between zones there is room
    left_s_m = std::max(left_s_m, exit_s_m);
    const float in_s = time_at(entry_s_m);
    if (in_s >= kLookS) break;
    if (refuses(zone, in_s, time_at(exit_s_m), margin_s, explanation)) {
      const float room_m = std::max(free_until_s_m - where_.s_m, 0.1F);
      const bool committed = start_.speed_mps * start_.speed_mps > 2.0F * driver.committed_mps2 * room_m;
      if (!committed) {
        going_ = false;
        return std::max(free_until_s_m, where_.s_m);
      }
    }
    if (zone.priority != Priority::kFirstHasPriority) going_ = true;
  }
  return kFarM;
}

bool IdmLanePlanner::refuses(const scene::ConflictZone& zone, float in_s, float out_s, float margin_s,
                             planner::Explanation& explanation) const {
  explanation.blocking.verdict.cause = safety::Cause::kNoRoom;
  explanation.blocking.verdict.agent = kNobody;
  explanation.blocking.way_m = kFarM;
  explanation.blocking.track = kNobody;
  if (out_s >= kNeverS) return true;  // no room behind it: the junction is kept clear
  explanation.blocking.verdict.cause = safety::Cause::kZone;
  for (int i = 0; i < scene_.agents.size(); ++i) {
    const scene::Agent& agent = scene_.agents[i];
    explanation.blocking.verdict.agent = static_cast<std::uint8_t>(i);
    explanation.blocking.track = agent.track.id;
    const float speed_mps = agent.track.speed_mps;
    const float longer_m = 0.5F * agent.track.length_m - kUsualHalfLengthM;
    for (int k = 0; k < agent.paths.size(); ++k) {
      if (agent.path_probability[k] < kUnlikely) continue;
      for (const scene::PathLane& part : agent.paths[k].lanes) {
        if (part.lane != zone.other_lane) continue;
        const float along_m = agent.frenet[k].s_m - part.start_s_m;
        const float to_entry_m = zone.other_entry_m - longer_m - along_m;
        const float to_exit_m = zone.other_exit_m + longer_m - along_m;
        if (to_exit_m <= 0.0F || (to_entry_m > 0.0F && speed_mps < kStandingMps)) continue;
        Crosser crosser;
        crosser.priority = zone.priority;
        const float limit_mps = scene_.map->lanes[zone.other_lane].speed_limit_mps;
        crosser.arrives_s =
            occupancy::time_to_cover_s({speed_mps, kStartingMps2, 0.5F * limit_mps}, to_entry_m);
        crosser.gone_s = to_exit_m / std::max(speed_mps, 1.0F);
        crosser.can_stop =
            speed_mps * speed_mps < 2.0F * driver.pressed_braking_mps2 * std::max(to_entry_m, 0.0F);
        if (!gap_accepted(crosser, in_s, out_s, margin_s)) return true;
      }
    }
  }
  explanation.blocking = planner::BlockingReason{};
  return false;
}

void IdmLanePlanner::drive(Trajectory& trajectory) const {
  // The path is that of a car which accelerates as hard as it can: longer than ours.
  trajectory::Candidate fast;
  fast.intent = trajectory::Intent::kAccelerate;
  fast.acceleration_mps2 = parameters_.vehicle.acceleration_max_mps2;
  float length_m = trajectory::lateral_length_m(line_, start_, where_, parameters_);
  const Plan none;
  Trajectory path;
  for (int attempt = 0; attempt < kStretches; ++attempt, length_m *= kStretch) {
    trajectory::shape_lateral(line_, start_, where_, length_m, fast);
    trajectory::roll_out(line_, fast, start_, none, 0, parameters_, path);
    trajectory::PathWalk walk(path);
    trajectory::LongitudinalState state{where_.s_m, start_.speed_mps, start_.acceleration_mps2};
    float way_m = 0.0F;
    trajectory.points[0] = start_;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      const float time_s = kStepS * static_cast<float>(i - 1);
      trajectory::Candidate ours = fast;
      ours.acceleration_mps2 = wanted_mps2(time_s, state.s_m, state.speed_mps);
      const float step_m = trajectory::advance(
          trajectory::wanted_acceleration(line_, ours, state, time_s, parameters_), parameters_, state);
      TrajectoryPoint& point = trajectory.points[i];
      point = trajectory.points[i - 1];
      if (step_m > 0.0F) {
        way_m += step_m;
        state.s_m += step_m;
        walk.place(way_m, point);
      }
      point.speed_mps = state.speed_mps;
      point.acceleration_mps2 = state.acceleration_mps2;
    }
    if (trajectory::feasible(trajectory, parameters_)) return;
  }
}

}  // namespace s4tp::baselines
