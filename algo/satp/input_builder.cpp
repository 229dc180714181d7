#include "algo/satp/input_builder.hpp"

#include <new>

#include "algo/core/inline.hpp"
#include "algo/scene/agent_paths.hpp"

namespace s4tp::satp {
namespace {

constexpr float kLongestStandS = 20.0F;
constexpr float kFarthestM = 100.0F;  // of gaps and ways to zones
constexpr float kOverlapM = -20.0F;
constexpr float kLongestHoldS = 10.0F;

float& at(float (&row)[kPairFeatures], PairFeature feature) {
  return row[static_cast<int>(feature)];
}

float within_reach(float way_m) {
  return clamp(way_m, kOverlapM, kFarthestM);
}

// Box centre ahead of the rear axle.
float centre_ahead_m(const Parameters& parameters) {
  return 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
}

void fill_history(const scene::History& history, float centre_m, const Pose& anchor,
                  float (&rows)[kHistorySamples][kHistoryFeatures]) {
  for (int j = 0; j < kHistorySamples; ++j) {
    float(&row)[kHistoryFeatures] = rows[j];
    if ((history.valid >> j & 1) == 0) {
      for (float& value : row) value = 0.0F;
      continue;
    }
    const scene::History::Sample& sample = history.samples[j];
    const Pose local = to_anchor(anchor, shift_ahead(sample.pose, centre_m));
    const SinCos turn = sin_cos(local.heading_rad);
    row[0] = local.x_m;
    row[1] = local.y_m;
    row[2] = local.heading_rad;
    row[3] = sample.speed_mps * turn.cos;
    row[4] = sample.speed_mps * turn.sin;
  }
}

void fill_place(const Pose& frame, const Pose& pose, float speed_mps, float length_m, float width_m,
                float (&row)[kPlaceFeatures]) {
  const Pose local = to_anchor(frame, pose);
  const SinCos turn = sin_cos(local.heading_rad);
  row[0] = local.x_m;
  row[1] = local.y_m;
  row[2] = turn.sin;
  row[3] = turn.cos;
  row[4] = speed_mps * turn.cos;
  row[5] = speed_mps * turn.sin;
  row[6] = length_m;
  row[7] = width_m;
}

// Whether a stop line lies in [from, from + spacing).
bool stop_line_next(const LaneMap& map, const scene::LanePath& path, float from_s_m) {
  for (const scene::PathLane& part : path.lanes) {
    const float line_m = map.lanes[part.lane].stop_line_m;
    const float line_s_m = part.start_s_m + line_m;
    if (line_m >= 0.0F && line_s_m >= from_s_m && line_s_m < from_s_m + kLaneSpacingM) return true;
  }
  return false;
}

int fill_lane(const LaneMap& map, const scene::LanePath& path, const PathHypothesis& hypothesis,
              const Pose& anchor, float (&rows)[kLanePoints][kLaneFeatures]) {
  scene::PathCursor cursor(map, path);
  int count = 0;
  for (int p = 0; p < kLanePoints; ++p) {
    const float s_m = hypothesis.start_s_m + kLaneSpacingM * static_cast<float>(p);
    if (p > 0 && s_m > path.length_m) break;
    const scene::PathPoint point = cursor.at(s_m);
    const Pose local = to_anchor(anchor, point.pose);
    float(&row)[kLaneFeatures] = rows[p];
    row[0] = local.x_m;
    row[1] = local.y_m;
    row[2] = local.heading_rad;
    row[3] = point.speed_limit_mps;
    for (const PathConflict& conflict : hypothesis.conflicts) {
      // A zone shorter than the spacing still marks the point before it.
      if (s_m + kLaneSpacingM <= conflict.entry_s_m || s_m > conflict.exit_s_m) continue;
      row[4 + static_cast<int>(conflict.priority)] = 1.0F;
    }
    row[7] = stop_line_next(map, path, s_m) ? 1.0F : 0.0F;
    count = p + 1;
  }
  return count;
}

// Where `lane` begins on one of our paths, counted from our anchor's centre.
bool on_our_path(const scene::Scene& scene, LaneIndex lane, float centre_m, float& way_m) {
  for (const scene::EgoPath& ego_path : scene.ego_paths) {
    for (const scene::PathLane& part : ego_path.path.lanes) {
      if (part.lane != lane) continue;
      way_m = part.start_s_m - ego_path.frenet.s_m - centre_m;
      return true;
    }
  }
  return false;
}

// NetworkInput::paths_meet but for zones.
bool shares_lane(const scene::Scene& scene, const scene::Agent& agent) {
  if (agent.paths.empty() || scene.ego_paths.empty()) return true;
  for (const scene::LanePath& path : agent.paths) {
    for (const scene::PathLane& part : path.lanes) {
      float way_m = 0.0F;
      if (on_our_path(scene, part.lane, 0.0F, way_m)) return true;
    }
  }
  return false;
}

bool goes_on_in(const LaneMap& map, LaneIndex lane, const scene::LanePath& path) {
  for (const LaneIndex successor : map.lanes[lane].successors) {
    for (const scene::PathLane& part : path.lanes) {
      if (successor != kNoLaneIndex && part.lane == successor) return true;
    }
  }
  return false;
}

// The first zone on the likeliest path that has one ahead of both of us.
void fill_zone(const scene::Scene& scene, const scene::Agent& agent,
               const PathHypothesis (&hypotheses)[kPathsPerAgent], float centre_m,
               float (&row)[kPairFeatures]) {
  for (int k = 0; k < agent.paths.size(); ++k) {
    for (const PathConflict& conflict : hypotheses[k].conflicts) {
      float lane_start_m = 0.0F;
      if (!on_our_path(scene, conflict.our_lane, centre_m, lane_start_m)) continue;
      const float our_exit_m = lane_start_m + conflict.our_exit_m;
      if (our_exit_m < 0.0F) continue;
      at(row, PairFeature::kZone) = 1.0F;
      at(row, PairFeature::kEntryM) = within_reach(conflict.entry_s_m - hypotheses[k].start_s_m);
      at(row, PairFeature::kExitM) = within_reach(conflict.exit_s_m - hypotheses[k].start_s_m);
      at(row, PairFeature::kOurEntryM) = within_reach(lane_start_m + conflict.our_entry_m);
      at(row, PairFeature::kOurExitM) = within_reach(our_exit_m);
      at(row, PairFeature::kYields) = conflict.priority == Priority::kFirstYields ? 1.0F : 0.0F;
      at(row, PairFeature::kFirstCome) = conflict.priority == Priority::kFirstCome ? 1.0F : 0.0F;
      at(row, PairFeature::kHasPriority) = conflict.priority == Priority::kFirstHasPriority ? 1.0F : 0.0F;
      at(row, PairFeature::kMerging) =
          goes_on_in(*scene.map, conflict.our_lane, agent.paths[k]) ? 1.0F : 0.0F;
      return;
    }
  }
}

// Who of the two is ahead on the other's path, bumper to bumper.
void fill_same_path(const scene::Scene& scene, const Parameters& parameters, const scene::Agent& agent,
                    const PathHypothesis (&hypotheses)[kPathsPerAgent], float lead_s,
                    float (&row)[kPairFeatures]) {
  if (scene.ego_paths.empty()) return;
  const float half_lengths_m = 0.5F * (agent.track.length_m + parameters.vehicle.length_m);
  const float centre_m = centre_ahead_m(parameters) + scene.ego.speed_mps * lead_s;
  const LaneIndex our_lane = scene.ego_paths[0].path.lanes[0].lane;
  for (int k = 0; k < agent.paths.size(); ++k) {
    for (const scene::PathLane& part : agent.paths[k].lanes) {
      if (part.lane != our_lane) continue;
      const float gap_m = part.start_s_m + scene.ego_paths[0].frenet.s_m + centre_m - hypotheses[k].start_s_m;
      if (gap_m < 0.0F || at(row, PairFeature::kWeAhead) > 0.0F) continue;
      at(row, PairFeature::kWeAhead) = 1.0F;
      at(row, PairFeature::kAheadGapM) = within_reach(gap_m - half_lengths_m);
    }
  }
  for (const scene::EgoPath& ego_path : scene.ego_paths) {
    float s_m = 0.0F;
    if (!scene::arc_length_on(ego_path.path, agent, s_m)) continue;
    const float gap_m = s_m + agent.track.speed_mps * lead_s - ego_path.frenet.s_m - centre_m;
    if (gap_m < 0.0F) continue;
    at(row, PairFeature::kWeBehind) = 1.0F;
    at(row, PairFeature::kBehindGapM) = within_reach(gap_m - half_lengths_m);
    return;
  }
}

void fill_pair(const scene::Scene& scene, const Parameters& parameters, const scene::Agent& agent,
               const PathHypothesis (&hypotheses)[kPathsPerAgent], float lead_s, const Pose& anchor,
               const Pose& ego_anchor, float (&row)[kPairFeatures]) {
  const float centre_m = centre_ahead_m(parameters) + scene.ego.speed_mps * lead_s;
  fill_zone(scene, agent, hypotheses, centre_m, row);
  fill_same_path(scene, parameters, agent, hypotheses, lead_s, row);
  at(row, PairFeature::kStoodS) = min(0.001F * static_cast<float>(agent.stood_ms), kLongestStandS);
  at(row, PairFeature::kWeStoodS) = min(scene.waited_s, kLongestStandS);
  at(row, PairFeature::kLengthM) = agent.track.length_m;
  at(row, PairFeature::kWidthM) = agent.track.width_m;
  if (!agent.paths.empty()) {
    const PathHypothesis& hypothesis = hypotheses[0];
    if (hypothesis.follows) {
      const float gap_m = hypothesis.leader_rear_s_m - hypothesis.start_s_m - 0.5F * agent.track.length_m;
      at(row, PairFeature::kLeader) = 1.0F;
      at(row, PairFeature::kLeaderGapM) = within_reach(gap_m);
      at(row, PairFeature::kLeaderMps) = hypothesis.leader_mps;
    }
    at(row, PairFeature::kLikeliest) = agent.path_probability[0];
    if (agent.paths.size() > 1) at(row, PairFeature::kSecond) = agent.path_probability[1];
    at(row, PairFeature::kHoldS) = clamp(hypothesis.hold_until_s, 0.0F, kLongestHoldS);
  }
  at(row, PairFeature::kSpeedMps) = agent.track.speed_mps;
  at(row, PairFeature::kOurSpeedMps) = scene.ego.speed_mps;
  at(row, PairFeature::kAcceleration) = agent.track.acceleration_mps2;
  at(row, PairFeature::kOurAcceleration) = scene.ego.acceleration_mps2;
  at(row, PairFeature::kYawRateRadps) = agent.track.yaw_rate_radps;
  const Pose ours = to_anchor(anchor, ego_anchor);
  const SinCos turn = sin_cos(ours.heading_rad);
  at(row, PairFeature::kOurXM) = ours.x_m;
  at(row, PairFeature::kOurYM) = ours.y_m;
  at(row, PairFeature::kOurSin) = turn.sin;
  at(row, PairFeature::kOurCos) = turn.cos;
}

}  // namespace

Pose to_anchor(const Pose& anchor, const Pose& pose) {
  const Point local = to_local(anchor, position(pose));
  return {local.x_m, local.y_m, wrap_angle(pose.heading_rad - anchor.heading_rad)};
}

Pose from_anchor(const Pose& anchor, const Pose& pose) {
  const Point point = offset_point(anchor, pose.x_m, pose.y_m);
  return {point.x_m, point.y_m, wrap_angle(pose.heading_rad + anchor.heading_rad)};
}

void read_path_hypotheses(const scene::Scene& scene, float lead_s, PathHypotheses& hypotheses) {
  for (int i = 0; i < scene.watched; ++i) {
    for (int k = 0; k < scene.agents[i].paths.size(); ++k)
      hypotheses[i][k] = read_path_hypothesis(scene, i, k, lead_s);
  }
}

void build_network_input(const scene::Scene& scene, const Parameters& parameters, float lead_s,
                         const PathHypotheses& hypotheses, NetworkInput& input) {
  new (&input) NetworkInput;  // assigned, it would be made on the stack first
  input.hdvs = scene.watched;
  const float centre_m = centre_ahead_m(parameters);
  input.ego_anchor = shift_ahead(scene.ego.rear_axle, centre_m + scene.ego.speed_mps * lead_s);
  input.ego_history_valid = scene.ego_history.valid;
  fill_history(scene.ego_history, centre_m, input.ego_anchor, input.ego_history);
  fill_place(input.ego_anchor, input.ego_anchor, scene.ego.speed_mps, parameters.vehicle.length_m,
             parameters.vehicle.width_m, input.place[0]);
  for (int i = 0; i < scene.watched; ++i) {
    const scene::Agent& agent = scene.agents[i];
    const Track& track = agent.track;
    input.anchor[i] = shift_ahead(track.centre, track.speed_mps * lead_s);
    input.speed_mps[i] = track.speed_mps;
    input.history_valid[i] = agent.history.valid;
    fill_history(agent.history, 0.0F, input.anchor[i], input.history[i]);
    fill_place(input.ego_anchor, input.anchor[i], track.speed_mps, track.length_m, track.width_m,
               input.place[1 + i]);
    for (int k = 0; k < agent.paths.size(); ++k) {
      input.lane_points[i][k] = static_cast<std::uint8_t>(
          fill_lane(*scene.map, agent.paths[k], hypotheses[i][k], input.anchor[i], input.lane[i][k]));
    }
    fill_pair(scene, parameters, agent, hypotheses[i], lead_s, input.anchor[i], input.ego_anchor,
              input.pair[i]);
    const bool zone = at(input.pair[i], PairFeature::kZone) > 0.0F;
    input.paths_meet[i] = zone || shares_lane(scene, agent) ? 1 : 0;
  }
}

void build_network_input(const scene::Scene& scene, const Parameters& parameters, float lead_s,
                         NetworkInput& input) {
  PathHypotheses hypotheses;
  read_path_hypotheses(scene, lead_s, hypotheses);
  build_network_input(scene, parameters, lead_s, hypotheses, input);
}

void build_plan_input(const Trajectory& plan, const Parameters& parameters, const NetworkInput& input,
                      PlanInput& plan_input) {
  build_plan_input(plan, parameters, input.hdvs, input.anchor, input.pair, plan_input);
}

void build_plan_input(const Trajectory& plan, const Parameters& parameters, int hdvs, const Pose* anchor,
                      const float (*pair)[kPairFeatures], PlanInput& plan_input) {
  new (&plan_input) PlanInput;
  const float centre_m = centre_ahead_m(parameters);
  Pose knot[kDecoderSteps + 1];
  float driven_m[kDecoderSteps + 1] = {};
  for (int s = 0; s <= kDecoderSteps; ++s) {
    knot[s] = shift_ahead(plan.points[s * kStepsPerDecode].rear_axle, centre_m);
    if (s == 0) continue;
    driven_m[s] = driven_m[s - 1];
    for (int i = (s - 1) * kStepsPerDecode; i < s * kStepsPerDecode; ++i) {
      driven_m[s] += distance(position(plan.points[i].rear_axle), position(plan.points[i + 1].rear_axle));
    }
  }
  for (int i = 0; i < hdvs; ++i) {
    const float(&values)[kPairFeatures] = pair[i];
    const bool zone = values[static_cast<int>(PairFeature::kZone)] > 0.0F;
    const float entry_m = values[static_cast<int>(PairFeature::kOurEntryM)];
    const float exit_m = values[static_cast<int>(PairFeature::kOurExitM)];
    for (int s = 0; s < kDecoderSteps; ++s) {
      const Pose begin = to_anchor(anchor[i], knot[s]);
      const Pose end = to_anchor(anchor[i], knot[s + 1]);
      float(&row)[kPlanValues] = plan_input.step[i][s];
      row[0] = begin.x_m;
      row[1] = begin.y_m;
      row[2] = begin.heading_rad;
      row[3] = end.x_m;
      row[4] = end.y_m;
      row[5] = end.heading_rad;
      row[6] = plan.points[(s + 1) * kStepsPerDecode].speed_mps;
      row[7] = zone ? entry_m - driven_m[s + 1] : 0.0F;
      row[8] = zone ? exit_m - driven_m[s + 1] : 0.0F;
    }
  }
}

}  // namespace s4tp::satp
