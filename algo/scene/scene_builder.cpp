#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/scene/agent_paths.hpp"
#include "algo/scene/ego_paths.hpp"
#include "algo/scene/lane_table.hpp"
#include "algo/scene/relevance.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::scene {
namespace {

constexpr std::int32_t kCoastMs = 500;     // CORE-030: a list
constexpr std::int32_t kMissingMs = 1000;  // a vehicle that fresh lists lack
constexpr float kSameVehicleM = 2.0F;      // a new id this near a lost vehicle is that vehicle
constexpr float kSameSpeedMps = 4.0F;
constexpr float kJumpM = 8.0F;    // an id this far from where it should be is another vehicle
constexpr float kHinderS = 2.5F;  // a vehicle within this headway explains another's braking
constexpr float kHinderBesideM = 2.0F;
constexpr float kAtJunctionM = 15.0F;  // standing this far before the zone, or nearer, is waiting for it
constexpr std::int32_t kLongestStepMs = 500;  // a hole in time is no waiting
constexpr std::int32_t kLongestStandMs = 60'000;
constexpr std::uint8_t kNobodysId = 255;
constexpr std::uint16_t kPresentBit = 1U << (kHistorySamples - 1);

// Work (WorkMeter's units).
constexpr int kBuildWork = 150;
constexpr int kAgentWork = 60;
constexpr int kClashWork = 60;

// Signed, so that the 32-bit time may wrap and lists may lie a little in the future.
std::int32_t elapsed_ms(std::uint32_t from_ms, std::uint32_t to_ms) {
  return static_cast<std::int32_t>(to_ms - from_ms);
}

bool sound(const Track& track) {
  return abs(track.centre.x_m) < 1e5F && abs(track.centre.y_m) < 1e5F &&
         abs(track.centre.heading_rad) < 10.0F && is_finite(track.speed_mps) &&
         is_finite(track.acceleration_mps2) && is_finite(track.yaw_rate_radps) && is_finite(track.length_m) &&
         is_finite(track.width_m);
}

// Within the documented ranges of a track.
Track limited(const Track& track) {
  Track result = track;
  result.centre.heading_rad = wrap_angle(track.centre.heading_rad);
  result.speed_mps = clamp(track.speed_mps, 0.0F, 60.0F);
  result.acceleration_mps2 = clamp(track.acceleration_mps2, -12.0F, 12.0F);
  result.yaw_rate_radps = clamp(track.yaw_rate_radps, -1.3F, 1.3F);
  result.length_m = clamp(track.length_m, 0.5F, 25.0F);
  result.width_m = clamp(track.width_m, 0.3F, 3.0F);
  return result;
}

bool sound(const EgoState& ego) {
  return abs(ego.rear_axle.x_m) < 1e5F && abs(ego.rear_axle.y_m) < 1e5F &&
         abs(ego.rear_axle.heading_rad) < 10.0F && is_finite(ego.speed_mps) &&
         is_finite(ego.acceleration_mps2) && is_finite(ego.yaw_rate_radps) && is_finite(ego.steering_rad);
}

void shift(History& history, int steps) {
  if (steps >= kHistorySamples) {
    history.valid = 0;
    return;
  }
  for (int i = 0; i + steps < kHistorySamples; ++i) history.samples[i] = history.samples[i + steps];
  history.valid = static_cast<std::uint16_t>(history.valid >> steps);
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

std::uint16_t bounded_ms(std::int32_t time_ms) {
  return static_cast<std::uint16_t>(time_ms < kLongestStandMs ? time_ms : kLongestStandMs);
}

// Where a vehicle last seen as `track` is `seconds` later, roughly.
Point coasted(const Track& track, float seconds) {
  return offset_point(track.centre, track.speed_mps * seconds, 0.0F);
}

// Whether somebody is close ahead of the vehicle.
template <typename PastList>
bool hindered(const Track& track, const PastList& past) {
  const Point ahead = direction(track.centre.heading_rad);
  const float reach_m = kHinderS * track.speed_mps + 0.5F * track.length_m;
  for (const auto& other : past) {
    const Point offset = position(other.track.centre) - position(track.centre);
    const float ahead_m = dot(ahead, offset);
    if (ahead_m > 0.0F && ahead_m < reach_m + 0.5F * other.track.length_m &&
        abs(cross(ahead, offset)) < kHinderBesideM) {
      return true;
    }
  }
  return false;
}

}  // namespace

void SceneBuilder::reset() {
  past_.clear();
  ego_history_ = History{};
  last_ms_ = 0;
  last_list_ms_ = 0;
  id_clashes_ = 0;
  last_spare_id_ = 0;
  listed_ = KnownGround{};
  kept_ = KnownGround{};
  started_ = false;
  waited_ms_ = 0;
  ego_lane_ = kNoLaneIndex;
}

void SceneBuilder::note_waiting(std::int32_t passed_ms, const Scene& scene, const Parameters& parameters) {
  bool at_junction = false;
  if (!scene.ego_paths.empty()) {
    const EgoPath& path = scene.ego_paths[0];
    const float to_front_m = parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
    for (const ConflictZone& zone : path.zones) {
      at_junction = at_junction || zone.entry_s_m - path.frenet.s_m - to_front_m < kAtJunctionM;
    }
  }
  if (!at_junction) {
    waited_ms_ = 0;
  } else if (scene.ego.speed_mps < kStandingMps && waited_ms_ < kLongestStandMs) {
    waited_ms_ = waited_ms_ + passed_ms;
  }
}

void SceneBuilder::note_standing(std::int32_t passed_ms, Scene& scene) {
  for (int i = 0; i < scene.agents.size(); ++i) {  // one for each of past_, in its order
    Past& past = past_[i];
    const bool stands = scene.agents[i].track.speed_mps < kStandingMps;
    past.stood_ms = stands ? bounded_ms(past.stood_ms + passed_ms) : std::uint16_t{0};
    past.known_ms = bounded_ms(past.known_ms + passed_ms);
    scene.agents[i].stood_ms = past.stood_ms;
    scene.agents[i].known_ms = past.known_ms;
  }
}

void SceneBuilder::advance_time(std::uint32_t time_ms) {
  const std::int32_t step_ms = started_ ? elapsed_ms(last_ms_, time_ms) : 0;
  // Time that stands still or moves a whole history at once leaves nothing to keep; so does time running
  // back.
  const bool jump = step_ms < 0 || step_ms > kHistorySamples * kStepMs;
  const int steps = jump ? kHistorySamples : (step_ms + kStepMs / 2) / kStepMs;
  shift(ego_history_, steps);
  for (Past& past : past_) shift(past.history, steps);
  if (jump) past_.clear();
  last_ms_ = time_ms;
}

int SceneBuilder::find_past(const Track& track, std::uint32_t list_time_ms) const {
  for (int i = 0; i < past_.size(); ++i) {
    if (past_[i].track.id == track.id) return i;
  }
  for (int i = 0; i < past_.size(); ++i) {
    const Past& past = past_[i];
    if (past.seen_ms == list_time_ms) continue;
    const float seconds = 1e-3F * static_cast<float>(elapsed_ms(past.seen_ms, list_time_ms));
    if (distance(coasted(past.track, seconds), position(track.centre)) < kSameVehicleM &&
        abs(past.track.speed_mps - track.speed_mps) < kSameSpeedMps) {
      return i;
    }
  }
  return -1;
}

std::uint8_t SceneBuilder::spare_id(const TrackList& tracks) {
  const auto used = [&](std::uint8_t id) {
    bool found = id == kNobodysId;
    for (const Track& track : tracks) found = found || track.id == id;
    for (const Past& past : past_) found = found || past.track.id == id;
    return found;
  };
  do {  // at most twice kMaxTracks are used
    ++last_spare_id_;
  } while (used(last_spare_id_));
  return last_spare_id_;
}

void SceneBuilder::add_past(const Track& track, bool nameless, std::uint32_t list_time_ms) {
  Past past;
  past.track = track;
  past.nameless = nameless;
  past.seen_ms = list_time_ms;
  if (past_.push(past)) return;
  float furthest_m = distance(position(track.centre), listed_.centre);
  int furthest = -1;  // the new one itself
  for (int i = 0; i < past_.size(); ++i) {
    const float seconds = 1e-3F * static_cast<float>(elapsed_ms(past_[i].seen_ms, list_time_ms));
    const float away_m = distance(coasted(past_[i].track, seconds), listed_.centre);
    if (away_m <= furthest_m) continue;
    furthest = i;
    furthest_m = away_m;
  }
  if (furthest >= 0) past_[furthest] = past;
  if (kept_ms_ != list_time_ms) kept_ = KnownGround{};
  kept_ms_ = list_time_ms;
  kept_.radius_m = min(kept_.radius_m, furthest_m);
  ++kept_.left_out;
}

KnownGround SceneBuilder::known_ground(std::uint32_t time_ms) const {
  KnownGround known = listed_;
  if (kept_.left_out > 0) {
    known.radius_m = min(known.radius_m, kept_.radius_m);
    const int left_out = known.left_out + kept_.left_out;
    known.left_out = static_cast<std::uint8_t>(left_out < 255 ? left_out : 255);
  }
  const std::int32_t age_ms = elapsed_ms(last_list_ms_, time_ms);
  known.age_ms = bounded_ms(age_ms > 0 ? age_ms : 0);
  return known;
}

void SceneBuilder::take_list(const TrackList& tracks, std::uint32_t list_time_ms) {
  listed_.left_out = tracks.left_out;
  listed_.radius_m = KnownGround::kEverywhereM;
  if (tracks.left_out > 0) {
    listed_.radius_m = 0.0F;
    for (const Track& track : tracks) {
      if (sound(track))
        listed_.radius_m = max(listed_.radius_m, distance(position(track.centre), listed_.centre));
    }
  }
  // An id that stands twice belongs to nobody: what is known of it is given up, and those who bear it are
  // other vehicles in each list.
  bool clashes[kMaxTracks] = {};
  id_clashes_ = 0;
  for (int i = 0; i < tracks.size(); ++i) {
    for (int k = 0; k < tracks.size(); ++k)
      clashes[i] = clashes[i] || (k != i && tracks[k].id == tracks[i].id);
    if (clashes[i]) ++id_clashes_;
  }
  for (int i = past_.size() - 1; i >= 0; --i) {
    bool gone = past_[i].nameless;
    for (int k = 0; k < tracks.size(); ++k) gone = gone || (clashes[k] && tracks[k].id == past_[i].track.id);
    if (gone) past_.swap_remove(i);
  }
  // Known ids first, so that a new id cannot take the past of a vehicle that is still in the list.
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < tracks.size(); ++i) {
      if (!sound(tracks[i])) continue;
      Track track = limited(tracks[i]);
      if (clashes[i]) {
        if (pass == 0) continue;
        track.id = spare_id(tracks);
        add_past(track, true, list_time_ms);
        continue;
      }
      const int index = find_past(track, list_time_ms);
      const bool known = index >= 0 && past_[index].track.id == track.id;
      if (known != (pass == 0)) continue;
      if (index >= 0) {
        Past& past = past_[index];
        const float seconds = 1e-3F * static_cast<float>(elapsed_ms(past.seen_ms, list_time_ms));
        if (distance(coasted(past.track, seconds), position(track.centre)) > kJumpM) {
          past.history.valid = 0;
          past.stood_ms = 0;
          past.known_ms = 0;
          past.lane = kNoLaneIndex;
        }
        past.track = track;
        past.seen_ms = list_time_ms;
        continue;
      }
      add_past(track, false, list_time_ms);
    }
  }
  last_list_ms_ = list_time_ms;
}

