#pragma once
/// The line that a path is driven on: what trajectory/reference_line.hpp makes of a lane path.

#include "algo/core/geometry.hpp"

namespace s4tp::scene {

inline constexpr int kReferenceSamples = 84;

/// Smoothed centre line over kReferenceSamples * spacing_m; beyond both ends it goes on straight.
struct ReferenceLine {
  struct Sample {
    Pose pose;
    float curvature_1pm = 0.0F;
    /// Limit, curves and their onset, ahead too: braked for in time. CAND-024 As far ahead as it takes from a
    /// plan's end on, which may be further than the line is.
    float speed_cap_mps = 0.0F;
  };
  float start_s_m = 0.0F;  ///< arc length of samples[0] along the path
  float spacing_m = 1.0F;
  float slowest_limit_mps = 0.0F;  ///< along it; lower caps are bends'
  float lateral_offset_m = 0.0F;   ///< left of it motion settles: EgoPath's, past who stand
  /// Where the lane bends more than we can steer, if anywhere: our way is wider there than the lane.
  bool tight = false;
  float tight_from_s_m = 0.0F;
  float tight_to_s_m = 0.0F;
  Sample samples[kReferenceSamples];
};

}  // namespace s4tp::scene
