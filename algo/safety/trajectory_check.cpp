#include "algo/safety/trajectory_check.hpp"

#include "algo/core/inline.hpp"
#include "algo/safety/lane_change.hpp"
#include "algo/safety/right_of_way.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/standing_room.hpp"

namespace s4tp {
namespace {

constexpr int kKeepGoingSteps = 15;  // 1.5 s: longer nobody just keeps going
constexpr float kInLaneM = 1.0F;  // nearer to a path's centre we are in that lane, and those behind follow us
constexpr float kDeeperM = 0.3F;  // boxes that touch from the start count once this much deeper
constexpr float kRoundingM = 0.01F;  // more than what rounding can change in a distance within reach
constexpr float kShareKept = 0.5F;   // of a gap that was below the margin from the start

/// 0 times anything else is not a number.
bool finite(const TrajectoryPoint& point) {
  const Pose& pose = point.rear_axle;
  return 0.0F * pose.x_m + 0.0F * pose.y_m + 0.0F * pose.heading_rad + 0.0F * point.speed_mps +
             0.0F * point.acceleration_mps2 + 0.0F * point.curvature_1pm ==
         0.0F;
}

bool finite(const Trajectory& trajectory) {
  for (const TrajectoryPoint& point : trajectory.points) {
    if (!finite(point)) return false;
  }
  return true;
}

/// Who drives behind us in the lane we are in is to keep his distance: being hit from behind is no reason to
/// stand in nobody's way by doing something worse.
bool follows_us(const Scene& scene, const EgoPath& path, const Agent& agent, const Parameters& parameters) {
  if (abs(path.frenet.d_m) > kInLaneM) return false;
  bool known = false;
  const OnPath seen = see_on_path(scene, path, agent, parameters, false, known);
  if (!known || !seen.overlaps || seen.crossing || seen.along_mps < 0.0F) return false;
  return seen.centre_s_m + seen.half_length_m < path.frenet.s_m + rear_axle_to_centre_m(parameters);
}

bool follows_us(const Scene& scene, int path, const Agent& agent, const Parameters& parameters) {
  return follows_us(scene, scene.ego_paths[path], agent, parameters) ||
         (path != 0 && follows_us(scene, scene.ego_paths[0], agent, parameters));
}

/// Whether it can brake gently enough to stay behind us, whose change into its lane is under way.
bool lets_us_in(const Scene& scene, const EgoPath& path, const Trajectory& trajectory, const Agent& agent,
                const Parameters& parameters) {
  if (!change_under_way(scene, path, trajectory.points[0], parameters)) return false;
  bool known = false;
  const bool joining = joins(scene, path, agent);
  const OnPath seen = see_on_path(scene, path, agent, parameters, joining, known);
  if (!known || seen.crossing || seen.along_mps < 0.0F || !(seen.overlaps || joining)) return false;
  const float rear_s_m = path.frenet.s_m - parameters.vehicle.rear_overhang_m;
  return can_stay_behind(rear_s_m - seen.centre_s_m - seen.half_length_m, seen.along_mps, trajectory);
}

bool has(std::uint16_t agents, int index) {
  return (agents >> index & 1U) != 0;
}

/// Our boxes along a trajectory, made as they are needed, for looks at many futures.
class OwnBoxes {
 public:
  OwnBoxes(const Trajectory& trajectory, const Parameters& parameters)
      : trajectory_(trajectory), vehicle_(parameters.vehicle), centre_m_(rear_axle_to_centre_m(parameters)) {
    float longest_m2 = 0.0F;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      const Point moved = rear_axle(i) - rear_axle(i - 1);
      longest_m2 = max(longest_m2, dot(moved, moved));
    }
    longest_step_m_ = sqrt(longest_m2);
  }

  /// At trajectory point `point`.
  [[nodiscard]] Point rear_axle(int point) const { return position(trajectory_.points[point].rear_axle); }
  /// From one point to the next at most.
  [[nodiscard]] float longest_step_m() const { return longest_step_m_; }
  /// From rear axle to the other's box centre, and above both half diagonals.
  [[nodiscard]] float reach_m(const Track& other, float margin_m) const {
    return abs(centre_m_) + margin_m +
           0.5F * (vehicle_.length_m + vehicle_.width_m + other.length_m + other.width_m);
  }

  /// Separation at trajectory point `point`, or something smaller that is more than `enough_m`.
  /// \param half_diagonal_m  of the other
  [[nodiscard]] float separation_from(const Box& other, float half_diagonal_m, float enough_m, int point) {
    if ((known_ >> point & 1U) == 0) {
      known_ |= 1U << point;
      turned_[point] = sin_cos(trajectory_.points[point].rear_axle.heading_rad);
    }
    const Point ahead = {turned_[point].cos, turned_[point].sin};
    const Point centre = rear_axle(point) + centre_m_ * ahead;
    const Point offset = position(other.centre) - centre;
    // However it is turned, it reaches no further along our axes than its half diagonal.
    const float along_m = abs(dot(ahead, offset)) - 0.5F * vehicle_.length_m;
    const float across_m = abs(cross(ahead, offset)) - 0.5F * vehicle_.width_m;
    const float least_m = max(along_m, across_m) - half_diagonal_m - kRoundingM;
    if (least_m > enough_m) return least_m;
    const Box own = {{centre.x_m, centre.y_m, 0.0F}, vehicle_.length_m, vehicle_.width_m};
    return separation(own, ahead, other, direction(other.centre.heading_rad));
  }

