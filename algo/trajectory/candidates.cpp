#include "algo/trajectory/candidates.hpp"

#include "algo/behavior/lane_change.hpp"
#include "algo/core/inline.hpp"
#include "algo/core/sort.hpp"
#include "algo/scene/ego_paths.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/roll_out.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kLeastRoomM = 0.1F;  // before a stop
constexpr float kHardest = -100.0F;  // as hard as the fail-safe: what that can still do, a plan can

/// What is tried, in this order, on every path: the running plan, one of each intent, then what adds most.
struct Trial {
  Intent intent;
  float acceleration_mps2;  ///< kAccelerate
  int line;                 ///< kStop: which stopping place, by nearness; kFollow: 1 in a gap
};
constexpr Trial kTrials[] = {
    {Intent::kPrevious, 0.0F, 0},   {Intent::kFollow, 0.0F, 0},      {Intent::kStop, 0.0F, 0},
    {Intent::kFollow, 0.0F, 1},     {Intent::kAccelerate, 2.0F, 0},  {Intent::kAccelerate, -3.0F, 0},
    {Intent::kAccelerate, 0.0F, 0}, {Intent::kAccelerate, -1.0F, 0}, {Intent::kAccelerate, kHardest, 0},
    {Intent::kAccelerate, 1.0F, 0}, {Intent::kAccelerate, 4.0F, 0},  {Intent::kStop, 0.0F, 1},
    {Intent::kStop, 0.0F, 2},
};
constexpr int kTrialCount = static_cast<int>(sizeof(kTrials) / sizeof(kTrials[0]));
/// Rounds over the paths: what matters most finds room first. Each ends where the next one begins.
constexpr int kRounds[] = {0, 1, 7, kTrialCount};
constexpr int kRoundCount = static_cast<int>(sizeof(kRounds) / sizeof(kRounds[0])) - 1;
constexpr int kMaxStops = 3;

constexpr float kStretch = 1.7F;  // a lateral motion that is infeasible is tried longer, three times
constexpr int kStretches = 4;
constexpr int kSteeredRollOuts = 3;  // a steered one counts as so many

// Work (WorkMeter's units).
constexpr int kPrepareWork = 60;
constexpr int kTrialWork = 4;
constexpr int kMostTrialWork = kTrialWork + kRollOutWork * kStretches + kSteeredWork;

constexpr float kAlikeM = 0.05F;          // two roll-outs nearer than this at half time and end are one
constexpr float kStopShortOfEndM = 1.0F;  // before the end of a road
constexpr float kPassedM = 0.5F;          // a stopping place this far behind us is passed
constexpr float kOnPlanM = 0.01F;         // from where we start exactly on it

constexpr float kMaxLeadS = 0.5F;  // plan start after the scene's time

/// One path with all that its candidates share.
struct Course {
  ReferenceCoordinates where;  ///< of the start
  Leader leader;
  float leader_touch_s_m = 0.0F;  ///< where our rear axle would be with our front at its rear, at scene time
  float lateral_length_m = 0.0F;
  int attempts = kStretches;                  ///< lateral lengths still worth trying
  BoundedVector<float, kMaxStops> stops_s_m;  ///< of the rear axle, nearest first
};

/// How far a roll-out comes [m]; two of one path that come equally far are twins.
struct Reach {
  std::uint8_t path;
  float half_m;
  float end_m;
};

void add_stop(float s_m, Course& course) {
  if (s_m < course.where.s_m - kPassedM) return;
  for (const float stop_s_m : course.stops_s_m) {
    if (abs(s_m - stop_s_m) < kPassedM) return;
  }
  insert(course.stops_s_m, s_m, [](float a, float b) { return a < b; });
}

/// Whether our box, standing there, keeps clear of the ground shared with others.
bool clear_of_zones(const scene::EgoPath& path, float rear_axle_s_m, const Parameters& parameters) {
  const float centre_s_m = rear_axle_s_m + rear_axle_to_centre_m(parameters);
  for (const scene::ConflictZone& zone : path.zones) {
    if (centre_s_m > zone.entry_s_m - kPassedM && centre_s_m < zone.exit_s_m) return false;
  }
  return true;
}

void find_stops(const scene::Scene& scene, const scene::EgoPath& path, const Parameters& parameters,
                Course& course) {
  const float front_m = rear_axle_to_front_m(parameters);
  const float centre_m = rear_axle_to_centre_m(parameters);
  for (const scene::ConflictZone& zone : path.zones) {
    // Beyond the stop line there is still the zone itself to stop before.
    const float line_s_m = zone.stop_s_m - front_m;
    const float edge_s_m = zone.entry_s_m - centre_m - scene::kStopMarginM;
    const bool passed = line_s_m < course.where.s_m - kPassedM;
    if (!passed) add_stop(line_s_m, course);
    if (passed && clear_of_zones(path, edge_s_m, parameters)) add_stop(edge_s_m, course);
  }
  const float end_s_m = dead_end_s_m(scene, path);
  if (end_s_m >= kNoDeadEndM) return;
  const float last_s_m = end_s_m - front_m - kStopShortOfEndM;
  add_stop(last_s_m, course);
  add_stop(last_s_m - change_room_m(scene, path), course);
}

