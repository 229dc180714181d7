#pragma once
/// Where driving costs nothing, where it costs C_opp, and (everywhere else) C_off: the road part of the cost
/// map.
///
/// \code
///   ours:       strips of lanes of kind ours, and in each junction the convex hull of its lanes
///   opposite:   strips of lanes of kind opposite outside junctions
///   off road:   the rest; shoulders are for the minimum-risk manoeuvre only
/// \endcode
/// Source: method.md 3.

#include "algo/core/bounded.hpp"
#include "algo/core/config.hpp"
#include "algo/core/geometry.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/core/world_state.hpp"

namespace s4tp::sadrf {

inline constexpr int kMaxJunctions = 4;  ///< junctions within the horizon; of further ones the strips count
inline constexpr int kMaxHullVertices = 16;
inline constexpr int kMaxIntervals = 8;  ///< of a cross-section

/// Upright rectangle around something, to leave it out quickly.
struct Bounds {
  float low_x_m = 1e9F;
  float high_x_m = -1e9F;
  float low_y_m = 1e9F;
  float high_y_m = -1e9F;
};

/// A part of a cross-section, as offsets from the path, left positive.
struct Interval {
  float right_m = 0.0F;
  float left_m = 0.0F;
};

using Intervals = BoundedVector<Interval, kMaxIntervals>;

/// The road across the path at one point: disjoint intervals.
struct CrossSection {
  Intervals ours;
  Intervals drivable;     ///< ours and opposite lanes together
  bool opposite = false;  ///< whether that is any different
};

/// What is worth computing of a LaneMap once per cycle.
struct DrivableArea {
  struct Strip {
    LaneIndex lane = kNoLaneIndex;
    bool ours = false;
    Bounds bounds;
  };
  struct Junction {
    Bounds bounds;
    BoundedVector<Point, kMaxHullVertices> hull;  ///< counterclockwise
  };
  const LaneMap* map = nullptr;  ///< null: nothing is known of the road, and nothing is charged for it
  BoundedVector<Strip, kMaxLanes> strips;
  BoundedVector<Junction, kMaxJunctions> junctions;
};

/// \param map  must outlive `area`; may be null
/// \return what it took [WorkMeter's units]
int build_drivable(const LaneMap* map, DrivableArea& area);

/// The strips near a path, by index into DrivableArea::strips.
using NearStrips = BoundedVector<std::uint8_t, kMaxLanes>;

/// Strips that come within `reach_m` of `path`.
void near_strips(const DrivableArea& area, const Bounds& path, float reach_m, NearStrips& near);

/// The road across `station`, as far as `reach_m` to each side.
/// \param work  what it takes is charged; it ends in any case
void cross_section(const DrivableArea& area, const NearStrips& near, const Pose& station, float reach_m,
                   CrossSection& section, WorkMeter& work);

/// CORE-061 A point is drivable when a strip of ours or opposite or a junction's hull covers it.
enum class Ground : std::uint8_t { kOurs = 0, kOpposite = 1, kOffRoad = 2 };
[[nodiscard]] Ground ground_at(const DrivableArea& area, Point point);

/// Grows `bounds` by a point.
void include(Bounds& bounds, Point point);

}  // namespace s4tp::sadrf
