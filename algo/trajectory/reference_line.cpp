#include "algo/trajectory/reference_line.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kBehind = 20.0F;             // samples behind the start: a corner is smoothed as a whole
constexpr float kSpacingPerSpeed = 0.0625F;  // s: 64 samples ahead are then 4 s of way
constexpr float kGentle = 0.8F;      // share of comfortable braking used to arrive at a curve or limit
constexpr float kTinyM = 0.01F;      // no division by less
constexpr float kFlat = 1e-3F;       // the same, radian of steering per metre
constexpr float kStraight = 1e-4F;   // sine of a turn between samples that counts as none
constexpr float kSlowestMps = 1.0F;  // a cap never asks for standstill: stops are intents of their own
constexpr float kRateShare = 0.85F;  // of the steering rate: some is left to follow with
constexpr int kMostMoves = 300;      // of samples, to widen bends: one of 25 samples twelve times
constexpr int kEdgeSamples = 4;      // at the ends, which widening leaves as they are
constexpr int kWidenedSamples = 8;   // each way around what is too tight
constexpr float kToLane = 0.05F;     // weight of a sample's place in the lane, beside that of its bend
constexpr float kLeastShare = 0.5F;  // of the bend allowed: less does not lower a sample's weight faster
constexpr float kLeastWeight = 0.05F;
constexpr float kSteeringShare = 0.97F;  // some is left to follow with
constexpr float kBeyondSpacingM = 5.0F;  // of samples for bends beyond the line: a junction's are 6 m long
constexpr int kBeyondSamples = 32;

// Work (WorkMeter's units), beside scene::kSeekWork.
constexpr int kLineWork = 400;
constexpr int kMoveWork = 3;    // of one
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

/// Curvature where two chords meet: of the circle through three points, whose chords are nearly equally long.
float bend_1pm(Point in, Point out) {
  const Point both = in + out;  // twice their mean
  const float span_m2 = dot(both, both);
  return 8.0F * abs(cross(in, out)) / max(span_m2 * sqrt(span_m2), kTinyM);
}

/// A stretch of the line that bends more than we can steer, moved sideways as little as makes it drivable: the smoothing spline
/// sum of weight_i |p_(i-1) - 2 p_i + p_(i+1)|^2 + kToLane |p_i - lane_i|^2, whose weights grow where it still bends too
/// much and shrink elsewhere. Out before the corner, in at it, out behind it, as one drives a narrow corner.
class Widening {
 public:
  Widening(ReferenceLine& line, int first, int end) : line_(line), first_(first), end_(end) {
    for (int i = first_ - 1; i <= end_; ++i) {
      weight_[i] = 1.0F;
      set_moved(i, {});
    }
  }

  /// One solution. \return whether all of it can be steered now; else it is weighed anew
  bool pass(float limit_1pm) {
    solve();
    bool drivable = true;
    for (int i = first_ - 1; i <= end_; ++i) {
      const Point here = place(i);
      const float share = bend_1pm(here - place(i - 1), place(i + 1) - here) / limit_1pm;
      drivable = drivable && share <= 1.0F;
      const float least = max(share, kLeastShare);
      weight_[i] = max(weight_[i] * least * sqrt(least), kLeastWeight);
    }
    return drivable;
  }

  void apply() {
    for (int i = first_; i < end_; ++i) {
      const Point there = place(i);
      line_.samples[i].pose.x_m = there.x_m;
      line_.samples[i].pose.y_m = there.y_m;
    }
  }

 private:
  /// How far a sample is moved is kept where its heading and curvature will be.
  [[nodiscard]] Point moved(int i) const {
    if (i < first_ || i >= end_) return {};
    return {line_.samples[i].pose.heading_rad, line_.samples[i].curvature_1pm};
  }
  void set_moved(int i, Point by) {
    line_.samples[i].pose.heading_rad = by.x_m;
    line_.samples[i].curvature_1pm = by.y_m;
  }
  [[nodiscard]] Point place(int i) const { return position(line_.samples[i].pose) + moved(i); }
  /// Second difference of the lane, weighed.
  [[nodiscard]] Point pull(int i) const {
    const Point here = position(line_.samples[i].pose);
    const Point out = position(line_.samples[i + 1].pose) - here;
    return weight_[i] * (out - (here - position(line_.samples[i - 1].pose)));
  }

  /// The normal equations, of five diagonals: L D L^T.
  void solve() {
    float d1 = 0.0F;  // D and the right hand side, of one and two rows before
    float d2 = 0.0F;
    Point z1;
    Point z2;
    for (int i = first_; i < end_; ++i) {
      const float l1 = i > first_ ? next_[i - 1] : 0.0F;
      const float l2 = i > first_ + 1 ? after_[i - 2] : 0.0F;
      const float diagonal =
          weight_[i - 1] + 4.0F * weight_[i] + weight_[i + 1] + kToLane - d1 * l1 * l1 - d2 * l2 * l2;
      const Point pulled = 2.0F * pull(i) - (pull(i - 1) + pull(i + 1));
      const Point z = pulled - (l1 * z1 + l2 * z2);
      const float beside = i > first_ ? d1 * l1 * after_[i - 1] : 0.0F;
      next_[i] = (-2.0F * (weight_[i] + weight_[i + 1]) - beside) / diagonal;
      after_[i] = weight_[i + 1] / diagonal;
      set_moved(i, (1.0F / diagonal) * z);
      d2 = d1;
      d1 = diagonal;
      z2 = z1;
      z1 = z;
    }
    for (int i = end_ - 2; i >= first_; --i)
      set_moved(i, moved(i) - (next_[i] * moved(i + 1) + after_[i] * moved(i + 2)));
  }