void prepare(const scene::Scene& scene, const scene::EgoPath& path, const TrajectoryPoint& start,
             float lead_s, const Parameters& parameters, const ReferenceLine& line, Course& course,
             WorkMeter& meter) {
  const float guess_s_m = path.frenet.s_m + lead_s * scene.ego.speed_mps;
  course.where = locate_on(line, position(start.rear_axle), guess_s_m);
  course.leader = find_leader(scene, path, path.frenet.s_m, parameters);
  course.leader_touch_s_m = path.frenet.s_m + course.leader.gap_m;
  find_stops(scene, path, parameters, course);
  meter.spend(kPrepareWork + course.leader.work);
}

/// Whether the running plan goes on from exactly here. Where it leads, its manoeuvre says.
bool continues(const Plan& running, const TrajectoryPoint& start, std::uint32_t start_ms) {
  if (running.kind != PlanKind::kDrive || !plan_covers(running, start_ms)) return false;
  if (static_cast<std::int32_t>(start_ms - running.start_ms) % kStepMs != 0) return false;
  const TrajectoryPoint planned = sample(running, start_ms);
  return distance(position(planned.rear_axle), position(start.rear_axle)) <= kOnPlanM;
}

Reach reach_of(const Candidate& candidate, const Trajectory& trajectory) {
  const Point start = position(trajectory.points[0].rear_axle);
  return {candidate.path, distance(start, position(trajectory.points[kHorizonSteps / 2].rear_axle)),
          distance(start, position(trajectory.points[kHorizonSteps].rear_axle))};
}

bool has_twin(const Reach* reaches, int count, const Reach& reach) {
  for (int i = 0; i < count; ++i) {
    if (reaches[i].path == reach.path && abs(reaches[i].half_m - reach.half_m) < kAlikeM &&
        abs(reaches[i].end_m - reach.end_m) < kAlikeM)
      return true;
  }
  return false;
}

/// The gap's place; in our own lane one behind our leader where that is nearer, now or at the horizon's end.
bool aim_at_gap(const scene::Scene& scene, const Course& course, float lead_s, const MergeTarget& aim,
                const Parameters& parameters, Candidate& candidate) {
  if (aim.path == 0 || (candidate.path != 0 && candidate.path != aim.path)) return false;
  candidate.in_gap = true;
  candidate.target_s_m = aim.s_m + scene.ego_paths[candidate.path].frenet.s_m - scene.ego_paths[0].frenet.s_m;
  candidate.target_speed_mps = aim.speed_mps;
  if (candidate.path != 0 || course.leader.agent < 0) return true;
  const float leader_mps = course.leader.speed_mps;
  const float distance_m = parameters.comfort.standstill_gap_m + parameters.comfort.headway_s * leader_mps;
  const float behind_s_m = course.leader_touch_s_m + lead_s * leader_mps - distance_m;
  const float end_s_m =
      min(aim.s_m + kHorizonS * aim.speed_mps, max(course.where.s_m, behind_s_m + kHorizonS * leader_mps));
  candidate.target_s_m = min(aim.s_m, behind_s_m);
  candidate.target_speed_mps = (end_s_m - candidate.target_s_m) / kHorizonS;
  return true;
}

/// The longitudinal half of a recipe. \param goes_on  the running plan does, here \return false when this path has no such
/// thing
bool shape_longitudinal(const scene::Scene& scene, const Trial& trial, const Course& course,
                        const TrajectoryPoint& start, bool goes_on, float lead_s, const MergeTarget& aim,
                        const Parameters& parameters, Candidate& candidate) {
  candidate.intent = trial.intent;
  candidate.acceleration_mps2 = parameters.comfort.acceleration_mps2;
  switch (trial.intent) {
    case Intent::kAccelerate:
      candidate.acceleration_mps2 = clamp(trial.acceleration_mps2, -parameters.guard.braking_mps2,
                                          kDriveShare * parameters.vehicle.acceleration_max_mps2);
      return true;
    case Intent::kStop:
      if (trial.line >= course.stops_s_m.size()) return false;
      candidate.target_s_m = course.stops_s_m[trial.line];
      return square(start.speed_mps) <= 2.0F * parameters.vehicle.braking_max_mps2 *
                                            max(kLeastRoomM, candidate.target_s_m - course.where.s_m);
    case Intent::kFollow:
      if (trial.line == 1) return aim_at_gap(scene, course, lead_s, aim, parameters, candidate);
      if (course.leader.agent < 0) return false;
      candidate.target_s_m = course.leader_touch_s_m + lead_s * course.leader.speed_mps;
      candidate.target_speed_mps = course.leader.speed_mps;
      return true;
    case Intent::kPrevious:
      return goes_on;
  }
  return false;
}

