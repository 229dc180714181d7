#pragma once
/// The centre line of a lane path as our motion follows it: sampled, smoothed, and with the speed that may be
/// driven at each point.
///
/// \code
///   polyline      ____/\__    kinks at every vertex: no steering could follow
///   reference     ____/~~\__  the same, averaged over +-2 samples (a triangle): an arc of radius R moves
///                             inwards by 0.67 m^2 / R, 6 cm at 10.7 m, and its curvature sets in over 5 m
///   too tight     __--|       where a lane bends more than we can steer: out before the corner, in at it, out behind it
/// \endcode

#include "algo/core/config.hpp"
#include "algo/core/parameters.hpp"
#include "algo/scene/lane_path.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::trajectory {

using scene::kReferenceSamples;
using scene::ReferenceLine;

/// Of each of our paths.
using ReferenceLines = ReferenceLine[decltype(scene::Scene::ego_paths)::kCapacity];

/// Where a point lies relative to a reference line.
struct ReferenceCoordinates {
  float s_m = 0.0F;
  float d_m = 0.0F;  ///< left positive
};

/// Samples `path` from a little behind `from_s_m` on. \param speed_mps  widens the spacing, so that 3 s and
/// the way to brake fit at any speed. \pre the path has at least one lane \return what it took [WorkMeter's units]
int build_reference(const LaneMap& map, const scene::LanePath& path, float from_s_m, float speed_mps,
                    const Parameters& parameters, ReferenceLine& line);

/// The line at `s_m`, interpolated; the heading may be outside [-pi, pi) by a step's turn.
[[nodiscard]] ReferenceLine::Sample reference_at(const ReferenceLine& line, float s_m);

/// Our box where our rear axle is at `s_m` of the line that the path is driven on, with its lateral offset.
/// \pre path.driven is there
[[nodiscard]] Box box_on_line(const scene::EgoPath& path, float s_m, const Parameters& parameters);

/// Of that, one number alone.
[[nodiscard]] float curvature_at(const ReferenceLine& line, float s_m);
[[nodiscard]] float speed_cap_at(const ReferenceLine& line, float s_m);

/// Metres of the line in one metre of s, which counts along the lane: below 1 where the line cuts a corner, above 1 where it is
/// driven wide.
[[nodiscard]] float reference_way_per_s(const ReferenceLine& line, float s_m);

/// Foot of `point` on the line, near `guess_s_m`.
[[nodiscard]] ReferenceCoordinates locate_on(const ReferenceLine& line, Point point, float guess_s_m);

}  // namespace s4tp::trajectory
