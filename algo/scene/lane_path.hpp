#pragma once
/// Lanes strung together into one way a vehicle may go, and the Frenet frame along it.
///
/// \code
///   lane 3 -----> lane 7 (junction) ----. lane 12
///   |s=0                                 '------> s = length
///        d > 0 to the left of the centre line
/// \endcode

#include "algo/core/bounded.hpp"
#include "algo/core/config.hpp"
#include "algo/core/world_state.hpp"

namespace s4tp {

/// One lane of a path; `start_s_m` is the path's arc length where the lane begins.
struct PathLane {
  LaneIndex lane = kNoLaneIndex;
  float start_s_m = 0.0F;
};

/// A chain of successive lanes. s = 0 at the start of the first one.
struct LanePath {
  BoundedVector<PathLane, kMaxPathLanes> lanes;
  float length_m = 0.0F;
};

/// A point of a path's centre line.
struct PathPoint {
  Pose pose;
  float curvature_1pm = 0.0F;
  float speed_limit_mps = 0.0F;
  float width_m = 0.0F;
  LaneIndex lane = kNoLaneIndex;
};

/// Where a point lies relative to a path.
struct Frenet {
  float s_m = 0.0F;
  float d_m = 0.0F;          ///< left positive
  float heading_rad = 0.0F;  ///< of the centre line there
};

/// The centre line at `s_m`; before the start and beyond the end it goes on straight (the lane is then the
/// first or last one). Heading and curvature are those of the smoothed polyline: vertex headings
/// interpolated. \pre the path has at least one lane
[[nodiscard]] PathPoint path_point(const LaneMap& map, const LanePath& path, float s_m);

/// Nearest point of the centre line within |s - guess_s_m| <= reach_m (whole path when reach_m < 0).
[[nodiscard]] Frenet project(const LaneMap& map, const LanePath& path, Point point, float guess_s_m,
                             float reach_m);

/// Lane of `map` that a pose most plausibly drives on: nearest centre line within `lateral_limit_m` whose
/// heading agrees within 60 degrees. \return kNoLaneIndex when there is none
[[nodiscard]] LaneIndex locate(const LaneMap& map, const Pose& pose, float lateral_limit_m);

}  // namespace s4tp
