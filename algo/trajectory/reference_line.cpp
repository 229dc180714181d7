#include "algo/trajectory/reference_line.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/trajectory/bend_widening.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kBehind = 20.0F;             // samples behind the start: a corner is smoothed as a whole
constexpr float kSpacingPerSpeed = 0.0625F;  // s: 64 samples ahead are then 4 s of way
constexpr float kGentle = 0.8F;          // share of comfortable braking used to arrive at a curve or limit
constexpr float kTinyM = 0.01F;          // no division by less
constexpr float kFlat = 1e-3F;           // the same, radian of steering per metre
constexpr float kStraight = 1e-4F;       // sine of a turn between samples that counts as none
constexpr float kSlowestMps = 1.0F;      // a cap never asks for standstill: stops are intents of their own
constexpr float kRateShare = 0.85F;      // of the steering rate: some is left to follow with
constexpr float kBeyondSpacingM = 5.0F;  // of samples for bends beyond the line: a junction's are 6 m long
constexpr int kBeyondSamples = 32;

// Work (WorkMeter's units), beside scene::kSeekWork.
constexpr int kLineWork = 400;
constexpr int kBeyondWork = 3;  // of a sample

/// Triangle of five: weights 1 2 3 2 1.
void smooth(ReferenceLine& line) {
  Point before2 = position(line.samples[0].pose);
  Point before1 = position(line.samples[1].pose);
  for (int i = 2; i + 2 < kReferenceSamples; ++i) {
    Pose& pose = line.samples[i].pose;
    const Point here = position(pose);
    const Point after1 = position(line.samples[i + 1].pose);
    const Point after2 = position(line.samples[i + 2].pose);
    const Point sum = (before2 + after2) + 2.0F * (before1 + after1) + 3.0F * here;
    pose.x_m = sum.x_m / 9.0F;
    pose.y_m = sum.y_m / 9.0F;
    before2 = before1;
    before1 = here;
  }
}

/// Headings by central, curvatures by second differences (the circle through three points).
void differentiate(ReferenceLine& line) {
  Point in = position(line.samples[1].pose) - position(line.samples[0].pose);
  float in_m = max(norm(in), kTinyM);
  float heading_rad = atan2(in.y_m, in.x_m);
  line.samples[0].pose.heading_rad = heading_rad;
  line.samples[0].curvature_1pm = 0.0F;
  for (int i = 1; i + 1 < kReferenceSamples; ++i) {
    ReferenceLine::Sample& sample = line.samples[i];
    const Point out = position(line.samples[i + 1].pose) - position(sample.pose);
    const float out_m = max(norm(out), kTinyM);
    const float turn = cross(in, out) / (in_m * out_m);
    sample.curvature_1pm = 2.0F * turn / (in_m + out_m);
    if (abs(turn) > kStraight) {  // most samples are straight: no arc tangent for them
      const Point along = in + out;
      heading_rad = atan2(along.y_m, along.x_m);
    }
    sample.pose.heading_rad = heading_rad;
    in = out;
    in_m = out_m;
    if (abs(turn) > kStraight) heading_rad = atan2(out.y_m, out.x_m);
  }
  line.samples[kReferenceSamples - 1].pose.heading_rad = heading_rad;
  line.samples[kReferenceSamples - 1].curvature_1pm = 0.0F;
}

/// Speed at which the wheels can be turned as fast as the bend sets in between two samples. \param way_m  from one to the other
float steerable_mps(const ReferenceLine::Sample& here, const ReferenceLine::Sample& next, float way_m,
                    const Parameters& parameters) {
  const float slope_1pm2 = abs(next.curvature_1pm - here.curvature_1pm) / way_m;
  const float rate_radps = kRateShare * parameters.vehicle.steering_rate_max_radps;
  return rate_radps / max(slope_1pm2 * parameters.vehicle.wheelbase_m, kFlat);  // d atan(x) <= dx
}

float bend_speed_mps(float curvature_1pm, const Parameters& parameters) {
  return sqrt(parameters.comfort.lateral_mps2 / max(abs(curvature_1pm), kFlat));
}

/// How fast a plan from `speed_mps` on may be at its end, where it gains speed as long as the limits along the line let it.
float fastest_end_mps(const ReferenceLine& line, float speed_mps, const Parameters& parameters) {
  float limit_mps = 0.0F;
  for (const ReferenceLine::Sample& sample : line.samples) limit_mps = max(limit_mps, sample.speed_cap_mps);
  return max(speed_mps, min(limit_mps, speed_mps + parameters.vehicle.acceleration_max_mps2 * kHorizonS));
}

