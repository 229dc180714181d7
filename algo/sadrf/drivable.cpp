#include "algo/sadrf/drivable.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::sadrf {
namespace {

/// Strips of successive segments are drawn over their ends, so that bends leave no wedge open.
constexpr float kJoinM = 0.5F;

// Work (WorkMeter's units).
constexpr std::int32_t kSectionWork = 2;      // of a cross-section
constexpr std::int32_t kStripsPerUnit = 4;    // lanes that are not here
constexpr std::int32_t kSegmentsPerUnit = 2;  // segments that are not
constexpr std::int32_t kHullWork = 8;
constexpr std::int32_t kCoveredWork = 3;
constexpr int kDrivableWork = 20;
constexpr int kStripWork = 5;       // to find the bounds of a lane
constexpr int kHullLanesWork = 3;   // to see whether a lane belongs to a junction
constexpr int kHullVertexWork = 5;  // of a vertex of one that does
constexpr int kHullDirectionsWork = 40;

bool apart(const Bounds& a, const Bounds& b, float margin_m) {
  return a.low_x_m > b.high_x_m + margin_m || b.low_x_m > a.high_x_m + margin_m ||
         a.low_y_m > b.high_y_m + margin_m || b.low_y_m > a.high_y_m + margin_m;
}

void include(Bounds& bounds, const Bounds& other) {
  include(bounds, Point{other.low_x_m, other.low_y_m});
  include(bounds, Point{other.high_x_m, other.high_y_m});
}

Bounds bounds_of(const Lane& lane) {
  Bounds bounds;
  for (int i = 0; i < lane.point_count; ++i) include(bounds, lane.points[i]);
  const float margin_m = 0.5F * lane.width_m;
  bounds.low_x_m -= margin_m;
  bounds.high_x_m += margin_m;
  bounds.low_y_m -= margin_m;
  bounds.high_y_m += margin_m;
  return bounds;
}

bool junction_lane(const Lane& lane) {
  return lane.present && lane.in_junction && lane.point_count >= 2;
}

/// Lanes of one junction overlap; lanes of different ones lie apart.
void find_junctions(const LaneMap& map, DrivableArea& area) {
  for (const Lane& lane : map.lanes) {
    if (!junction_lane(lane)) continue;
    DrivableArea::Junction grown;
    grown.bounds = bounds_of(lane);
    for (int i = area.junctions.size() - 1; i >= 0; --i) {
      if (apart(area.junctions[i].bounds, grown.bounds, 0.0F)) continue;
      include(grown.bounds, area.junctions[i].bounds);
      area.junctions.swap_remove(i);
    }
    if (!area.junctions.push(grown)) continue;
  }
}

/// Unit vector to the left of a lane at one of its points.
Point left_of(const Lane& lane, int i) {
  const Point along =
      i + 1 < lane.point_count ? lane.points[i + 1] - lane.points[i] : lane.points[i] - lane.points[i - 1];
  const float length_m = max(norm(along), 1e-3F);
  return {-along.y_m / length_m, along.x_m / length_m};
}

/// The point that lies furthest in a direction.
struct Extreme {
  Point towards;
  Point point;
  float reach_m = -1e9F;
};

/// Extreme points of the lanes' borders in 16 directions: vertices of the convex hull, in order. \return what it took
int find_hull(const LaneMap& map, DrivableArea::Junction& junction) {
  int work = kHullDirectionsWork;
  Extreme extremes[kMaxHullVertices];
  for (int k = 0; k < kMaxHullVertices; ++k) {
    const float turns = (static_cast<float>(k) + 0.5F) / static_cast<float>(kMaxHullVertices);
    extremes[k].towards = direction(wrap_angle(kTwoPi * turns));
  }
  for (const Lane& lane : map.lanes) {
    if (!junction_lane(lane)) continue;
    work += kHullLanesWork;
    if (apart(bounds_of(lane), junction.bounds, 0.0F)) continue;
    work += kHullVertexWork * lane.point_count;
    for (int i = 0; i < lane.point_count; ++i) {
      const Point half = (0.5F * lane.width_m) * left_of(lane, i);
      const Point borders[] = {lane.points[i] + half, lane.points[i] - half};
      for (const Point border : borders) {
        for (Extreme& extreme : extremes) {
          const float reach_m = dot(border, extreme.towards);
          if (reach_m > extreme.reach_m) {
            extreme.reach_m = reach_m;
            extreme.point = border;
          }
        }
      }
    }
  }
  constexpr float kSameM = 0.01F;
  for (const Extreme& extreme : extremes) {
    const bool known = !junction.hull.empty() &&
                       (distance(extreme.point, junction.hull[junction.hull.size() - 1]) < kSameM ||
                        distance(extreme.point, junction.hull[0]) < kSameM);
    if (!known && !junction.hull.push(extreme.point)) break;
  }
  return work;
}

/// Keeps the part of the interval where low <= value + slope * offset <= high.
void constrain(float value, float slope, float low, float high, Interval& interval) {
  constexpr float kParallel = 1e-6F;
  if (abs(slope) < kParallel) {
    if (value < low || value > high) interval.left_m = interval.right_m - 1.0F;
    return;
  }
  const float at_low = (low - value) / slope;
  const float at_high = (high - value) / slope;
  interval.right_m = max(interval.right_m, min(at_low, at_high));
  interval.left_m = min(interval.left_m, max(at_low, at_high));
}

/// Unites an interval with those it touches.
void add(Interval interval, Intervals& intervals) {
  if (interval.left_m <= interval.right_m) return;
  for (int i = intervals.size() - 1; i >= 0; --i) {
    const Interval& other = intervals[i];
    if (other.right_m > interval.left_m || interval.right_m > other.left_m) continue;
    interval = {min(interval.right_m, other.right_m), max(interval.left_m, other.left_m)};
    intervals.swap_remove(i);
  }
  // More separate pieces than fit in a few metres are no road; leaving one out charges too much, never too
  // little.
  if (!intervals.push(interval)) return;
}

/// The part of the line station + offset * left that a segment's strip covers.
Interval across_segment(Point a, Point b, float half_width_m, Point station, Point left, float reach_m) {
  Interval interval = {-reach_m, reach_m};
  const Interval nothing = {1.0F, 0.0F};
  const Point along = b - a;
  const Point offset = station - a;
  const float squared = dot(along, along);
  const float length_m = sqrt(squared);
  const float join_m = kJoinM + reach_m;
  const float ahead = dot(along, offset);
  if (ahead < -join_m * length_m || ahead > squared + join_m * length_m) return nothing;
  const float across = cross(along, offset);
  if (abs(across) > (half_width_m + reach_m) * length_m) return nothing;
  const float side_m = half_width_m * length_m;
  constrain(across, cross(along, left), -side_m, side_m, interval);
  if (interval.left_m <= interval.right_m) return interval;
  const float join = kJoinM * length_m;
  constrain(ahead, dot(along, left), -join, squared + join, interval);
  return interval;
}

Interval across_hull(const DrivableArea::Junction& junction, Point station, Point left, float reach_m) {
  constexpr float kFar = 1e9F;
  Interval interval = {-reach_m, reach_m};
  for (int i = 0; i < junction.hull.size(); ++i) {
    const Point vertex = junction.hull[i];
    const Point edge = junction.hull[i + 1 < junction.hull.size() ? i + 1 : 0] - vertex;
    constrain(cross(edge, station - vertex), cross(edge, left), 0.0F, kFar, interval);
    if (interval.left_m <= interval.right_m) break;
  }
  return interval;
}

}  // namespace

