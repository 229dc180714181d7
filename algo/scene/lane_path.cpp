#include "algo/scene/lane_path.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::scene {
namespace {

constexpr float kBlendM = 10.0F;       // a bend is spread over at most this far from its vertex
constexpr float kLengthRatio = 4.0F;   // a stretch this much longer than its neighbour is taken as straight
constexpr float kShortestM = 1e-3F;    // a stretch shorter than this has no direction
constexpr float kBulgeMax = 0.4F;      // 23 degrees between chord and tangent
constexpr float kCurvatureMax = 0.5F;  // 1/m; what is sharper is a flaw of the polyline
constexpr float kHeadingLimitRad = 1.05F;  // 60 degrees
constexpr float kCoordinateMaxM = 1e5F;    // beyond it float has no centimetres
constexpr float kFarM = 1e6F;              // beyond both ends of any path
constexpr float kLeastStretch = 0.3F;      // 1 - curvature d: beyond, the centre of curvature is near
constexpr float kWidestM = 20.0F;          // of a lane
constexpr float kShortestLaneM = 0.1F;
constexpr int kCorrections = 3;

// Work (WorkMeter's units), beside kSeekWork.
constexpr int kProjectWork = 12;
constexpr int kVerticesPerUnit = 2;

// How much of the bend between two stretches lies on the side of the one of length `own`: by length, as on a
// circle; a much longer stretch is the straight before or after the curve and joins it along its tangent.
float bend_share(float own_m, float other_m) {
  const float sum = own_m + other_m;
  const bool alike = own_m <= kLengthRatio * other_m && other_m <= kLengthRatio * own_m;
  return (alike ? own_m : other_m) / sum;
}

// Signed angle from a to b.
float angle_between(Point a, Point b) {
  return atan2(cross(a, b), dot(a, b));
}

float heading_deviation(const LaneSegment& segment, float x_m) {
  if (x_m < segment.blend_m) return segment.start_deviation_rad * (1.0F - x_m / segment.blend_m);
  const float left_m = segment.length_m - x_m;
  if (left_m < segment.blend_m) return segment.end_deviation_rad * (1.0F - left_m / segment.blend_m);
  return 0.0F;
}

float curvature(const LaneSegment& segment, float x_m) {
  float value = 0.0F;
  if (x_m < segment.blend_m) {
    value = -segment.start_deviation_rad / segment.blend_m;
  } else if (segment.length_m - x_m < segment.blend_m) {
    value = segment.end_deviation_rad / segment.blend_m;
  }
  return clamp(value, -kCurvatureMax, kCurvatureMax);
}

}  // namespace

LaneSegment lane_segment(const Lane& lane, int index) {
  S4TP_ASSERT(index >= 0 && index + 1 < lane.point_count && lane.point_count <= kMaxLanePoints);
  LaneSegment segment;
  segment.start = lane.points[index];
  const Point chord = lane.points[index + 1] - lane.points[index];
  segment.length_m = norm(chord);
  segment.heading_rad = atan2(chord.y_m, chord.x_m);
  segment.blend_m = max(min(0.5F * segment.length_m, kBlendM), 0.5F * kShortestM);

  bool bends_before = false;
  bool bends_after = false;
  if (index > 0) {
    const Point before = lane.points[index] - lane.points[index - 1];
    const float length_m = norm(before);
    if (length_m > kShortestM && segment.length_m > kShortestM) {
      segment.start_deviation_rad = -angle_between(before, chord) * bend_share(segment.length_m, length_m);
      bends_before = true;
    }
  }
  if (index + 2 < lane.point_count) {
    const Point after = lane.points[index + 2] - lane.points[index + 1];
    const float length_m = norm(after);
    if (length_m > kShortestM && segment.length_m > kShortestM) {
      segment.end_deviation_rad = angle_between(chord, after) * bend_share(segment.length_m, length_m);
      bends_after = true;
    }
  }
  // At a lane's end the bend of the other vertex goes on, so that curves join smoothly.
  if (segment.length_m <= 2.0F * kBlendM) {
    if (!bends_before) segment.start_deviation_rad = -segment.end_deviation_rad;
    if (!bends_after) segment.end_deviation_rad = -segment.start_deviation_rad;
    const float left = min(segment.start_deviation_rad, -segment.end_deviation_rad);
    const float right = max(segment.start_deviation_rad, -segment.end_deviation_rad);
    segment.bulge = clamp(left > 0.0F ? left : (right < 0.0F ? right : 0.0F), -kBulgeMax, kBulgeMax);
  }
  return segment;
}

PathCursor::PathCursor(const LaneMap& map, const LanePath& path) : map_(map), path_(path) {
  S4TP_ASSERT(!path.lanes.empty());
}