bool SceneBuilder::in_anothers_place(int index) const {
  const Past& missing = past_[index];
  if (missing.seen_ms == last_list_ms_) return false;
  const float seconds = 1e-3F * static_cast<float>(elapsed_ms(missing.seen_ms, last_list_ms_));
  const Point place = coasted(missing.track, seconds);
  for (const Past& seen : past_) {
    const float half_m = 0.5F * min(missing.track.length_m, seen.track.length_m);
    if (seen.seen_ms == last_list_ms_ && distance(position(seen.track.centre), place) < half_m) return true;
  }
  return false;
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
  const std::int32_t step_ms = started_ ? elapsed_ms(last_ms_, time_ms) : 0;
  advance_time(time_ms);
  const bool first = past_.empty() || !started_;
  const std::int32_t since_last_ms = elapsed_ms(last_list_ms_, list_time_ms);
  const std::int32_t list_age_ms = elapsed_ms(list_time_ms, time_ms);
  const bool in_time = list_age_ms <= kCoastMs && list_age_ms >= -kCoastMs;
  scene.list_refused = !in_time || (!first && since_last_ms < 0);
  if (in_time && (first || since_last_ms > 0)) {
    const float to_centre_m = 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
    const float since_m = 1e-3F * static_cast<float>(list_age_ms) * ego.speed_mps;
    listed_.centre = offset_point(ego.rear_axle, to_centre_m - since_m, 0.0F);
    take_list(tracks, list_time_ms);
  }
  scene.id_clashes = id_clashes_;
  if (elapsed_ms(kept_ms_, time_ms) > kMissingMs)
    kept_ = KnownGround{};  // for good: 2^31 ms on it would lie ahead
  scene.known = known_ground(time_ms);
  started_ = true;

  const LaneTable table(map);
  LaneTable::Fits fits;
  table.fit(ego.rear_axle, {ego_lane_, true}, fits);
  ego_lane_ = fits.empty() ? table.lane_ahead(ego.rear_axle) : fits[0].lane;
  if (ego_lane_ != kNoLaneIndex) build_ego_paths(table, ego_lane_, parameters, scene);
  const std::int32_t passed_ms = counted_ms(step_ms);
  note_waiting(passed_ms, scene, parameters);
  scene.waited_s = 1e-3F * static_cast<float>(waited_ms_);
  record(ego_history_, ego.rear_axle, ego.speed_mps, true);
  scene.ego_history = ego_history_;

  for (int i = past_.size() - 1; i >= 0; --i) {
    const bool lost = elapsed_ms(past_[i].seen_ms, time_ms) > kMissingMs;
    if (lost || in_anothers_place(i)) past_.swap_remove(i);
  }
  for (Past& past : past_) {
    const std::int32_t age_ms = elapsed_ms(past.seen_ms, time_ms) > 0 ? elapsed_ms(past.seen_ms, time_ms) : 0;
    Agent agent;
    agent.track = past.track;
    agent.age_ms = static_cast<std::uint16_t>(age_ms);
    agent.lane = past.lane;
    build_agent_paths(table, hindered(past.track, past_), agent);
    past.lane = agent.lane;
    bring_forward(map, 1e-3F * static_cast<float>(age_ms), agent);
    record(past.history, agent.track.centre, agent.track.speed_mps, age_ms <= kFreshMs);
    agent.history = past.history;
    (void)scene.agents.push(agent);
  }
  note_standing(passed_ms, scene);
  const int rank_work = rank_agents(relevance, parameters, scene);
  scene.work += table.work() + kAgentWork * scene.agents.size() + kClashWork * scene.id_clashes + rank_work;
  return ego_lane_ != kNoLaneIndex ? Status::kOk : Status::kNoLane;
}

}  // namespace s4tp::scene