/// Speed at the line's end with which the bends and limits further on are met in time: a plan ends 3 s ahead, and from there
/// on we may have to brake for longer than the line is. \pre the line's caps are its limits
/// \param work  what it took is added [WorkMeter's units]
float speed_at_end_mps(const LaneMap& map, const scene::LanePath& path, const ReferenceLine& line,
                       float speed_mps, const Parameters& parameters, int& work) {
  const float braking_mps2 = kGentle * parameters.comfort.braking_mps2;
  const float end_s_m = line.start_s_m + static_cast<float>(kReferenceSamples - 1) * line.spacing_m;
  const float plan_end_mps = fastest_end_mps(line, speed_mps, parameters);
  const float planned_m = kHorizonS * 0.5F * (speed_mps + plan_end_mps);
  const float ahead_m = (static_cast<float>(kReferenceSamples - 1) - kBehind) * line.spacing_m;
  const float needed_m = planned_m + occupancy::stopping_way_m(plan_end_mps, braking_mps2) - ahead_m;
  const float reach_m = min(needed_m, path.length_m - end_s_m);
  float end_mps = line.samples[kReferenceSamples - 1].speed_cap_mps;
  if (reach_m <= 0.0F) return end_mps;
  const auto meet = [&](float cap_mps, float beyond_m) {
    end_mps = min(end_mps, sqrt(square(cap_mps) + 2.0F * braking_mps2 * beyond_m));
  };
  for (const scene::PathLane& part : path.lanes) {
    if (part.start_s_m > end_s_m) meet(map.lanes[part.lane].speed_limit_mps, part.start_s_m - end_s_m);
  }
  scene::PathCursor cursor(map, path);
  const int count = to_int(reach_m / kBeyondSpacingM, 0, kBeyondSamples - 1) + 1;
  for (int i = 1; i <= count; ++i) {
    const float beyond_m = reach_m * static_cast<float>(i) / static_cast<float>(count);
    meet(bend_speed_mps(cursor.at(end_s_m + beyond_m).curvature_1pm, parameters), beyond_m);
  }
  work += kBeyondWork * count + scene::kSeekWork * cursor.seeks();
  return end_mps;
}

/// Way from one sample to the next: less than their spacing along the lane where the line cuts a corner.
float way_to_next_m(const ReferenceLine& line, int i) {
  return max(distance(position(line.samples[i].pose), position(line.samples[i + 1].pose)), kTinyM);
}

/// Caps by curves, then backwards: v^2 = v_next^2 + 2 b ds, so that each slower part is reached in time.
void cap_speeds(const Parameters& parameters, float next_mps, ReferenceLine& line) {
  const float gain_mps2 = 2.0F * kGentle * parameters.comfort.braking_mps2;
  float way_m = line.spacing_m;
  for (int i = kReferenceSamples - 1; i >= 0; --i) {
    ReferenceLine::Sample& sample = line.samples[i];
    float cap_mps = min(sample.speed_cap_mps, bend_speed_mps(sample.curvature_1pm, parameters));
    if (i + 1 < kReferenceSamples) {
      way_m = way_to_next_m(line, i);
      cap_mps = min(cap_mps, steerable_mps(sample, line.samples[i + 1], way_m, parameters));
    }
    cap_mps = max(cap_mps, kSlowestMps);
    if (cap_mps > next_mps) cap_mps = min(cap_mps, sqrt(square(next_mps) + gain_mps2 * way_m));
    sample.speed_cap_mps = cap_mps;
    next_mps = cap_mps;
  }
}

}  // namespace

int build_reference(const LaneMap& map, const scene::LanePath& path, float from_s_m, float speed_mps,
                    const Parameters& parameters, ReferenceLine& line) {
  line.spacing_m = max(1.0F, kSpacingPerSpeed * speed_mps);
  line.lateral_offset_m = 0.0F;
  // Samples lie on a fixed grid of the path: lines built from slightly different places agree.
  line.start_s_m = (floor(from_s_m / line.spacing_m) - kBehind) * line.spacing_m;
  scene::PathCursor cursor(map, path);
  for (int i = 0; i < kReferenceSamples; ++i) {
    const scene::PathPoint point = cursor.at(line.start_s_m + static_cast<float>(i) * line.spacing_m);
    line.samples[i].pose = point.pose;
    line.samples[i].speed_cap_mps = point.speed_limit_mps;
    line.slowest_limit_mps =
        i == 0 ? point.speed_limit_mps : min(line.slowest_limit_mps, point.speed_limit_mps);
  }
  smooth(line);
  const int widening_work = widen_tight_bends(parameters, line);
  differentiate(line);
  int work = kLineWork + widening_work + scene::kSeekWork * cursor.seeks();
  cap_speeds(parameters, speed_at_end_mps(map, path, line, speed_mps, parameters, work), line);
  return work;
}

