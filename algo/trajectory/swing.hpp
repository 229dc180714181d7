#pragma once
/// Around those who stand in a junction.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::trajectory {

using scene::ReferenceLine;

/// CAND-029 Leads the line that a path is driven on, in the junction ahead or under us, around those who stand in the way of
/// our box there and have for 20 s: an elastic band, drawn off whomever it comes nearer than kBystanderGapM, in a bend to
/// its outside, with no bend tighter than we can steer, and in its lane before and behind the junction. Where there is no
/// such way the line stays as it is.
///
/// \code
///      lane ----.             .---->
///                \  [stands]  /
///                 '----------'
/// \endcode
///
/// Marks it as wider than its lane there (ReferenceLine::swing, and tight, for zones with the lanes it comes near).
/// \pre path.driven is `line` \return what it took [WorkMeter's units]
int swing_around(const scene::Scene& scene, const scene::EgoPath& path, const Parameters& parameters,
                 ReferenceLine& line);

/// Our ground in the map's zones where the line is swung, longer by as much at both ends: other ways are crossed askew. No
/// sooner than `nearest_s_m`, where we can stop.
void widen_zones_swung(float nearest_s_m, scene::EgoPath& path);

}  // namespace s4tp::trajectory
