#include "algo/planner/c_conversion.hpp"

#include <cstdint>

#include "algo/core/math.hpp"
#include "algo/core/versions.hpp"
#include "algo/scene/lane_path.hpp"
#include "algo/trajectory/plan_limits.hpp"

namespace s4tp::planner {
namespace {

// The header's numbers are the core's.
static_assert(S4TP_API_VERSION == kApiVersion && S4TP_MAX_PARAMETERS >= kParameterCount);
static_assert(S4TP_MAX_TRACKS == kMaxTracks && S4TP_MAX_LANES == kMaxLanes &&
              S4TP_MAX_LANE_POINTS == kMaxLanePoints && S4TP_MAX_SUCCESSORS == kMaxSuccessors &&
              S4TP_MAX_CONFLICTS == kMaxConflicts && S4TP_NO_LANE_INDEX == kNoLaneIndex);
static_assert(S4TP_PLAN_POINTS == kTrajectoryPoints && S4TP_PLAN_STEP_MS == kStepMs &&
              S4TP_STAGE_COUNT == kStageCount);
static_assert(sizeof(s4tp_plan) == 28 + sizeof(float) * 6 * kTrajectoryPoints, "no padding");

template <typename Enum>
constexpr bool same(Enum core, std::uint32_t c) {
  return static_cast<std::uint32_t>(core) == c;
}
static_assert(same(Status::kOk, S4TP_OK) && same(Status::kNotInitialized, S4TP_NOT_INITIALIZED) &&
              same(Status::kInvalidParameter, S4TP_INVALID_PARAMETER) &&
              same(Status::kArithmetic, S4TP_ARITHMETIC) && same(Status::kInvalidInput, S4TP_INVALID_INPUT) &&
              same(Status::kNoLane, S4TP_NO_LANE) && same(Status::kNoSafePlan, S4TP_NO_SAFE_PLAN) &&
              same(Status::kStaleTracks, S4TP_STALE_TRACKS));
static_assert(same(LaneKind::kOurs, S4TP_LANE_OURS) && same(LaneKind::kOpposite, S4TP_LANE_OPPOSITE) &&
              same(LaneKind::kShoulder, S4TP_LANE_SHOULDER));
static_assert(same(Priority::kFirstYields, S4TP_FIRST_YIELDS) &&
              same(Priority::kFirstHasPriority, S4TP_FIRST_HAS_PRIORITY) &&
              same(Priority::kFirstCome, S4TP_FIRST_COME));
static_assert(same(PlanKind::kNone, S4TP_PLAN_NONE) && same(PlanKind::kDrive, S4TP_PLAN_DRIVE) &&
              same(PlanKind::kMinimumRisk, S4TP_PLAN_MINIMUM_RISK));
static_assert(same(LaneChange::kKeep, S4TP_LANE_CHANGE_KEEP) &&
              same(LaneChange::kPrepare, S4TP_LANE_CHANGE_PREPARE) &&
              same(LaneChange::kCrossing, S4TP_LANE_CHANGE_CROSSING) &&
              same(LaneChange::kFinish, S4TP_LANE_CHANGE_FINISH) &&
              same(LaneChange::kSettle, S4TP_LANE_CHANGE_SETTLE));
static_assert(same(RequiredChange::kNone, S4TP_REQUIRED_CHANGE_NONE) &&
              same(RequiredChange::kApproaching, S4TP_REQUIRED_CHANGE_APPROACHING) &&
              same(RequiredChange::kWaiting, S4TP_REQUIRED_CHANGE_WAITING));
static_assert(same(ZoneClaim::kConsidered, S4TP_ZONE_CLAIM_CONSIDERED) &&
              same(ZoneClaim::kClaimed, S4TP_ZONE_CLAIM_CLAIMED) &&
              same(ZoneClaim::kCommitted, S4TP_ZONE_CLAIM_COMMITTED) &&
              same(ZoneClaim::kCleared, S4TP_ZONE_CLAIM_CLEARED) &&
              same(ZoneClaim::kWithdrawn, S4TP_ZONE_CLAIM_WITHDRAWN));
static_assert(same(trajectory::Intent::kAccelerate, S4TP_INTENT_ACCELERATE) &&
              same(trajectory::Intent::kStop, S4TP_INTENT_STOP) &&
              same(trajectory::Intent::kFollow, S4TP_INTENT_FOLLOW) &&
              same(trajectory::Intent::kPrevious, S4TP_INTENT_PREVIOUS));
static_assert(same(trajectory::Rejection::kLeftOut, S4TP_REJECTION_COUNT - 1));

std::uint8_t at_most_255(std::int32_t count) {
  return static_cast<std::uint8_t>(count < 255 ? count : 255);
}

Track core_track(const s4tp_track& from) {
  Track to;
  to.id = from.id;
  to.centre = {from.x_m, from.y_m, from.heading_rad};
  to.speed_mps = from.speed_mps;
  to.acceleration_mps2 = from.acceleration_mps2;
  to.yaw_rate_radps = from.yaw_rate_radps;
  to.length_m = from.length_m;
  to.width_m = from.width_m;
  return to;
}

/// \return false when the lane is not as documented, its links not yet looked at
bool copy_lane(const s4tp_lane& from, Lane& to) {
  to = Lane{};
  if (from.present == 0) return true;
  if (from.kind > S4TP_LANE_SHOULDER || from.point_count > S4TP_MAX_LANE_POINTS) return false;
  to.present = true;
  to.kind = static_cast<LaneKind>(from.kind);
  to.in_junction = from.in_junction != 0;
  for (int i = 0; i < kMaxSuccessors; ++i) to.successors[i] = from.successors[i];
  to.left = from.left;
  to.right = from.right;
  to.changes_needed = from.changes_needed;
  to.on_route = from.on_route != 0;
  to.point_count = from.point_count;
  to.width_m = from.width_m;
  to.speed_limit_mps = from.speed_limit_mps;
  to.route_remaining_m = from.route_remaining_m;
  to.goal_distance_m = from.goal_distance_m;
  to.stop_line_m = from.stop_line_m;
  for (int i = 0; i < from.point_count; ++i) to.points[i] = {from.x_m[i], from.y_m[i]};
  if (!scene::usable(to)) return false;
  to.length_m = scene::centre_line_length(to);
  return true;
}

bool present(const LaneMap& map, LaneIndex lane) {
  return lane >= 0 && lane < kMaxLanes && map.lanes[lane].present;
}

bool links_exist(const LaneMap& map, const Lane& lane) {
  const auto good = [&map](LaneIndex link) { return link == kNoLaneIndex || present(map, link); };
  for (const LaneIndex successor : lane.successors) {
    if (!good(successor)) return false;
  }
  return good(lane.left) && good(lane.right);
}

bool interval(float entry_m, float exit_m) {
  constexpr float kLongestM = 10000.0F;
  return is_finite(entry_m) && is_finite(exit_m) && -kLongestM <= entry_m && entry_m <= exit_m &&
         exit_m <= kLongestM;
}

bool copy_conflict(const s4tp_conflict& from, LaneMap& map) {
  if (!present(map, from.first) || !present(map, from.second) || from.priority > S4TP_FIRST_COME)
    return false;
  if (!interval(from.first_entry_m, from.first_exit_m)) return false;
  if (!interval(from.second_entry_m, from.second_exit_m)) return false;
  Conflict to;
  to.first = from.first;
  to.second = from.second;
  to.priority = static_cast<Priority>(from.priority);
  to.first_entry_m = from.first_entry_m;
  to.first_exit_m = from.first_exit_m;
  to.second_entry_m = from.second_entry_m;
  to.second_exit_m = from.second_exit_m;
  return map.conflicts.push(to);
}

s4tp_choice c_choice(const trajectory::Candidate& candidate, const CostBreakdown& cost) {
  s4tp_choice to = {};
  to.path = candidate.path;
  to.intent = static_cast<std::uint8_t>(candidate.intent);
  to.acceleration_mps2 = candidate.acceleration_mps2;
  to.cost_total = cost.total();
  to.cost_progress = cost.progress;
  to.cost_speed = cost.speed;
  to.cost_jerk = cost.jerk;
  to.cost_lateral = cost.lateral;
  to.cost_lane = cost.lane;
  to.cost_risk = cost.risk;
  return to;
}

}  // namespace

Parameters core_parameters(const s4tp_parameters& from) {
  Parameters to;
  for (int i = 0; i < kParameterCount; ++i) set_parameter(to, i, from.values[i]);
  return to;
}

EgoState core_ego(const s4tp_ego& from) {
  EgoState to;
  to.rear_axle = {from.x_m, from.y_m, from.heading_rad};
  to.speed_mps = from.speed_mps;
  to.acceleration_mps2 = from.acceleration_mps2;
  to.yaw_rate_radps = from.yaw_rate_radps;
  to.steering_rad = from.steering_rad;
  return to;
}

bool copy_tracks(const s4tp_tracks& from, TrackList& to) {
  if (from.count < 0 || from.count > S4TP_MAX_TRACKS || from.left_out < 0) return false;
  to.left_out = at_most_255(from.left_out);
  for (std::int32_t i = 0; i < from.count; ++i) {
    if (!to.push(core_track(from.items[i]))) return false;
  }
  return true;
}

bool copy_map(const s4tp_lane_map& from, LaneMap& to) {
  for (int i = 0; i < kMaxLanes; ++i) {
    if (!copy_lane(from.lanes[i], to.lanes[i])) return false;
  }
  for (const Lane& lane : to.lanes) {
    if (lane.present && !links_exist(to, lane)) return false;
  }
  if (from.lanes_left_out < 0) return false;
  to.lanes_left_out = at_most_255(from.lanes_left_out);
  to.conflicts.clear();
  if (from.conflict_count < 0 || from.conflict_count > S4TP_MAX_CONFLICTS) return false;
  for (std::int32_t i = 0; i < from.conflict_count; ++i) {
    if (!copy_conflict(from.conflicts[i], to)) return false;
  }
  return true;
}

bool copy_manoeuvre(const s4tp_plan& from, ManoeuvreState& to) {
  to = {static_cast<LaneChange>(from.lane_change),
        from.lane_change_side,
        static_cast<RequiredChange>(from.required_change),
        static_cast<ZoneClaim>(from.zone_claim),
        from.lane_change_ms,
        from.required_change_ms,
        from.zone_claim_ms,
        from.zone_lane};
  return is_known(to);
}

bool copy_plan(const s4tp_plan& from, Plan& to) {
  if (from.kind > S4TP_PLAN_MINIMUM_RISK || !copy_manoeuvre(from, to.manoeuvre)) return false;
  to.kind = static_cast<PlanKind>(from.kind);
  to.start_ms = from.start_ms;
  to.fail_safe = {from.fail_safe_branch_s, from.fail_safe_braking_mps2};
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    const s4tp_plan_point& point = from.points[i];
    TrajectoryPoint& copy = to.trajectory.points[i];
    copy.rear_axle = {point.x_m, point.y_m, point.heading_rad};
    copy.speed_mps = point.speed_mps;
    copy.acceleration_mps2 = point.acceleration_mps2;
    copy.curvature_1pm = point.curvature_1pm;
    if (!trajectory::in_range(copy)) return false;
  }
  return true;
}

