#pragma once
/// How a box is cut by lines across the path of a field: what the integral and its gradient both sum over.

#include "algo/core/bounded.hpp"
#include "algo/core/inline.hpp"
#include "algo/sadrf/box_slices.hpp"

namespace s4tp::sadrf {

/// The box in the field's frame.
struct LocalBox {
  Point centre;
  Point axis;  ///< unit vector of its heading
  float half_length_m;
  float half_width_m;
};

/// A line across the path: foot and unit tangent of the path at s, and the part of it inside the box.
struct Slice {
  float s_m;
  Point foot;
  Point tangent;
  float right_m;  ///< e at its ends
  float left_m;
};

[[nodiscard]] LocalBox in_frame(const Field& field, const Box& box);

/// Half a turn: beyond, points belong to the path's other side.
[[nodiscard]] float longest_arc_m(const Field& field);

/// The line at s. \return false when it misses the box
[[nodiscard]] bool cut(const Field& field, const LocalBox& box, float s_m, Slice& slice);

/// Width of the field at a place.
[[nodiscard]] inline float sigma_at(const Field& field, float s_m, float e_m) {
  return (e_m > 0.0F ? field.widening_left : field.widening_right) * s_m + field.base_width_m;
}

/// Gauss points and weights on -1 .. 1.
struct GaussRule {
  int count;
  float nodes[4];
  float weights[4];
};

/// \param half_m  of the stretch they are for
[[nodiscard]] const GaussRule& rule_for(float half_m);

/// Where the lines' sum is cut into pieces: at the corners, and where an edge enters or leaves the middle of
/// the field; from one to the other what is summed is smooth.
using Breaks = BoundedVector<float, 13>;
static_assert(kMaxSlices == 4 * (Breaks::kCapacity - 1));

[[nodiscard]] Breaks find_breaks(const Field& field, const LocalBox& box);

/// Calls add(weight, slice) for every line whose sum approximates the integral over the box.
template <typename Add>
void for_slices(const Field& field, const LocalBox& box, const Add& add) {
  const float end_m = longest_arc_m(field);
  const Breaks breaks = find_breaks(field, box);
  for (int i = 0; i + 1 < breaks.size(); ++i) {
    const float from_m = max(breaks[i], 0.0F);
    const float to_m = min(breaks[i + 1], end_m);
    const float half_m = 0.5F * (to_m - from_m);
    if (half_m <= 0.0F) continue;
    const GaussRule& rule = rule_for(half_m);
    for (int k = 0; k < rule.count; ++k) {
      Slice slice;
      if (cut(field, box, from_m + half_m * (1.0F + rule.nodes[k]), slice)) {
        add(half_m * rule.weights[k], slice);
      }
    }
  }
}

}  // namespace s4tp::sadrf
