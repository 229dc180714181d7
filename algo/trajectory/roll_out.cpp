#include "algo/trajectory/roll_out.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/speed_profile.hpp"
#include "algo/trajectory/steering.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kMaxSlope = 2.0F;         // tangent of the largest heading error a path can start with
constexpr float kMinStretch = 0.2F;       // 1 - curvature d: beyond, the line's centre of curvature is near
constexpr float kTailBrakingMps2 = 5.0F;  // bounds of what a continued plan may go on with
constexpr float kTailDriveMps2 = 1.0F;

constexpr float kShortestM = 4.0F;       // of a lateral motion
constexpr float kGentleBend1pm = 0.09F;  // curvature of a slow lane change, under half of what we can steer
constexpr float kLateralMps2 = 2.0F;     // peak lateral acceleration of a lane change at speed
constexpr float kQuickestShare = 0.4F;   // of the usual duration of a lane change, at least
constexpr float kStraightSlope = 0.02F;
constexpr float kSteepestRad = 1.2F;  // off the line: kMaxSlope bounds its tangent sooner
constexpr float kPeak = 5.77F;        // a quintic from rest to rest bends by 5.77 d / length^2
constexpr float kTurnBackM = 40.0F;  // way per slope to turn back from heading away: bends by 0.1 / m at most
constexpr float kTurnBackS2pm = 1.6F;  // and at speed by 2.5 m/s^2
constexpr float kSwingM = 0.3F;
constexpr int kSwingSamples = 10;
constexpr float kOnLineM = 0.3F;     // a plan's end nearer than this has arrived ...
constexpr float kAcrossRad = 1.1F;   // ... unless it heads across the line: no quintic begins so (kMaxSlope)
constexpr int kSteeredAnew = 10;     // steps at the end of a plan that has not
constexpr float kSlopeShare = 2.0F;  // way / d at which a quintic goes on from a slope without a jerk

/// d and its derivatives by the line's own way.
struct Lateral {
  float d_m;
  float slope;
  float bend_1pm;
};

/// d after a `part` of the lateral motion, 0 .. 1.
float offset_m(const Candidate& candidate, float part) {
  const float* c = candidate.lateral;
  return ((((c[5] * part + c[4]) * part + c[3]) * part + c[2]) * part + c[1]) * part + c[0];
}

/// \param way_per_s  metres of the line in one of s (reference_way_per_s)
Lateral lateral_at(const Candidate& candidate, float s_m, float way_per_s) {
  const float* c = candidate.lateral;
  const float u = (s_m - candidate.start_s_m) / candidate.lateral_length_m;
  if (u >= 1.0F) return {offset_m(candidate, 1.0F), 0.0F, 0.0F};
  const float v = max(u, 0.0F);
  const float per_m = 1.0F / (candidate.lateral_length_m * way_per_s);
  const float d1 = (((5.0F * c[5] * v + 4.0F * c[4]) * v + 3.0F * c[3]) * v + 2.0F * c[2]) * v + c[1];
  const float d2 = ((20.0F * c[5] * v + 12.0F * c[4]) * v + 6.0F * c[3]) * v + 2.0F * c[2];
  return {offset_m(candidate, v), d1 * per_m, d2 * per_m * per_m};
}

/// Slope of the line's curvature [1/m^2].
float curvature_slope(const ReferenceLine& line, float s_m, float way_per_s) {
  const float h_m = line.spacing_m;
  return (curvature_at(line, s_m + h_m) - curvature_at(line, s_m - h_m)) / (2.0F * h_m * way_per_s);
}

/// Writes pose and curvature at `s_m`. \return ds per metre of our own way
float place(const ReferenceLine& line, const Candidate& candidate, float s_m, TrajectoryPoint& point) {
  const ReferenceLine::Sample centre = reference_at(line, s_m);
  const float way_per_s = reference_way_per_s(line, s_m);
  const Lateral lateral = lateral_at(candidate, s_m, way_per_s);
  const float k = centre.curvature_1pm;
  const float stretch = max(kMinStretch, 1.0F - k * lateral.d_m);
  const float tangent = clamp(lateral.slope / stretch, -kMaxSlope, kMaxSlope);
  const float cosine = 1.0F / sqrt(1.0F + square(tangent));
  // kappa' d is left out while we are within a metre of a line: it is below 0.02 / m even in a tight turn.
  const float k_slope = abs(lateral.d_m) > 1.0F ? curvature_slope(line, s_m, way_per_s) : 0.0F;
  const float own_bend = lateral.bend_1pm + (k_slope * lateral.d_m + k * lateral.slope) * tangent;

  const Point side = direction(centre.pose.heading_rad);
  point.rear_axle.x_m = centre.pose.x_m - lateral.d_m * side.y_m;
  point.rear_axle.y_m = centre.pose.y_m + lateral.d_m * side.x_m;
  point.rear_axle.heading_rad = wrap_angle(centre.pose.heading_rad + atan(tangent));
  point.curvature_1pm = (own_bend * square(cosine) / stretch + k) * cosine / stretch;
  return cosine / (stretch * way_per_s);
}

