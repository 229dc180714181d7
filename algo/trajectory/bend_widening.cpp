#include "algo/trajectory/bend_widening.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

using scene::kReferenceSamples;
using scene::ReferenceLine;

constexpr float kTinyM3 = 0.01F;     // no division by less
constexpr int kMostMoves = 300;      // of samples, to widen bends: one of 25 samples twelve times
constexpr int kEdgeSamples = 4;      // at the ends, which widening leaves as they are
constexpr int kWidenedSamples = 8;   // each way around what is too tight
constexpr float kToLane = 0.05F;     // weight of a sample's place in the lane, beside that of its bend
constexpr float kLeastShare = 0.5F;  // of the bend allowed: less does not lower a sample's weight faster
constexpr float kLeastWeight = 0.05F;
constexpr float kSteeringShare = 0.97F;  // some is left to follow with

// Work (WorkMeter's units).
constexpr int kMoveWork = 3;  // of one

/// Curvature where two chords meet: of the circle through three points, whose chords are nearly equally long.
float bend_1pm(Point in, Point out) {
  const Point both = in + out;  // twice their mean
  const float span_m2 = dot(both, both);
  return 8.0F * abs(cross(in, out)) / max(span_m2 * sqrt(span_m2), kTinyM3);
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

}  // namespace

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

}  // namespace s4tp::trajectory
