#pragma once
/// The two halves of a roll-out, for those who roll out many candidates on one reference line.

#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {

/// Way a lateral motion to the centre takes: at speed by lateral acceleration, slow by what can be steered;
/// one that is under way already goes on as fast as it is.
[[nodiscard]] float lateral_length_m(const ReferenceLine& line, const TrajectoryPoint& start,
                                     ReferenceCoordinates where, const Parameters& parameters);

/// Writes start_s_m and the quintic of `candidate`: from `start` (offset, heading, curvature) to the line's
/// lateral_offset_m, parallel to it, over `length_m` of way.
void shape_lateral(const ReferenceLine& line, const TrajectoryPoint& start, ReferenceCoordinates where,
                   float length_m, Candidate& candidate);

/// Whether that quintic swings more than 0.3 m wider than it starts, or than it ends: wheels turned the
/// other way at the start would be turned back over its whole length. It is steered instead (CAND-017).
[[nodiscard]] bool overshoots(const Candidate& candidate);

}  // namespace s4tp::trajectory
