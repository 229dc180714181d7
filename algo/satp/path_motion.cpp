#include "algo/satp/path_motion.hpp"

#include "algo/core/inline.hpp"
#include "algo/satp/car_following.hpp"

namespace s4tp::satp {
namespace {

constexpr int kStepsPerUpdate = 2;  // drivers are updated every 0.2 s
constexpr float kHardestMps2 = 6.0F;
constexpr float kSlowDownMps2 = 2.0F;
constexpr float kUnbound = 1e3F;
constexpr float kHabitS = 1.5F;
constexpr float kHabitMax = 3.0F;     // m/s^2
constexpr float kReturnS = 1.2F;      // a small heading error is corrected within this
constexpr float kReturnSPerM = 0.5F;  // and a lane change of 3.2 m takes 2.8 s
constexpr float kReturnLongestM = 3.2F;
constexpr float kReturnM = 8.0F;  // at least
constexpr float kSlopeMax = 0.3F;
constexpr float kSlopeSpanM = 3.0F;  // a slope of this over the span leads astray by 4/27 of it: 0.44 m
static_assert(kHorizonSteps % kStepsPerUpdate == 0, "updates span the horizon");

float desired_at(const PathHypothesis& hypothesis, float s_m) {
  if (hypothesis.slow_to_s_m <= 0.0F) return hypothesis.desired_mps;
  if (s_m >= hypothesis.slow_to_s_m) return hypothesis.after_mps;
  if (s_m >= hypothesis.slow_from_s_m) return hypothesis.slow_mps;
  return min(hypothesis.desired_mps,
             sqrt(square(hypothesis.slow_mps) + 2.0F * kSlowDownMps2 * (hypothesis.slow_from_s_m - s_m)));
}

float hold_acceleration(const Hold& hold, float time_s, float s_m, float speed_mps) {
  if (time_s >= hold.until_s || s_m > hold.s_m + 0.5F) return kUnbound;
  return following_acceleration(speed_mps, hold.s_m - s_m + kStandstillGapM, 0.0F, 0.5F);
}

// With its lane, its leader and whom it gives way to, but without us.
float acceleration_alone(const PathHypothesis& hypothesis, float time_s, float s_m, float speed_mps,
                         float half_length_m) {
  const Hold own_hold{hypothesis.hold_s_m, hypothesis.hold_until_s};
  float alone_mps2 = min(free_acceleration(speed_mps, desired_at(hypothesis, s_m)),
                         hold_acceleration(own_hold, time_s, s_m, speed_mps));
  if (hypothesis.follows) {
    const float gap_m = hypothesis.leader_rear_s_m + hypothesis.leader_mps * time_s - s_m - half_length_m;
    alone_mps2 = min(alone_mps2,
                     following_acceleration(speed_mps, gap_m, hypothesis.leader_mps, hypothesis.headway_s));
  }
  return max(alone_mps2, -kHardestMps2);
}

// What our being on its path leaves room for. A vehicle that finds us entering ahead opens the gap at once
// (the model's plain form); one that has followed us all along keeps the headway it has.
float ego_acceleration(const EgoOnPath& ego, float time_s, float s_m, float speed_mps, float half_length_m,
                       float free_mps2) {
  if (!ego.ever) return kUnbound;
  const float knot = time_s / kEgoKnotS;
  const int index = to_int(floor(knot), 0, kEgoKnots - 2);
  if (!ego.present[index]) return kUnbound;
  const float part = clamp(knot - static_cast<float>(index), 0.0F, 1.0F);
  if (lerp(ego.centre_s_m[index], ego.centre_s_m[index + 1], part) <= s_m) return kUnbound;
  const float gap_m = lerp(ego.rear_s_m[index], ego.rear_s_m[index + 1], part) - s_m - half_length_m;
  const float ego_mps = lerp(ego.speed_mps[index], ego.speed_mps[index + 1], part);
  if (ego.from_start) return following_acceleration(speed_mps, gap_m, ego_mps, ego.headway_s);
  const float opening = following_acceleration(speed_mps, gap_m, ego_mps, kUsualHeadwayS) - kAccelerationMps2;
  return free_mps2 + opening;
}

}  // namespace

float undisturbed_acceleration(const PathHypothesis& hypothesis, const Track& track) {
  return acceleration_alone(hypothesis, 0.0F, hypothesis.start_s_m, hypothesis.speed_mps,
                            0.5F * track.length_m);
}

void drive(const PathHypothesis& hypothesis, const Track& track, const EgoOnPath& ego, const Hold& hold,
           PathMotion& motion) {
  const float half_length_m = 0.5F * track.length_m;
  float s_m = hypothesis.start_s_m;
  float speed_mps = hypothesis.speed_mps;
  float habit_mps2 = 0.0F;
  for (int step = 0; step < kHorizonSteps; step += kStepsPerUpdate) {
    const float time_s = kStepS * static_cast<float>(step);
    const float free_mps2 = free_acceleration(speed_mps, desired_at(hypothesis, s_m));
    const float alone_mps2 = acceleration_alone(hypothesis, time_s, s_m, speed_mps, half_length_m);
    // What it does now and the model does not explain fades away; what it does for us comes on top.
    if (step == 0) habit_mps2 = clamp(track.acceleration_mps2 - alone_mps2, -kHabitMax, kHabitMax);
    const float own_mps2 = alone_mps2 + habit_mps2 * max(1.0F - time_s / kHabitS, 0.0F);
    const float for_us_mps2 = min(hold_acceleration(hold, time_s, s_m, speed_mps),
                                  ego_acceleration(ego, time_s, s_m, speed_mps, half_length_m, free_mps2));
    const float acceleration = max(min(own_mps2, for_us_mps2), -kHardestMps2);
    for (int part = 0; part < kStepsPerUpdate; ++part) {
      const float next_mps = max(speed_mps + kStepS * acceleration, 0.0F);
      s_m += 0.5F * kStepS * (speed_mps + next_mps);
      speed_mps = next_mps;
      motion.s_m[step + part] = s_m;
    }
  }
  motion.end_mps = speed_mps;
}

float time_at(const PathHypothesis& hypothesis, const PathMotion& motion, float goal_s_m) {
  if (hypothesis.start_s_m >= goal_s_m) return 0.0F;
  float before_s_m = hypothesis.start_s_m;
  for (int i = 0; i < kHorizonSteps; ++i) {
    if (motion.s_m[i] >= goal_s_m) {
      const float part = (goal_s_m - before_s_m) / max(motion.s_m[i] - before_s_m, 1e-3F);
      return kStepS * (static_cast<float>(i) + clamp(part, 0.0F, 1.0F));
    }
    before_s_m = motion.s_m[i];
  }
  return kStepS * kHorizonSteps + (goal_s_m - before_s_m) / max(motion.end_mps, 0.5F);
}

void place(const LaneMap& map, const scene::LanePath& path, const scene::Frenet& start, const Track& track,
           const PathMotion& motion, Mode& mode) {
  const float return_s = kReturnS + kReturnSPerM * min(abs(start.d_m), kReturnLongestM);
  const float span_m = max(track.speed_mps * return_s, kReturnM);
  const float slope_max = min(kSlopeMax, kSlopeSpanM / span_m);
  const float turn_rad =
      clamp(wrap_angle(track.centre.heading_rad - start.heading_rad), -slope_max, slope_max);
  scene::PathCursor cursor(map, path);
  for (int i = 0; i < kHorizonSteps; ++i) {
    const scene::PathPoint centre = cursor.at(motion.s_m[i]);
    // Cubic from the present offset and slope to the centre line.
    const float u = clamp((motion.s_m[i] - start.s_m) / span_m, 0.0F, 1.0F);
    const float rest = 1.0F - u;
    const float d_m = square(rest) * (start.d_m * (1.0F + 2.0F * u) + turn_rad * span_m * u);
    const float slope = rest * (turn_rad * (1.0F - 3.0F * u) - 6.0F * u * start.d_m / span_m);
    const Point point = offset_point(centre.pose, 0.0F, d_m);
    mode.steps[i] = {point.x_m, point.y_m, wrap_angle(centre.pose.heading_rad + clamp(slope, -1.0F, 1.0F))};
  }
  measure_steps(mode);
}

}  // namespace s4tp::satp