namespace {

/// Between which samples `s_m` lies: index and index + 1, t in [0, 1] except beyond the ends.
struct ReferencePlace {
  int index;
  float t;
};

inline ReferencePlace place_on(const ReferenceLine& line, float s_m) {
  constexpr int kLast = kReferenceSamples - 2;
  constexpr float kNoHalves = 8388608.0F;
  const float place = (s_m - line.start_s_m) / line.spacing_m;
  const float below = place - 0.5F;  // to_int(below, 0, kLast) without the cases it does not have
  int index = 0;
  if (below >= static_cast<float>(kLast)) {
    index = kLast;
  } else if (below > 0.0F) {
    index = static_cast<int>((below + kNoHalves) - kNoHalves);
  }
  return {index, place - static_cast<float>(index)};
}

/// Inline: what its callers do not use of the sample costs nothing.
inline ReferenceLine::Sample interpolate(const ReferenceLine& line, float s_m) {
  const ReferencePlace place = place_on(line, s_m);
  const ReferenceLine::Sample& a = line.samples[place.index];
  const ReferenceLine::Sample& b = line.samples[place.index + 1];
  const float t = place.t;  // beyond the ends: straight on
  const float u = t < 0.0F ? 0.0F : (t > 1.0F ? 1.0F : t);
  float turn_rad = b.pose.heading_rad - a.pose.heading_rad;
  if (turn_rad > kPi) turn_rad = turn_rad - kTwoPi;
  if (turn_rad < -kPi) turn_rad = turn_rad + kTwoPi;
  ReferenceLine::Sample sample;
  sample.pose.x_m = a.pose.x_m + (b.pose.x_m - a.pose.x_m) * t;
  sample.pose.y_m = a.pose.y_m + (b.pose.y_m - a.pose.y_m) * t;
  sample.pose.heading_rad = a.pose.heading_rad + turn_rad * u;
  sample.curvature_1pm = a.curvature_1pm + (b.curvature_1pm - a.curvature_1pm) * u;
  sample.speed_cap_mps = a.speed_cap_mps + (b.speed_cap_mps - a.speed_cap_mps) * u;
  return sample;
}

}  // namespace

ReferenceLine::Sample reference_at(const ReferenceLine& line, float s_m) {
  return interpolate(line, s_m);
}

Box box_on_line(const scene::EgoPath& path, float s_m, const Parameters& parameters) {
  const Pose line = reference_at(*path.driven, s_m).pose;
  const Point there = offset_point(line, 0.0F, path.lateral_offset_m);
  return ego_box({there.x_m, there.y_m, line.heading_rad}, parameters);
}

float curvature_at(const ReferenceLine& line, float s_m) {
  return interpolate(line, s_m).curvature_1pm;
}

float speed_cap_at(const ReferenceLine& line, float s_m) {
  return interpolate(line, s_m).speed_cap_mps;
}

float reference_way_per_s(const ReferenceLine& line, float s_m) {
  return way_to_next_m(line, place_on(line, s_m).index) / line.spacing_m;
}

ReferenceCoordinates locate_on(const ReferenceLine& line, Point point, float guess_s_m) {
  constexpr float kLeastStretch = 0.3F;  // beyond, the centre of curvature is near
  constexpr int kIterations = 4;  // Newton on a smooth line: each one squares the error over the radius
  ReferenceCoordinates found{guess_s_m, 0.0F};
  for (int i = 0; i < kIterations; ++i) {
    const ReferenceLine::Sample sample = interpolate(line, found.s_m);
    const Point ahead = direction(sample.pose.heading_rad);
    const Point offset = point - position(sample.pose);
    found.d_m = cross(ahead, offset);
    const float stretch = max(kLeastStretch, 1.0F - sample.curvature_1pm * found.d_m);
    const float before_s_m = found.s_m;
    found.s_m = before_s_m + dot(ahead, offset) / stretch;
    if (found.s_m == before_s_m) break;  // nothing changes any more
  }
  return found;
}

}  // namespace s4tp::trajectory