void PathCursor::seek(float s_m) {
  ++seeks_;
  lane_ = 0;
  for (int i = 1; i < path_.lanes.size(); ++i) {
    if (path_.lanes[i].start_s_m <= s_m) lane_ = i;
  }
  const bool last_lane = lane_ + 1 == path_.lanes.size();
  const Lane& lane = map_.lanes[path_.lanes[lane_].lane];
  float start_s_m = path_.lanes[lane_].start_s_m;
  int last = lane.point_count - 2;
  while (last > 0 && distance(lane.points[last], lane.points[last + 1]) <= kShortestM) --last;
  int index = 0;
  for (; index < last; ++index) {
    const float length_m = distance(lane.points[index], lane.points[index + 1]);
    if (length_m > kShortestM && s_m < start_s_m + length_m) break;
    start_s_m += length_m;
  }
  segment_ = lane_segment(lane, index);
  chord_ = direction(segment_.heading_rad);
  constexpr float kFar = 1e9F;
  start_s_m_ = start_s_m;
  from_s_m_ = lane_ == 0 && index == 0 ? -kFar : start_s_m;
  to_s_m_ = start_s_m + segment_.length_m;
  if (index == last) to_s_m_ = last_lane ? kFar : path_.lanes[lane_ + 1].start_s_m;
}

PathPoint PathCursor::at(float s_m) {
  if (s_m < from_s_m_ || s_m >= to_s_m_) seek(s_m);
  const LaneIndex index = path_.lanes[lane_].lane;
  const Lane& lane = map_.lanes[index];
  const float x_m = s_m - start_s_m_;
  const float inside_m = clamp(x_m, 0.0F, segment_.length_m);
  PathPoint point;
  point.pose.heading_rad = wrap_angle(segment_.heading_rad + heading_deviation(segment_, inside_m));
  const float left_m = segment_.bulge * inside_m * (1.0F - inside_m / max(segment_.length_m, kShortestM));
  Point at = {segment_.start.x_m + (inside_m * chord_.x_m - left_m * chord_.y_m),
              segment_.start.y_m + (inside_m * chord_.y_m + left_m * chord_.x_m)};
  if (inside_m == x_m) {
    point.curvature_1pm = curvature(segment_, inside_m);
  } else {
    at = at + (x_m - inside_m) * direction(point.pose.heading_rad);
  }
  point.pose.x_m = at.x_m;
  point.pose.y_m = at.y_m;
  point.speed_limit_mps = lane.speed_limit_mps;
  point.width_m = lane.width_m;
  point.lane = index;
  return point;
}

PathPoint path_point(const LaneMap& map, const LanePath& path, float s_m) {
  return PathCursor(map, path).at(s_m);
}

Frenet project(const LaneMap& map, const LanePath& path, Point point, float guess_s_m, float reach_m) {
  int work = 0;
  return project(map, path, point, guess_s_m, reach_m, work);
}

Frenet project(const LaneMap& map, const LanePath& path, Point point, float guess_s_m, float reach_m,
               int& work) {
  PathPoint foot;
  return project(map, path, point, guess_s_m, reach_m, foot, work);
}

Frenet project(const LaneMap& map, const LanePath& path, Point point, float guess_s_m, float reach_m,
               PathPoint& foot, int& work) {
  const bool whole = reach_m < 0.0F;
  const float low_s_m = whole ? -kFarM : guess_s_m - reach_m;
  const float high_s_m = whole ? kFarM : guess_s_m + reach_m;
  float best_s_m = clamp(guess_s_m, low_s_m, high_s_m);
  float best_square = 1e30F;
  const int lane_count = path.lanes.size();
  int vertices = 0;
  for (int i = 0; i < lane_count; ++i) {
    const bool last_lane = i + 1 == lane_count;
    float start_s_m = path.lanes[i].start_s_m;
    if (i > 0 && start_s_m > high_s_m) break;
    if (!last_lane && path.lanes[i + 1].start_s_m < low_s_m) continue;
    const Lane& lane = map.lanes[path.lanes[i].lane];
    vertices += lane.point_count;
    for (int k = 0; k + 1 < lane.point_count; ++k) {
      const Point chord = lane.points[k + 1] - lane.points[k];
      const float length_m = norm(chord);
      if (length_m <= kShortestM) continue;
      const bool first = i == 0 && k == 0;
      const bool last = last_lane && k + 2 == lane.point_count;
      const float from_m = max(low_s_m - start_s_m, first ? -kFarM : 0.0F);
      const float to_m = min(high_s_m - start_s_m, last ? kFarM : length_m);
      if (from_m <= to_m) {
        const Point offset = point - lane.points[k];
        const float x_m = clamp(dot(offset, chord) / length_m, from_m, to_m);
        const Point miss = offset - (x_m / length_m) * chord;
        const float square_m2 = dot(miss, miss);
        if (square_m2 < best_square) {
          best_square = square_m2;
          best_s_m = start_s_m + x_m;
        }
      }
      start_s_m += length_m;
    }
  }

  PathCursor cursor(map, path);
  foot = cursor.at(best_s_m);
  Point local = to_local(foot.pose, point);
  for (int i = 0; i < kCorrections; ++i) {
    const float stretch = max(1.0F - foot.curvature_1pm * local.y_m, kLeastStretch);
    const float corrected_s_m = clamp(best_s_m + local.x_m / stretch, low_s_m, high_s_m);
    if (corrected_s_m == best_s_m) break;
    best_s_m = corrected_s_m;
    foot = cursor.at(best_s_m);
    local = to_local(foot.pose, point);
  }
  work += kProjectWork + vertices / kVerticesPerUnit + kSeekWork * cursor.seeks();
  return {best_s_m, local.y_m, foot.pose.heading_rad};
}

