#include "algo/scene/scene_builder.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/input_ranges.hpp"
#include "algo/core/standing.hpp"
#include "algo/core/vehicle_time.hpp"
#include "algo/scene/agent_paths.hpp"
#include "algo/scene/ego_paths.hpp"
#include "algo/scene/lane_table.hpp"
#include "algo/scene/relevance.hpp"

namespace s4tp::scene {
namespace {

constexpr std::int32_t kLateMs = 500;  // CORE-030: a list that is still taken
constexpr float kCoastS = 1.0F;        // longer nobody is expected to go on as it was seen
constexpr float kAtJunctionM = 15.0F;  // standing this far before the zone, or nearer, is waiting for it
constexpr std::int32_t kLongestStepMs = 500;  // a hole in time is no waiting
constexpr std::uint16_t kPresentBit = 1U << (kHistorySamples - 1);

// Work (WorkMeter's units).
constexpr int kBuildWork = 360;
constexpr int kAgentWork = 60;
constexpr int kClashWork = 60;

bool sound(const EgoState& ego) {
  return abs(ego.rear_axle.x_m) < kFarthestInputM && abs(ego.rear_axle.y_m) < kFarthestInputM &&
         abs(ego.rear_axle.heading_rad) < kMostInputHeadingRad && is_finite(ego.speed_mps) &&
         is_finite(ego.acceleration_mps2) && is_finite(ego.yaw_rate_radps) && is_finite(ego.steering_rad);
}

void record(History& history, const Pose& pose, float speed_mps, bool seen) {
  history.samples[kHistorySamples - 1] = {pose, speed_mps};
  if (seen) {
    history.valid = static_cast<std::uint16_t>(history.valid | kPresentBit);
  } else {
    history.valid = static_cast<std::uint16_t>(history.valid & ~kPresentBit);
  }
}

// Time counted as spent standing between two scenes.
std::int32_t counted_ms(std::int32_t step_ms) {
  if (step_ms < 0) return 0;
  return step_ms < kLongestStepMs ? step_ms : kLongestStepMs;
}

}  // namespace

void SceneBuilder::reset() {
  memory_.reset();
  ego_history_ = History{};
  last_ms_ = 0;
  started_ = false;
  waited_ms_ = 0;
  ego_lane_ = kNoLaneIndex;
  in_junction_ = false;
}

void SceneBuilder::note_waiting(std::int32_t passed_ms, const Scene& scene, const Parameters& parameters) {
  bool at_junction = false;
  if (!scene.ego_paths.empty()) {
    const EgoPath& path = scene.ego_paths[0];
    const float to_front_m = parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
    const float near_s_m = path.frenet.s_m + to_front_m + kAtJunctionM;
    for (const ConflictZone& zone : path.zones) at_junction = at_junction || zone.entry_s_m < near_s_m;
    for (const PathLane& lane : path.path.lanes) {
      at_junction = at_junction || (scene.map->lanes[lane.lane].in_junction && lane.start_s_m < near_s_m);
    }
  }
  const bool was_in_junction = in_junction_;
  in_junction_ = ego_lane_ != kNoLaneIndex && scene.map->lanes[ego_lane_].in_junction;
  if (!at_junction || (was_in_junction && !in_junction_)) {
    waited_ms_ = 0;
  } else if (scene.ego.speed_mps < kStandingMps) {
    waited_ms_ = bounded_ms(waited_ms_ + passed_ms);
  }
}

void SceneBuilder::advance_time(std::uint32_t time_ms) {
  const std::int32_t step_ms = started_ ? elapsed_ms(last_ms_, time_ms) : 0;
  // Time that stands still or moves a whole history at once leaves nothing to keep; so does time running
  // back.
  const bool jump = step_ms < 0 || step_ms > kHistorySamples * kStepMs;
  const int steps = jump ? kHistorySamples : (step_ms + kStepMs / 2) / kStepMs;
  shift(ego_history_, steps);
  memory_.shift_histories(steps);
  if (jump) memory_.forget_all();
  last_ms_ = time_ms;
}

void SceneBuilder::take_list(const TrackList& tracks, std::uint32_t list_time_ms,
                             const Parameters& parameters, Scene& scene) {
  const bool first = memory_.tracks.empty() || !started_;
  const std::int32_t since_last_ms = elapsed_ms(memory_.last_list_ms(), list_time_ms);
  const std::int32_t list_age_ms = elapsed_ms(list_time_ms, scene.time_ms);
  const bool in_time = list_age_ms <= kLateMs && list_age_ms >= -kLateMs;
  scene.list_refused = !in_time || (!first && since_last_ms < 0);
  if (!in_time || !(first || since_last_ms > 0)) return;
  const float to_centre_m = 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
  const float since_m = 1e-3F * static_cast<float>(list_age_ms) * scene.ego.speed_mps;
  memory_.take(tracks, list_time_ms, offset_point(scene.ego.rear_axle, to_centre_m - since_m, 0.0F),
               scene.ego.speed_mps * direction(scene.ego.rear_axle.heading_rad));
}

void SceneBuilder::add_agents(const LaneTable& table, std::int32_t passed_ms, Scene& scene) {
  for (RememberedTrack& past : memory_.tracks) {
    const std::int32_t since_ms = elapsed_ms(past.seen_ms, scene.time_ms);
    Agent agent;
    agent.track = past.track;
    agent.age_ms = bounded_ms(since_ms > 0 ? since_ms : 0);
    agent.lane = past.lane;
    build_agent_paths(table, memory_.hindered(past.track), agent);
    past.lane = agent.lane;
    bring_forward(scene.map, min(1e-3F * static_cast<float>(agent.age_ms), kCoastS), agent);
    record(past.history, agent.track.centre, agent.track.speed_mps, agent.age_ms <= kFreshMs);
    agent.history = past.history;
    const bool stands = agent.track.speed_mps < kStandingMps;
    past.stood_ms = stands ? bounded_ms(past.stood_ms + passed_ms) : std::uint16_t{0};
    past.known_ms = bounded_ms(past.known_ms + passed_ms);
    agent.stood_ms = past.stood_ms;
    agent.known_ms = past.known_ms;
    (void)scene.agents.push(agent);
  }
}

Status SceneBuilder::build(std::uint32_t time_ms, const EgoState& ego, const TrackList& tracks,
                           std::uint32_t list_time_ms, const LaneMap* map, const Parameters& parameters,
                           Scene& scene) {
  scene.time_ms = time_ms;
  scene.ego_paths.clear();
  scene.agents.clear();
  scene.watched = 0;
  scene.map = map;
  scene.ego = EgoState{};
  scene.waited_s = 0.0F;
  scene.list_refused = false;
  scene.work = kBuildWork;
  scene.known = KnownGround{};
  if (!sound(ego)) {
    reset();
    scene.ego_history = History{};
    return Status::kInvalidInput;
  }
  scene.ego = ego;
  const std::int32_t passed_ms = counted_ms(started_ ? elapsed_ms(last_ms_, time_ms) : 0);
  advance_time(time_ms);
  take_list(tracks, list_time_ms, parameters, scene);
  started_ = true;
  memory_.forget_lost(time_ms, ego.speed_mps < kStandingMps);
  scene.id_clashes = memory_.id_clashes();
  scene.known = memory_.known_ground(time_ms);

  const LaneTable table(map);
  LaneTable::Fits fits;
  table.fit(ego.rear_axle, {ego_lane_, true}, fits);
  ego_lane_ = fits.empty() ? table.lane_ahead(ego.rear_axle) : fits[0].lane;
  if (ego_lane_ != kNoLaneIndex) build_ego_paths(table, ego_lane_, parameters, scene);
  note_waiting(passed_ms, scene, parameters);
  scene.waited_s = 1e-3F * static_cast<float>(waited_ms_);
  record(ego_history_, ego.rear_axle, ego.speed_mps, true);
  scene.ego_history = ego_history_;

  add_agents(table, passed_ms, scene);
  const int rank_work = rank_agents(relevance, parameters, scene);
  scene.work += table.work() + kAgentWork * scene.agents.size() + kClashWork * scene.id_clashes + rank_work;
  return ego_lane_ != kNoLaneIndex ? Status::kOk : Status::kNoLane;
}

}  // namespace s4tp::scene
