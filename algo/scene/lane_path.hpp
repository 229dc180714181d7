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

namespace s4tp::scene {

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

/// One stretch of a lane's centre line between two vertices, smoothed: the heading passes from one vertex
/// heading to the other, and a short stretch bulges as the arc both headings agree on.
struct LaneSegment {
  Point start;
  float heading_rad = 0.0F;          ///< of the chord
  float length_m = 0.0F;             ///< of the chord; arc length counts along chords
  float start_deviation_rad = 0.0F;  ///< heading at the first vertex minus heading_rad
  float end_deviation_rad = 0.0F;
  float blend_m = 0.0F;  ///< within this distance of a vertex the heading changes
  float bulge = 0.0F;    ///< lateral offset of the arc = bulge * x * (length - x) / length
};

/// Stretch `index` of `lane`. \pre 0 <= index < lane.point_count - 1
[[nodiscard]] LaneSegment lane_segment(const Lane& lane, int index);

inline constexpr int kSeekWork = 10;  ///< for a cursor to find a segment [WorkMeter's units]

/// Walks along a path: the same answers as path_point, cheaper while s stays within one segment.
/// Map and path must outlive it. \pre the path has at least one lane
class PathCursor {
 public:
  PathCursor(const LaneMap& map, const LanePath& path);
  [[nodiscard]] PathPoint at(float s_m);
  /// How often it had to look for a segment: what it costs, kSeekWork each.
  [[nodiscard]] int seeks() const { return seeks_; }

 private:
  void seek(float s_m);

  const LaneMap& map_;
  const LanePath& path_;
  LaneSegment segment_;
  Point chord_;   ///< its unit vector
  int lane_ = 0;  ///< index into path_.lanes
  int seeks_ = 0;
  float from_s_m_ = 0.0F;  ///< the loaded segment answers for [from, to)
  float to_s_m_ = -1.0F;
  float start_s_m_ = 0.0F;  ///< where it begins
};

/// The centre line at `s_m`; before the start and beyond the end it goes on straight (the lane is then the
/// first or last one). Heading and curvature are those of the smoothed polyline: vertex headings
/// interpolated. \pre the path has at least one lane
[[nodiscard]] PathPoint path_point(const LaneMap& map, const LanePath& path, float s_m);

/// Nearest point of the centre line within |s - guess_s_m| <= reach_m (whole path when reach_m < 0). The
/// straight goings-on before the start and beyond the end count as well, so s may be < 0 or > length.
/// Bounded: one pass over the segments in reach and three corrections. \pre as path_point
[[nodiscard]] Frenet project(const LaneMap& map, const LanePath& path, Point point, float guess_s_m,
                             float reach_m);
/// The same. \param work  what it took is added [WorkMeter's units]
[[nodiscard]] Frenet project(const LaneMap& map, const LanePath& path, Point point, float guess_s_m,
                             float reach_m, int& work);
/// The same, with the centre line there. \param foot  receives path_point at the result's s_m
[[nodiscard]] Frenet project(const LaneMap& map, const LanePath& path, Point point, float guess_s_m,
                             float reach_m, PathPoint& foot, int& work);

/// Whether the path leads along the lane.
[[nodiscard]] bool is_along(const LanePath& path, LaneIndex lane);

/// Sum of the chords of a centre line [m].
[[nodiscard]] float centre_line_length(const Lane& lane);

/// Whether a lane can be driven along in thought: present, 2 or more vertices, some length, every value
/// sound.
[[nodiscard]] bool usable(const Lane& lane);

/// Which lanes another one leads into.
void find_led_into(const LaneMap& map, bool (&led_into)[kMaxLanes]);

/// Nearest point of one lane's centre line, ends included. \pre usable(lane)
struct LaneFix {
  float s_m = 0.0F;
  float distance_m = 0.0F;   ///< to the point itself: beyond an end it is not the lateral one
  float heading_rad = 0.0F;  ///< of the chord there
};
[[nodiscard]] LaneFix nearest_on_lane(const Lane& lane, Point point);

/// Lane of `map` that a pose most plausibly drives on: nearest centre line within `lateral_limit_m` whose
/// heading agrees within 60 degrees; among lanes equally near the one of nearest heading.
/// \return kNoLaneIndex when there is none
[[nodiscard]] LaneIndex locate(const LaneMap& map, const Pose& pose, float lateral_limit_m);

}  // namespace s4tp::scene