void include(Bounds& bounds, Point point) {
  bounds.low_x_m = min(bounds.low_x_m, point.x_m);
  bounds.high_x_m = max(bounds.high_x_m, point.x_m);
  bounds.low_y_m = min(bounds.low_y_m, point.y_m);
  bounds.high_y_m = max(bounds.high_y_m, point.y_m);
}

int build_drivable(const LaneMap* map, DrivableArea& area) {
  area.map = map;
  area.strips.clear();
  area.junctions.clear();
  if (map == nullptr) return 0;
  int work = kDrivableWork;
  for (int i = 0; i < kMaxLanes; ++i) {
    const Lane& lane = map->lanes[i];
    if (lane.present) work += junction_lane(lane) ? 2 * kStripWork : kStripWork;
    const bool charged = lane.kind == LaneKind::kOpposite && !lane.in_junction;
    if (!lane.present || lane.point_count < 2 || lane.kind == LaneKind::kShoulder) continue;
    if (!area.strips.push({static_cast<LaneIndex>(i), !charged, bounds_of(lane)})) break;
  }
  find_junctions(*map, area);
  for (DrivableArea::Junction& junction : area.junctions) work += find_hull(*map, junction);
  return work;
}

void near_strips(const DrivableArea& area, const Bounds& path, float reach_m, NearStrips& near) {
  near.clear();
  for (int i = 0; i < area.strips.size(); ++i) {
    if (apart(area.strips[i].bounds, path, reach_m)) continue;
    if (!near.push(static_cast<std::uint8_t>(i))) return;
  }
}

void cross_section(const DrivableArea& area, const NearStrips& near, const Pose& station, float reach_m,
                   CrossSection& section, WorkMeter& work) {
  work.spend(kSectionWork + (near.size() + 1) / kStripsPerUnit);
  section.ours.clear();
  section.drivable.clear();
  section.opposite = false;
  const Point at = position(station);
  const Point ahead = direction(station.heading_rad);
  const Point left = {-ahead.y_m, ahead.x_m};
  Bounds here;
  include(here, at);
  const auto all_ours = [&] {
    return section.ours.size() == 1 && section.ours[0].left_m - section.ours[0].right_m >= 2.0F * reach_m;
  };
  for (const DrivableArea::Junction& junction : area.junctions) {
    if (apart(junction.bounds, here, reach_m) || junction.hull.size() < 3) continue;
    work.spend(kHullWork);
    const Interval covered = across_hull(junction, at, left, reach_m);
    add(covered, section.ours);
    add(covered, section.drivable);
  }
  for (int k = 0; k < near.size() && !all_ours(); ++k) {
    const DrivableArea::Strip& strip = area.strips[near[k]];
    if (apart(strip.bounds, here, reach_m)) continue;
    const Lane& lane = area.map->lanes[strip.lane];
    work.spend(1 + lane.point_count / kSegmentsPerUnit);
    for (int i = 0; i + 1 < lane.point_count; ++i) {
      const Interval covered =
          across_segment(lane.points[i], lane.points[i + 1], 0.5F * lane.width_m, at, left, reach_m);
      if (covered.left_m <= covered.right_m) continue;  // as most
      work.spend(kCoveredWork);
      if (strip.ours) {
        add(covered, section.ours);
      } else {
        section.opposite = true;
      }
      add(covered, section.drivable);
    }
  }
}

Ground ground_at(const DrivableArea& area, Point point) {
  constexpr float kHereM = 1e-3F;
  Bounds here;
  include(here, point);
  NearStrips near;
  near_strips(area, here, kHereM, near);
  CrossSection section;
  WorkMeter work;
  cross_section(area, near, {point.x_m, point.y_m, 0.0F}, kHereM, section, work);
  if (!section.ours.empty()) return Ground::kOurs;
  return section.drivable.empty() ? Ground::kOffRoad : Ground::kOpposite;
}

}  // namespace s4tp::sadrf