 private:
  const Trajectory& trajectory_;
  const decltype(Parameters::vehicle)& vehicle_;
  float centre_m_;
  float longest_step_m_;
  std::uint32_t known_ = 0;  ///< a bit a point
  SinCos turned_[kTrajectoryPoints];
};
static_assert(kTrajectoryPoints <= 32);

int first_collision(OwnBoxes& own, const Mode& mode, const Track& track, int steps, float margin_m) {
  const float reach_m = own.reach_m(track, margin_m);
  const float half_diagonal_m = 0.5F * norm({track.length_m, track.width_m});
  const float closing_m = own.longest_step_m() + 0.01F * static_cast<float>(mode.longest_step_cm);
  constexpr int kFarSteps = 12;
  constexpr int kNearSteps = 3;
  const float far_m = reach_m + kRoundingM + static_cast<float>(kFarSteps) * closing_m;
  const float near_m = reach_m + kRoundingM + static_cast<float>(kNearSteps) * closing_m;
  float least_m = margin_m;
  for (int i = 0; i < steps && i < kHorizonSteps; ++i) {
    const Point apart = own.rear_axle(i + 1) - position(mode.steps[i]);
    const float apart_m2 = dot(apart, apart);
    if (apart_m2 > square(reach_m)) {
      // So far apart they stay out of reach for some steps to come.
      i += apart_m2 > square(far_m) ? kFarSteps : (apart_m2 > square(near_m) ? kNearSteps : 0);
      continue;
    }
    const Box box = {mode.steps[i], track.length_m, track.width_m};
    const float gap_m = own.separation_from(box, half_diagonal_m, least_m, i + 1);
    if (gap_m >= least_m) continue;
    if (i > 0) return i;
    // So near already, and nothing can be done about the first step: it must not get much worse.
    least_m = gap_m > 0.0F ? kShareKept * gap_m : gap_m - kDeeperM;
  }
  return -1;
}

/// Looks through the futures of the watched vehicles.
bool clear_of(const Scene& scene, int path, const Trajectory& trajectory, OwnBoxes& own,
              const PredictionSet& prediction, std::uint16_t trusted, const Parameters& parameters,
              CheckReport& report) {
  for (const AgentPrediction& predicted : prediction.agents) {
    if (has(trusted, predicted.agent)) continue;
    const Agent& agent = scene.agents[predicted.agent];
    for (const Mode& mode : predicted.modes) {
      const int step = first_collision(own, mode, agent.track, kHorizonSteps, parameters.safety.margin_m);
      if (step < 0) continue;
      if (!mode.yields && will_yield(scene.ego_paths[path], agent)) continue;
      if (lets_us_in(scene, scene.ego_paths[path], trajectory, agent, parameters)) break;
      if (follows_us(scene, path, agent, parameters)) break;
      report = {CheckResult::kCollision, predicted.agent, static_cast<std::uint8_t>(step)};
      return false;
    }
  }
  return true;
}

bool clear_of(const Scene& scene, int path, const Trajectory& trajectory, OwnBoxes& own,
              const KinematicSet& keep_going, std::uint16_t trusted, const Parameters& parameters,
              CheckReport& report) {
  const int count =
      keep_going.agents.size() < scene.agents.size() ? keep_going.agents.size() : scene.agents.size();
  for (int i = 0; i < count; ++i) {
    const Agent& agent = scene.agents[i];
    const bool stays = has(trusted, i) && is_standing(agent);
    if (has(trusted, i) && !stays) continue;
    const int step = first_collision(own, keep_going.agents[i], agent.track,
                                     stays ? kHorizonSteps : kKeepGoingSteps, parameters.safety.margin_m);
    if (step < 0 || will_yield(scene.ego_paths[path], agent) ||
        lets_us_in(scene, scene.ego_paths[path], trajectory, agent, parameters) ||
        follows_us(scene, path, agent, parameters))
      continue;
    report = {CheckResult::kCollision, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(step)};
    return false;
  }
  return true;
}

}  // namespace

int first_collision(const Trajectory& trajectory, const Mode& mode, const Track& track, int steps,
                    float margin_m, const Parameters& parameters) {
  OwnBoxes own(trajectory, parameters);
  return first_collision(own, mode, track, steps, margin_m);
}

CheckReport check_trajectory(const Scene& scene, int ego_path, const Trajectory& trajectory,
                             const PredictionSet& unconditioned, const PredictionSet& conditioned,
                             const KinematicSet& keep_going, const Parameters& parameters) {
  CheckReport report;
  report.result = CheckResult::kInfeasible;
  if (finite(trajectory) && !feasible(trajectory, parameters)) return report;
  const PathSight sight = look_along(scene, ego_path, trajectory.points[0], parameters);
  return check_feasible(scene, ego_path, sight, trajectory, unconditioned, conditioned, keep_going,
                        parameters);
}

CheckReport check_feasible(const Scene& scene, int ego_path, const PathSight& sight,
                           const Trajectory& trajectory, const PredictionSet& unconditioned,
                           const PredictionSet& conditioned, const KinematicSet& keep_going,
                           const Parameters& parameters) {
  CheckReport report;
  if (!finite(trajectory)) {
    report.result = CheckResult::kNotFinite;
    return report;
  }
  OwnBoxes own(trajectory, parameters);
  const TerminalVerdict verdict = judge_terminal(scene, ego_path, sight, trajectory, parameters);
  if (ego_path < 0 || ego_path >= scene.ego_paths.size() ||  // then nothing is known of the end
      (clear_of(scene, ego_path, trajectory, own, keep_going, verdict.trusted, parameters, report) &&
       clear_of(scene, ego_path, trajectory, own, unconditioned, verdict.trusted, parameters, report) &&
       clear_of(scene, ego_path, trajectory, own, conditioned, verdict.trusted, parameters, report))) {
    if (!verdict.safe()) {
      report = {CheckResult::kTerminal, verdict.agent, 0, verdict.cause, verdict.arrives_s, verdict.needed_s};
    }
  }
  return report;
}

}  // namespace s4tp
