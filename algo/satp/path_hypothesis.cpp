#include "algo/satp/path_hypothesis.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/sort.hpp"
#include "algo/satp/car_following.hpp"
#include "algo/scene/agent_paths.hpp"
#include "algo/scene/conflict_view.hpp"

namespace s4tp::satp {
namespace {

constexpr float kLateralMps2 = 4.0F;   // what sets the speed in turns
constexpr float kSlowDownMps2 = 2.0F;  // on the way to them
constexpr float kSlowestTurnMps = 2.0F;
constexpr float kSlowAheadM = 60.0F;
constexpr float kStartingMps = 6.0F;  // below this a vehicle is on its way to the limit
constexpr float kGainingMps2 = 0.5F;
constexpr float kStraightRad = 0.1F;      // a lane that turns by less is driven at its limit
constexpr float kSetsOffMps2 = 0.2F;      // who gains speed by more does not go on standing
constexpr float kHardlyMovingMps = 0.5F;  // who is slower is not counted as coming
constexpr float kUnlikely = 0.2F;         // paths of others less likely than this make nobody wait
constexpr float kZoneMarginM = 1.0F;      // how far before a zone a vehicle waits
constexpr float kZoneMarginS = 1.0F;      // between others leaving and entering
constexpr float kFirmBrakingMps2 = 4.0F;  // who would have to brake harder goes through
constexpr float kLongestWaitS = 6.0F;
constexpr float kUsualMps = 4.0F;  // arrival times are taken at no less than this speed
constexpr int kReadZones = 6;

// Speed it wants on an open road: what it has, unless it is only starting or gaining speed.
float desired_speed(const Track& track, float limit_mps) {
  const bool gaining = track.speed_mps < kStartingMps || track.acceleration_mps2 > kGainingMps2;
  return gaining ? max(limit_mps, track.speed_mps) : track.speed_mps;
}

float turn_speed(const Lane& lane, float length_m, float over_limit) {
  const float limit_mps = lane.speed_limit_mps * over_limit;
  if (lane.point_count < 3) return limit_mps;
  const Point first = lane.points[1] - lane.points[0];
  const Point last = lane.points[lane.point_count - 1] - lane.points[lane.point_count - 2];
  const float turn_rad = abs(atan2(cross(first, last), dot(first, last)));
  if (turn_rad < kStraightRad) return limit_mps;
  // The chords at the ends stand for all but half a chord each.
  const float curvature_1pm = turn_rad / max(length_m - 0.5F * (norm(first) + norm(last)), 1.0F);
  return min(limit_mps, sqrt(kLateralMps2 / curvature_1pm));
}

void read_slow_stretch(const LaneMap& map, const scene::LanePath& path, float limit_mps,
                       PathHypothesis& hypothesis) {
  const float over_limit =
      max(hypothesis.speed_mps / max(limit_mps, 1.0F), 1.0F);  // who speeds goes on speeding
  hypothesis.slow_mps = hypothesis.desired_mps;
  hypothesis.after_mps = hypothesis.desired_mps;
  for (const scene::PathLane& part : path.lanes) {
    hypothesis.after_mps = max(hypothesis.after_mps, map.lanes[part.lane].speed_limit_mps * over_limit);
  }
  float most_binding_mps = 1e3F;
  for (int i = 0; i < path.lanes.size(); ++i) {
    const float from_s_m = path.lanes[i].start_s_m;
    const float to_s_m = i + 1 < path.lanes.size() ? path.lanes[i + 1].start_s_m : path.length_m;
    if (to_s_m < hypothesis.start_s_m) continue;
    if (from_s_m > hypothesis.start_s_m + kSlowAheadM) break;
    const float turn_mps =
        max(turn_speed(map.lanes[path.lanes[i].lane], to_s_m - from_s_m, over_limit), kSlowestTurnMps);
    // A vehicle in the turn already has chosen its speed for it.
    const float speed_mps = from_s_m <= hypothesis.start_s_m ? max(turn_mps, hypothesis.speed_mps) : turn_mps;
    if (turn_mps >= hypothesis.after_mps) continue;
    const float distance_m = max(from_s_m - hypothesis.start_s_m, 0.0F);
    const float now_mps = sqrt(square(speed_mps) + 2.0F * kSlowDownMps2 * distance_m);
    if (now_mps >= most_binding_mps) continue;
    most_binding_mps = now_mps;
    hypothesis.slow_from_s_m = from_s_m;
    hypothesis.slow_to_s_m = to_s_m;
    hypothesis.slow_mps = speed_mps;
  }
}

void read_leader(const scene::Scene& scene, int index, const scene::LanePath& path, float s_m, float lead_s,
                 PathHypothesis& hypothesis) {
  const scene::Agent& agent = scene.agents[index];
  float nearest_m = 1e6F;
  for (int other = 0; other < scene.agents.size(); ++other) {
    if (other == index) continue;
    const scene::Agent& ahead = scene.agents[other];
    float other_s_m = 0.0F;
    if (!scene::arc_length_on(path, ahead, other_s_m)) continue;
    const float gap_m = other_s_m - s_m - 0.5F * (agent.track.length_m + ahead.track.length_m);
    if (other_s_m <= s_m || gap_m >= nearest_m) continue;
    nearest_m = gap_m;
    hypothesis.follows = true;
    hypothesis.leader_mps = ahead.track.speed_mps;
    hypothesis.leader_rear_s_m = other_s_m - 0.5F * ahead.track.length_m + ahead.track.speed_mps * lead_s;
    hypothesis.headway_s = kept_headway_s(gap_m, agent.track.speed_mps);
  }
}

// Until when other vehicles are in the way at a zone it has to give way at; 0: nobody comes.
float busy_until_s(const scene::Scene& scene, int index, const scene::ConflictView& view, float in_s,
                   float out_s) {
  float until_s = 0.0F;
  for (int other = 0; other < scene.agents.size(); ++other) {
    if (other == index) continue;
    const scene::Agent& agent = scene.agents[other];
    const float speed_mps = agent.track.speed_mps;
    for (int k = 0; k < agent.paths.size(); ++k) {
      if (agent.path_probability[k] < kUnlikely) continue;
      for (const scene::PathLane& part : agent.paths[k].lanes) {
        if (part.lane != view.other) continue;
        const float to_entry_m = part.start_s_m + view.other_entry_m - agent.frenet[k].s_m;
        const float to_exit_m = part.start_s_m + view.other_exit_m - agent.frenet[k].s_m;
        if (to_exit_m < 0.0F || (speed_mps < kHardlyMovingMps && to_entry_m > 0.0F)) break;
        const float there_s = max(to_entry_m, 0.0F) / max(speed_mps, 1.0F);
        const float gone_s = to_exit_m / max(speed_mps, 1.0F);
        if (there_s < out_s + kZoneMarginS && gone_s > in_s) until_s = max(until_s, gone_s);
        break;
      }
    }
  }
  return min(until_s, kLongestWaitS);
}

void add_conflict(const scene::ConflictView& view, float lane_start_s_m, PathHypothesis& hypothesis) {
  const PathConflict conflict{view.other,
                              view.priority,
                              lane_start_s_m + view.own_entry_m,
                              lane_start_s_m + view.own_exit_m,
                              view.other_entry_m,
                              view.other_exit_m};
  insert(hypothesis.conflicts, conflict,
         [](const PathConflict& a, const PathConflict& b) { return a.entry_s_m < b.entry_s_m; });
}

void read_zones(const scene::Scene& scene, int index, const scene::LanePath& path,
                PathHypothesis& hypothesis) {
  std::int8_t place[kMaxLanes];
  for (std::int8_t& entry : place) entry = -1;
  for (int i = 0; i < path.lanes.size(); ++i) place[path.lanes[i].lane] = static_cast<std::int8_t>(i);
  bool ours[kMaxLanes] = {};
  for (const scene::EgoPath& ego_path : scene.ego_paths) {
    for (const scene::PathLane& part : ego_path.path.lanes) ours[part.lane] = true;
  }

  int waits_read = 0;
  for (const Conflict& conflict : scene.map->conflicts) {
    if (!scene::sound(conflict)) continue;
    const bool from_second = place[conflict.second] >= 0;
    if ((place[conflict.first] >= 0) == from_second) continue;
    const scene::ConflictView view = scene::view_from(conflict, from_second);
    const float lane_start_s_m = path.lanes[place[view.own]].start_s_m;
    const float to_entry_m = lane_start_s_m + view.own_entry_m - hypothesis.start_s_m;
    const float to_exit_m = lane_start_s_m + view.own_exit_m - hypothesis.start_s_m;
    if (to_exit_m < 0.0F) continue;
    if (ours[view.other]) add_conflict(view, lane_start_s_m, hypothesis);
    if (view.priority == Priority::kFirstHasPriority || waits_read >= kReadZones) continue;
    const float room_m = to_entry_m - kZoneMarginM;
    if (room_m < 0.0F || square(hypothesis.speed_mps) > 2.0F * kFirmBrakingMps2 * room_m) continue;
    const float pace_mps = max(hypothesis.speed_mps, kUsualMps);
    const float until_s = busy_until_s(scene, index, view, to_entry_m / pace_mps, to_exit_m / pace_mps);
    ++waits_read;
    if (until_s <= 0.0F) continue;
    const float hold_s_m = hypothesis.start_s_m + room_m;
    if (hypothesis.hold_until_s <= 0.0F || hold_s_m < hypothesis.hold_s_m) hypothesis.hold_s_m = hold_s_m;
    hypothesis.hold_until_s = max(hypothesis.hold_until_s, until_s);
  }
}

}  // namespace

PathHypothesis read_path_hypothesis(const scene::Scene& scene, int index, int path_index, float lead_s) {
  const scene::Agent& agent = scene.agents[index];
  const scene::LanePath& path = agent.paths[path_index];
  const float s_m = agent.frenet[path_index].s_m;
  PathHypothesis hypothesis;
  hypothesis.speed_mps = agent.track.speed_mps;
  hypothesis.start_s_m = s_m + hypothesis.speed_mps * lead_s;
  const LaneIndex first = agent.lane != kNoLaneIndex ? agent.lane : path.lanes[0].lane;
  const float limit_mps = scene.map->lanes[first].speed_limit_mps;
  hypothesis.desired_mps = desired_speed(agent.track, limit_mps);
  read_slow_stretch(*scene.map, path, limit_mps, hypothesis);
  read_leader(scene, index, path, s_m, lead_s, hypothesis);
  read_zones(scene, index, path, hypothesis);
  // Who stands though nothing is in its way has a reason we do not see.
  const bool standing =
      hypothesis.speed_mps < kHardlyMovingMps && agent.track.acceleration_mps2 < kSetsOffMps2;
  if (standing && !hypothesis.follows && hypothesis.hold_until_s <= 0.0F && hypothesis.conflicts.empty())
    hypothesis.desired_mps = 0.0F;
  return hypothesis;
}

}  // namespace s4tp::satp