s4tp_plan_point c_point(const TrajectoryPoint& from) {
  return {from.rear_axle.x_m, from.rear_axle.y_m,     from.rear_axle.heading_rad,
          from.speed_mps,     from.acceleration_mps2, from.curvature_1pm};
}

void copy_back(const Plan& from, s4tp_plan& to) {
  to.kind = static_cast<std::uint32_t>(from.kind);
  to.start_ms = from.start_ms;
  to.fail_safe_branch_s = from.fail_safe.branch_s;
  to.fail_safe_braking_mps2 = from.fail_safe.braking_mps2;
  const ManoeuvreState& state = from.manoeuvre;
  to.lane_change = static_cast<std::uint8_t>(state.lane_change);
  to.lane_change_side = state.side;
  to.required_change = static_cast<std::uint8_t>(state.required_change);
  to.zone_claim = static_cast<std::uint8_t>(state.zone_claim);
  to.lane_change_ms = state.lane_change_ms;
  to.required_change_ms = state.required_change_ms;
  to.zone_claim_ms = state.zone_claim_ms;
  to.zone_lane = state.zone_lane;
  for (int i = 0; i < kTrajectoryPoints; ++i) to.points[i] = c_point(from.trajectory.points[i]);
}

void copy_back(const Explanation& from, s4tp_explanation& to) {
  to = s4tp_explanation{};
  to.status = static_cast<s4tp_status>(from.status);
  to.parameters_crc = from.parameters_crc;
  to.chosen = c_choice(from.chosen, from.chosen_cost);
  to.runner_up = c_choice(from.runner_up, from.runner_up_cost);
  to.candidates = from.candidate_count;
  to.left_out = from.left_out;
  to.decisions = from.decisions;
  for (int i = 0; i < from.candidate_count; ++i) {
    if (from.rejections[i] != trajectory::Rejection::kNone)
      ++to.rejected[static_cast<int>(from.rejections[i])];
  }
  to.dominating_track = from.dominating_track;
  to.dominating_step = from.dominating_step;
  to.id_clashes = from.id_clashes;
  to.tracks_left_out = from.tracks_left_out;
  to.lanes_left_out = from.lanes_left_out;
  to.unseen = from.blocking.unseen() ? 1 : 0;
  for (int i = 0; i < kStageCount; ++i) to.work[i] = from.work[i];
}

}  // namespace s4tp::planner