/// Marches from points[first], which is set, to the end.
void march(const ReferenceLine& line, const Candidate& candidate, int first, const Parameters& parameters,
           Trajectory& trajectory) {
  const TrajectoryPoint& from = trajectory.points[first];
  LongitudinalState state{candidate.start_s_m, from.speed_mps, from.acceleration_mps2};
  const SteeringLimits limits = candidate.steered ? steering_limits(parameters) : SteeringLimits{};
  TrajectoryPoint scratch;
  float s_per_m = candidate.steered ? 1.0F : place(line, candidate, state.s_m, scratch);
  for (int i = first + 1; i < kTrajectoryPoints; ++i) {
    const float time_s = static_cast<float>(i - 1 - first) * kStepS;
    const float wanted = wanted_acceleration(line, candidate, state, time_s, parameters);
    const float way_m = advance(wanted, parameters, state);
    TrajectoryPoint& point = trajectory.points[i];
    point = trajectory.points[i - 1];  // at rest pose and curvature stay, bit for bit
    point.speed_mps = state.speed_mps;
    if (way_m > 0.0F && candidate.steered) {
      steer_step(line, way_m, limits, state.s_m, point);
    } else if (way_m > 0.0F) {
      state.s_m = state.s_m + way_m * s_per_m;
      s_per_m = place(line, candidate, state.s_m, point);
    }
    point.acceleration_mps2 = state.acceleration_mps2;
  }
}

/// Steers points[first + 1] to points[last] to the line, each at its own speed. \return s at the last one
float steer_to_line(const ReferenceLine& line, int first, int last, float s_m, const Parameters& parameters,
                    Trajectory& trajectory) {
  const SteeringLimits limits = steering_limits(parameters);
  for (int i = first + 1; i <= last; ++i) {
    const TrajectoryPoint& before = trajectory.points[i - 1];
    TrajectoryPoint& point = trajectory.points[i];
    const float way_m = 0.5F * (before.speed_mps + point.speed_mps) * kStepS;
    point.rear_axle = before.rear_axle;
    point.curvature_1pm = before.curvature_1pm;
    if (way_m > 0.0F) steer_step(line, way_m, limits, s_m, point);
  }
  return s_m;
}

/// The running plan from `start_ms` on, then on along the line.
void shift_plan(const ReferenceLine& line, const Candidate& candidate, const Plan& running,
                std::uint32_t start_ms, const Parameters& parameters, Trajectory& trajectory) {
  const std::int32_t elapsed_ms = static_cast<std::int32_t>(start_ms - running.start_ms);
  const int shift = elapsed_ms / kStepMs < kHorizonSteps ? elapsed_ms / kStepMs : kHorizonSteps;
  const int last = kHorizonSteps - shift;  // index of the plan's last point in the new one
  for (int i = 1; i <= last; ++i) trajectory.points[i] = running.trajectory.points[i + shift];
  if (shift == 0) return;

  const auto locate = [&](int index) {
    const Point there = position(trajectory.points[index].rear_axle);
    const Point start = position(trajectory.points[0].rear_axle);
    return locate_on(line, there, candidate.start_s_m + distance(start, there));
  };
  const TrajectoryPoint& end = trajectory.points[last];
  Candidate tail = candidate;
  tail.intent = Intent::kAccelerate;
  tail.acceleration_mps2 = clamp(end.acceleration_mps2, -kTailBrakingMps2, kTailDriveMps2);
  const ReferenceCoordinates where = locate(last);
  const float error_rad =
      wrap_angle(end.rear_axle.heading_rad - reference_at(line, where.s_m).pose.heading_rad);
  if (abs(where.d_m - line.lateral_offset_m) > kOnLineM || abs(error_rad) > kAcrossRad) {
    // Still on its way to the line: one step more at a time, smoothed each time, would carry it across.
    const int first = last > kSteeredAnew ? last - kSteeredAnew : 0;
    tail.steered = true;
    tail.start_s_m = steer_to_line(line, first, last, locate(first).s_m, parameters, trajectory);
  } else {
    shape_lateral(line, end, where, candidate.lateral_length_m, tail);
  }
  march(line, tail, last, parameters, trajectory);
}

}  // namespace