bool is_along(const LanePath& path, LaneIndex lane) {
  for (const PathLane& part : path.lanes) {
    if (part.lane == lane) return true;
  }
  return false;
}

float centre_line_length(const Lane& lane) {
  float length_m = 0.0F;
  for (int i = 0; i + 1 < lane.point_count && i + 1 < kMaxLanePoints; ++i) {
    length_m += distance(lane.points[i], lane.points[i + 1]);
  }
  return length_m;
}

bool usable(const Lane& lane) {
  if (!lane.present || lane.point_count < 2 || lane.point_count > kMaxLanePoints) return false;
  for (int i = 0; i < lane.point_count; ++i) {
    // Written so that NaN fails.
    const Point point = lane.points[i];
    if (!(abs(point.x_m) < kCoordinateMaxM && abs(point.y_m) < kCoordinateMaxM)) return false;
  }
  const bool sound = lane.width_m > 0.5F && lane.width_m < kWidestM && lane.speed_limit_mps >= 0.0F &&
                     lane.speed_limit_mps < 100.0F && is_finite(lane.route_remaining_m) &&
                     is_finite(lane.goal_distance_m) && is_finite(lane.stop_line_m);
  return sound && centre_line_length(lane) > kShortestLaneM;
}

void find_led_into(const LaneMap& map, bool (&led_into)[kMaxLanes]) {
  bool is_usable[kMaxLanes];
  for (int i = 0; i < kMaxLanes; ++i) {
    is_usable[i] = usable(map.lanes[i]);
    led_into[i] = false;
  }
  for (int i = 0; i < kMaxLanes; ++i) {
    if (!is_usable[i]) continue;
    for (const LaneIndex next : map.lanes[i].successors) {
      if (next >= 0 && next < kMaxLanes && is_usable[next]) led_into[next] = true;
    }
  }
}

LaneFix nearest_on_lane(const Lane& lane, Point point) {
  LaneFix fix;
  float best_square = 1e30F;
  float start_s_m = 0.0F;
  Point best_chord{1.0F, 0.0F};
  for (int i = 0; i + 1 < lane.point_count; ++i) {
    const Point chord = lane.points[i + 1] - lane.points[i];
    const float length_m = norm(chord);
    if (length_m <= kShortestM) continue;
    const Point offset = point - lane.points[i];
    const float x_m = clamp(dot(offset, chord) / length_m, 0.0F, length_m);
    const Point miss = offset - (x_m / length_m) * chord;
    const float square_m2 = dot(miss, miss);
    if (square_m2 < best_square) {
      best_square = square_m2;
      best_chord = chord;
      fix.s_m = start_s_m + x_m;
    }
    start_s_m += length_m;
  }
  fix.distance_m = sqrt(best_square);
  fix.heading_rad = atan2(best_chord.y_m, best_chord.x_m);
  return fix;
}

LaneIndex locate(const LaneMap& map, const Pose& pose, float lateral_limit_m) {
  LaneIndex best = kNoLaneIndex;
  float best_score = 1e30F;
  for (int i = 0; i < kMaxLanes; ++i) {
    if (!usable(map.lanes[i])) continue;
    const LaneFix fix = nearest_on_lane(map.lanes[i], position(pose));
    const float turn_rad = abs(wrap_angle(pose.heading_rad - fix.heading_rad));
    if (fix.distance_m > lateral_limit_m || turn_rad > kHeadingLimitRad) continue;
    const float score = fix.distance_m + 0.5F * turn_rad;  // 0.5 m a radian: decides only between near equals
    if (score < best_score) {
      best_score = score;
      best = static_cast<LaneIndex>(i);
    }
  }
  return best;
}

}  // namespace s4tp::scene
