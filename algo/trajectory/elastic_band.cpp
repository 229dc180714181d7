#include "algo/trajectory/elastic_band.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kTinyM3 = 0.01F;     // no division by less
constexpr float kToLane = 0.05F;     // weight of a sample's place in the lane, beside that of its bend
constexpr float kHeld = 1.0F;        // ... of one that is held
constexpr float kLeastShare = 0.5F;  // of the bend allowed: less does not lower a sample's weight faster
constexpr float kLeastWeight = 0.05F;

}  // namespace

float bend_1pm(Point in, Point out) {
  const Point both = in + out;  // twice their mean
  const float span_m2 = dot(both, both);
  return 8.0F * abs(cross(in, out)) / max(span_m2 * sqrt(span_m2), kTinyM3);
}

ElasticBand::ElasticBand(ReferenceLine& line, int first, int end) : line_(line), first_(first), end_(end) {
  for (int i = first_ - 1; i <= end_; ++i) {
    weight_[i] = 1.0F;
    set_moved(i, {});
  }
}

float ElasticBand::weigh_bends(float limit_1pm) {
  float most = 0.0F;
  for (int i = first_ - 1; i <= end_; ++i) {
    const Point here = place(i);
    const float share = bend_1pm(here - place(i - 1), place(i + 1) - here) / limit_1pm;
    most = max(most, share);
    const float least = max(share, kLeastShare);
    weight_[i] = max(weight_[i] * least * sqrt(least), kLeastWeight);
  }
  return most;
}

void ElasticBand::hold(int i, Point by) {
  held_[i] = (is_held_[i] ? held_[i] : moved(i)) + by;
  is_held_[i] = true;
}

void ElasticBand::apply() {
  for (int i = first_; i < end_; ++i) {
    const Point there = place(i);
    line_.samples[i].pose.x_m = there.x_m;
    line_.samples[i].pose.y_m = there.y_m;
  }
}

// How far a sample is moved is kept where its heading and curvature will be.
Point ElasticBand::moved(int i) const {
  if (i < first_ || i >= end_) return {};
  return {line_.samples[i].pose.heading_rad, line_.samples[i].curvature_1pm};
}

void ElasticBand::set_moved(int i, Point by) {
  line_.samples[i].pose.heading_rad = by.x_m;
  line_.samples[i].curvature_1pm = by.y_m;
}

// Second difference of the lane, weighed.
Point ElasticBand::pull(int i) const {
  const Point here = position(line_.samples[i].pose);
  const Point out = position(line_.samples[i + 1].pose) - here;
  return weight_[i] * (out - (here - position(line_.samples[i - 1].pose)));
}

// The normal equations, of five diagonals: L D L^T.
void ElasticBand::solve() {
  float d1 = 0.0F;  // D and the right hand side, of one and two rows before
  float d2 = 0.0F;
  Point z1;
  Point z2;
  for (int i = first_; i < end_; ++i) {
    const float l1 = i > first_ ? next_[i - 1] : 0.0F;
    const float l2 = i > first_ + 1 ? after_[i - 2] : 0.0F;
    float diagonal =
        weight_[i - 1] + 4.0F * weight_[i] + weight_[i + 1] + kToLane - d1 * l1 * l1 - d2 * l2 * l2;
    const Point pulled = 2.0F * pull(i) - (pull(i - 1) + pull(i + 1));
    Point z = pulled - (l1 * z1 + l2 * z2);
    if (is_held_[i]) {
      diagonal = diagonal + kHeld;
      z = z + kHeld * held_[i];
    }
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

}  // namespace s4tp::trajectory