/// Finds a lateral length with which the candidate can be driven, or else steers. \return false: neither
bool make_feasible(const ReferenceLine& line, const TrajectoryPoint& start, const Plan& running,
                   std::uint32_t start_ms, const Parameters& parameters, Course& course, Candidate& candidate,
                   CandidateVisitor& visitor) {
  Trajectory& trajectory = visitor.rolled_out;
  visitor.meter.spend(kTrialWork);
  for (int i = 0; i < course.attempts; ++i) {
    shape_lateral(line, start, course.where, course.lateral_length_m, candidate);
    if (candidate.intent != Intent::kPrevious && overshoots(candidate)) break;  // longer goes further out
    ++visitor.roll_outs;
    visitor.meter.spend(kRollOutWork);
    roll_out(line, candidate, start, running, start_ms, parameters, trajectory);
    if (feasible(trajectory, parameters)) return true;
    if (candidate.intent == Intent::kPrevious) break;
    if (i + 1 < course.attempts) course.lateral_length_m *= kStretch;
  }
  if (candidate.intent != Intent::kPrevious) course.attempts = 1;
  candidate.steered = true;
  visitor.roll_outs += kSteeredRollOuts;
  visitor.meter.spend(kSteeredWork);
  roll_out(line, candidate, start, running, start_ms, parameters, trajectory);
  return feasible(trajectory, parameters);
}

class NobodyLooks final : public CandidateVisitor {
 public:
  using CandidateVisitor::CandidateVisitor;
  void visit(int /*index*/) override {}
};

}  // namespace

void generate_candidates(const scene::Scene& scene, const TrajectoryPoint& start, const Plan& running,
                         std::uint32_t start_ms, const Parameters& parameters, int most,
                         const ReferenceLines& lines, CandidateList& candidates, int& left_out,
                         const MergeTarget& aim) {
  Trajectory trajectory;
  NobodyLooks nobody(trajectory);
  generate_candidates(scene, start, running, start_ms, parameters, most, lines, candidates, left_out, nobody,
                      aim);
}

void generate_candidates(const scene::Scene& scene, const TrajectoryPoint& start, const Plan& running,
                         std::uint32_t start_ms, const Parameters& parameters, int most,
                         const ReferenceLines& lines, CandidateList& candidates, int& left_out,
                         CandidateVisitor& visitor, const MergeTarget& aim) {
  candidates.clear();
  left_out = 0;
  if (scene.map == nullptr) return;
  const std::int32_t lead_ms = static_cast<std::int32_t>(start_ms - scene.time_ms);
  const float lead_s = clamp(0.001F * static_cast<float>(lead_ms), 0.0F, kMaxLeadS);
  constexpr int kPaths = decltype(scene::Scene::ego_paths)::kCapacity;
  Course courses[kPaths];
  // To go on with the manoeuvre in force, then to give it up: what there is no room for is neither.
  const int in_force = behavior::leads_to(running.manoeuvre, scene);
  int order[kPaths];
  order[0] = in_force;
  int count = 1;
  for (int path = 0; path < scene.ego_paths.size(); ++path) {
    if (path != in_force) order[count++] = path;
  }
  int paths = 0;  // that can be prepared with the work there is
  for (; paths < scene.ego_paths.size() && visitor.meter.left > 0; ++paths) {
    const int path = order[paths];
    prepare(scene, scene.ego_paths[path], start, lead_s, parameters, lines[path], courses[path],
            visitor.meter);
    visitor.leaders[path] = courses[path].leader;
  }
  const bool goes_on = continues(running, start, start_ms);
  Trajectory& trajectory = visitor.rolled_out;
  Reach reaches[kMaxCandidates];
  for (int round = 0; round < kRoundCount; ++round) {
    for (int place = 0; place < paths; ++place) {
      const int path = order[place];
      const ReferenceLine& line = lines[path];
      Course& course = courses[path];
      course.lateral_length_m = lateral_length_m(line, start, course.where, parameters);
      course.attempts = kStretches;
      for (int k = kRounds[round]; k < kRounds[round + 1]; ++k) {
        Candidate candidate;
        candidate.path = static_cast<std::uint8_t>(path);
        if (!shape_longitudinal(scene, kTrials[k], course, start, goes_on && path == in_force, lead_s, aim,
                                parameters, candidate))
          continue;
        const bool done = visitor.roll_outs + kStretches + kSteeredRollOuts > kMaxRollOuts ||
                          !visitor.meter.allows(kMostTrialWork);
        if (done || (candidates.size() >= most && !candidates.full())) {
          ++left_out;
          continue;
        }
        if (!make_feasible(line, start, running, start_ms, parameters, course, candidate, visitor)) continue;
        const Reach reach = reach_of(candidate, trajectory);
        if (candidate.intent != Intent::kPrevious && has_twin(reaches, candidates.size(), reach)) continue;
        if (!candidates.push(candidate)) {
          ++left_out;
          continue;
        }
        reaches[candidates.size() - 1] = reach;
        visitor.visit(candidates.size() - 1);
      }
    }
  }
}

}  // namespace s4tp::trajectory
