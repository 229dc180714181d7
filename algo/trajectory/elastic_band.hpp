#pragma once
/// A stretch of a line moved sideways as little as makes it drivable, or leads it past somebody.

#include "algo/core/geometry.hpp"
#include "algo/scene/reference_line.hpp"

namespace s4tp::trajectory {

using scene::kReferenceSamples;
using scene::ReferenceLine;

/// The smoothing spline sum of weight_i |p_(i-1) - 2 p_i + p_(i+1)|^2 + kToLane |p_i - lane_i|^2 + |p_i - lane_i - hold_i|^2 over
/// the samples of a line from `first` to before `end`; the last term only where something holds the band. While it is at
/// work the line's headings and curvatures are its own: they are not there yet, or are made anew. It holds the line by
/// reference.
class ElasticBand {
 public:
  /// \pre 2 <= first < end <= kReferenceSamples - 2
  ElasticBand(ReferenceLine& line, int first, int end);

  /// Weighs every sample's bend: more where it is above its share of what is allowed, less below.
  /// \return the sharpest bend's share of `limit_1pm`
  float weigh_bends(float limit_1pm);
  /// Sample `i` is drawn `by` further than it is drawn already, or than where it is now. \pre first <= i < end
  void hold(int i, Point by);
  void solve();

  [[nodiscard]] Point place(int i) const { return position(line_.samples[i].pose) + moved(i); }
  [[nodiscard]] Point moved(int i) const;
  void apply();

 private:
  void set_moved(int i, Point by);
  [[nodiscard]] Point pull(int i) const;

  ReferenceLine& line_;
  int first_;
  int end_;
  float weight_[kReferenceSamples];
  float next_[kReferenceSamples];  // the factors' diagonals
  float after_[kReferenceSamples];
  Point held_[kReferenceSamples];
  bool is_held_[kReferenceSamples] = {};
};

/// Curvature where two chords meet: of the circle through three points, whose chords are nearly equally long.
[[nodiscard]] float bend_1pm(Point in, Point out);

}  // namespace s4tp::trajectory