float lateral_length_m(const ReferenceLine& line, const TrajectoryPoint& start, ReferenceCoordinates where,
                       const Parameters& parameters) {
  const float d_m = where.d_m - line.lateral_offset_m;
  const float offset_m = abs(d_m);
  const float change_s = parameters.comfort.lane_change_s;
  const float at_speed_m =
      start.speed_mps * clamp(sqrt(kPeak * offset_m / kLateralMps2), kQuickestShare * change_s, change_s);
  const float slow_m = sqrt(kPeak * offset_m / kGentleBend1pm);
  const float fresh_m = max(kShortestM, max(at_speed_m, slow_m));

  const ReferenceLine::Sample centre = reference_at(line, where.s_m);
  const float slope =
      tan(clamp(wrap_angle(start.rear_axle.heading_rad - centre.pose.heading_rad), -1.0F, 1.0F));
  const bool towards = slope * d_m < 0.0F && abs(slope) > kStraightSlope;
  if (!towards) return max(fresh_m, abs(slope) * max(kTurnBackM, kTurnBackS2pm * square(start.speed_mps)));
  return clamp(kSlopeShare * offset_m / abs(slope), max(kShortestM, 0.5F * fresh_m), fresh_m);
}

void shape_lateral(const ReferenceLine& line, const TrajectoryPoint& start, ReferenceCoordinates where,
                   float length_m, Candidate& candidate) {
  const ReferenceLine::Sample centre = reference_at(line, where.s_m);
  const float k = centre.curvature_1pm;
  const float stretch = max(kMinStretch, 1.0F - k * where.d_m);
  const float error_rad = wrap_angle(start.rear_axle.heading_rad - centre.pose.heading_rad);
  const float tangent = clamp(tan(clamp(error_rad, -kSteepestRad, kSteepestRad)), -kMaxSlope, kMaxSlope);
  const float cosine = 1.0F / sqrt(1.0F + square(tangent));
  const float slope = tangent * stretch;
  const float way_per_s = reference_way_per_s(line, where.s_m);
  const float k_slope = abs(where.d_m) > 1.0F ? curvature_slope(line, where.s_m, way_per_s) : 0.0F;
  // place() solved for d'': the path leaves with the curvature that is steered now.
  const float bend = (start.curvature_1pm * stretch / cosine - k) * stretch / square(cosine) -
                     (k_slope * where.d_m + k * slope) * tangent;

  const float c0 = where.d_m;
  const float way_m = length_m * way_per_s;
  const float c1 = slope * way_m;
  const float c2 = 0.5F * bend * way_m * way_m;
  const float h = line.lateral_offset_m - ((c0 + c1) + c2);
  const float g = -(c1 + 2.0F * c2);
  const float f = -2.0F * c2;
  candidate.lateral[0] = c0;
  candidate.lateral[1] = c1;
  candidate.lateral[2] = c2;
  candidate.lateral[3] = (10.0F * h - 4.0F * g) + 0.5F * f;
  candidate.lateral[4] = (-15.0F * h + 7.0F * g) - f;
  candidate.lateral[5] = (6.0F * h - 3.0F * g) + 0.5F * f;
  candidate.lateral_length_m = length_m;
  candidate.start_s_m = where.s_m;
}

bool overshoots(const Candidate& candidate) {
  const float start_m = candidate.lateral[0];
  const float end_m = offset_m(candidate, 1.0F);
  const float right_m = min(start_m, end_m) - kSwingM;
  const float left_m = max(start_m, end_m) + kSwingM;
  for (int i = 1; i < kSwingSamples; ++i) {
    const float d_m = offset_m(candidate, static_cast<float>(i) / static_cast<float>(kSwingSamples));
    if (d_m < right_m || d_m > left_m) return true;
  }
  return false;
}

void roll_out(const ReferenceLine& line, const Candidate& candidate, const TrajectoryPoint& start,
              const Plan& running, std::uint32_t start_ms, const Parameters& parameters,
              Trajectory& trajectory) {
  trajectory.points[0] = start;
  if (candidate.intent == Intent::kPrevious && plan_covers(running, start_ms)) {
    shift_plan(line, candidate, running, start_ms, parameters, trajectory);
  } else {
    march(line, candidate, 0, parameters, trajectory);
  }
}

}  // namespace s4tp::trajectory