  ReferenceLine& line_;
  int first_;  // of the samples that are moved
  int end_;
  float weight_[kReferenceSamples];
  float next_[kReferenceSamples];  // L's diagonals
  float after_[kReferenceSamples];
};

/// The next stretch from `from` on that bends more than `limit_1pm` with what is around it. \return false: none
bool find_too_tight(const ReferenceLine& line, float limit_1pm, int from, int& first, int& end) {
  bool any = false;
  for (int i = from > kEdgeSamples ? from : kEdgeSamples; i + kEdgeSamples < kReferenceSamples; ++i) {
    const Point here = position(line.samples[i].pose);
    const Point in = here - position(line.samples[i - 1].pose);
    if (bend_1pm(in, position(line.samples[i + 1].pose) - here) <= limit_1pm) continue;
    if (any && i - kWidenedSamples > end) break;
    const int before = i - kWidenedSamples;
    const int after = i + kWidenedSamples + 1;
    if (!any) first = before > from ? before : from;
    any = true;
    end = after < kReferenceSamples - 2 ? after : kReferenceSamples - 2;
  }
  return any;
}

/// A lane may bend more than we can steer: our way through such a corner is wider. \return what it took
int widen_tight_bends(const Parameters& parameters, ReferenceLine& line) {
  const float limit_1pm =
      kSteeringShare * curvature_for(parameters.vehicle.steering_max_rad, parameters.vehicle.wheelbase_m);
  int moves = kMostMoves;
  int first = 0;
  int end = 2;
  line.tight = false;
  while (moves > 0 && find_too_tight(line, limit_1pm, end, first, end)) {
    Widening stretch(line, first, end);
    bool drivable = false;
    while (moves > 0 && !drivable) {
      drivable = stretch.pass(limit_1pm);
      moves -= end - first;
    }
    stretch.apply();
    if (!line.tight) line.tight_from_s_m = line.start_s_m + static_cast<float>(first) * line.spacing_m;
    line.tight = true;
    line.tight_to_s_m = line.start_s_m + static_cast<float>(end) * line.spacing_m;
  }
  return kMoveWork * (kMostMoves - moves);
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

/// Speed at which the wheels can be turned as fast as the bend sets in.
float steerable_mps(const ReferenceLine& line, int i, const Parameters& parameters) {
  const float slope_1pm2 =
      abs(line.samples[i + 1].curvature_1pm - line.samples[i].curvature_1pm) / line.spacing_m;
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

/// Caps by curves, then backwards: v^2 = v_next^2 + 2 b ds, so that each slower part is reached in time.
void cap_speeds(const Parameters& parameters, float next_mps, ReferenceLine& line) {
  const float gain_m2ps2 = 2.0F * kGentle * parameters.comfort.braking_mps2 * line.spacing_m;
  for (int i = kReferenceSamples - 1; i >= 0; --i) {
    float& cap_mps = line.samples[i].speed_cap_mps;
    cap_mps = min(cap_mps, bend_speed_mps(line.samples[i].curvature_1pm, parameters));
    if (i + 1 < kReferenceSamples) cap_mps = min(cap_mps, steerable_mps(line, i, parameters));
    cap_mps = max(cap_mps, kSlowestMps);
    if (cap_mps > next_mps) cap_mps = min(cap_mps, sqrt(square(next_mps) + gain_m2ps2));
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

float curvature_at(const ReferenceLine& line, float s_m) {
  return interpolate(line, s_m).curvature_1pm;
}

float speed_cap_at(const ReferenceLine& line, float s_m) {
  return interpolate(line, s_m).speed_cap_mps;
}

ReferenceCoordinates locate_on(const ReferenceLine& line, Point point, float guess_s_m) {
  constexpr int kIterations = 4;  // Newton on a smooth line: each one squares the error over the radius
  ReferenceCoordinates found{guess_s_m, 0.0F};
  for (int i = 0; i < kIterations; ++i) {
    const ReferenceLine::Sample sample = interpolate(line, found.s_m);
    const Point ahead = direction(sample.pose.heading_rad);
    const Point offset = point - position(sample.pose);
    found.d_m = cross(ahead, offset);
    const float stretch = max(0.3F, 1.0F - sample.curvature_1pm * found.d_m);
    const float before_s_m = found.s_m;
    found.s_m = before_s_m + dot(ahead, offset) / stretch;
    if (found.s_m == before_s_m) break;  // nothing changes any more
  }
  return found;
}

}  // namespace s4tp::trajectory
