#include "algo/sadrf/road_risk.hpp"

#include "algo/core/check.hpp"
#include "algo/core/math.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/field.hpp"

namespace s4tp {
namespace {

constexpr int kExtension = 4;  // stations beyond the last point
constexpr int kMaxStations = kTrajectoryPoints + kExtension;

/// A point of the path with what the road costs across it, for three widths of the field: at its car, half
/// way to the furthest look-ahead distance, and there.
struct Station {
  float path_m = 0.0F;
  float cost[3] = {};
};

using Stations = BoundedVector<Station, kMaxStations>;

float covered(const Intervals& intervals, float sigma_m) {
  float sum = 0.0F;
  for (const Interval& interval : intervals) {
    sum += gauss_integral(interval.left_m, sigma_m) - gauss_integral(interval.right_m, sigma_m);
  }
  return sum;
}

/// Integral across the path of exp(-e^2 / (2 sigma^2)) times the cost of the ground.
float cost_across(const CrossSection& section, float sigma_m, const Parameters& parameters) {
  constexpr float kWhole = 2.50662827F;  // sqrt(2 pi)
  const float ours = covered(section.ours, sigma_m);
  const float drivable = covered(section.drivable, sigma_m);
  return parameters.risk.cost_off_road * max(kWhole * sigma_m - drivable, 0.0F) +
         parameters.risk.cost_opposite * max(drivable - ours, 0.0F);
}

/// Parabola through the three tabulated widths. \param x  distance from the car over the furthest one, 0 .. 1
float cost_at(const Station& station, float x) {
  const float a = station.cost[0];
  const float c = 2.0F * (station.cost[2] + a) - 4.0F * station.cost[1];
  const float b = station.cost[2] - a - c;
  return max(a + x * (b + x * c), 0.0F);
}

/// The path of the trajectory at the points asked for, and its continuation.
void place_stations(const Trajectory& trajectory, int first, int stride, float beyond_m,
                    BoundedVector<Pose, kMaxStations>& poses, Stations& stations) {
  float path_m = 0.0F;
  bool room = true;
  int last = first;
  for (int i = first; i < kTrajectoryPoints; i += stride) {
    last = i;
    const Pose& pose = trajectory.points[i].rear_axle;
    if (!poses.empty()) path_m += distance(position(poses[poses.size() - 1]), position(pose));
    room = room && poses.push(pose) && stations.push({path_m, {}});
  }
  const float step_m = beyond_m / static_cast<float>(kExtension);
  const float turn_rad = trajectory.points[last].curvature_1pm * step_m;
  for (int i = 0; i < kExtension; ++i) {
    Pose pose = poses[poses.size() - 1];
    pose.heading_rad = wrap_angle(pose.heading_rad + 0.5F * turn_rad);
    pose = shift_ahead(pose, step_m);
    pose.heading_rad = wrap_angle(pose.heading_rad + 0.5F * turn_rad);
    path_m += step_m;
    room = room && poses.push(pose) && stations.push({path_m, {}});
  }
  S4TP_ASSERT(room);
}

/// Integral of p (d - s)^2 cost(s) over s = 0 .. d, by Simpson's rule between stations: exact for a cost that
/// is linear there.
float along(const Stations& stations, int first, float look_ahead_m, float furthest_m, float steepness) {
  float sum = 0.0F;
  float s_m = 0.0F;
  float cost = stations[first].cost[0];
  for (int j = first + 1; j < stations.size() && s_m < look_ahead_m; ++j) {
    float next_m = stations[j].path_m - stations[first].path_m;
    float next_cost = cost_at(stations[j], min(next_m / furthest_m, 1.0F));
    if (next_m > look_ahead_m) {
      next_cost = lerp(cost, next_cost, (look_ahead_m - s_m) / (next_m - s_m));
      next_m = look_ahead_m;
    }
    const float middle_m = 0.5F * (s_m + next_m);
    sum += (next_m - s_m) *
           (square(look_ahead_m - s_m) * cost + 2.0F * square(look_ahead_m - middle_m) * (cost + next_cost) +
            square(look_ahead_m - next_m) * next_cost);
    s_m = next_m;
    cost = next_cost;
  }
  return steepness * sum * (1.0F / 6.0F);
}

}  // namespace

void road_risk(const DrivableArea& area, const Trajectory& trajectory, const Parameters& parameters,
               int first, int stride, float (&road)[kHorizonSteps]) {
  if (area.map == nullptr) {
    for (float& value : road) value = 0.0F;
    return;
  }
  const FieldParams field = kolekar2020_preset(parameters.vehicle.width_m);
  const auto look_ahead_m = [&](int point) {
    const float t_la_s =
        look_ahead_at(parameters.risk.look_ahead_s, parameters.risk.look_ahead_shrinks > 0.5F,
                      static_cast<float>(point) * kStepS);
    return max(trajectory.points[point].speed_mps * t_la_s, 1.0F);
  };
  float furthest_m = 0.0F;
  int last = first;
  for (int i = first; i < kTrajectoryPoints; i += stride) {
    furthest_m = max(furthest_m, look_ahead_m(i));
    last = i;
  }

  BoundedVector<Pose, kMaxStations> poses;
  Stations stations;
  place_stations(trajectory, first, stride, look_ahead_m(last), poses, stations);

  // erf is 1 in float from 4 on: beyond, ground costs nothing.
  constexpr float kNothingBeyond = 5.7F;
  const float reach_m = kNothingBeyond * (field.base_width_m + field.widening * furthest_m);
  Bounds bounds;
  for (const Pose& pose : poses) include(bounds, position(pose));
  NearStrips near;
  near_strips(area, bounds, reach_m, near);
  for (int j = 0; j < stations.size(); ++j) {
    CrossSection section;
    cross_section(area, near, poses[j], reach_m, section);
    for (int k = 0; k < 3; ++k) {
      const float sigma_m = field.base_width_m + field.widening * furthest_m * (0.5F * static_cast<float>(k));
      stations[j].cost[k] = cost_across(section, sigma_m, parameters);
    }
  }
  for (int point = first, j = 0; point < kTrajectoryPoints; point += stride, ++j) {
    road[point - 1] = along(stations, j, look_ahead_m(point), furthest_m, parameters.risk.steepness);
  }
}

}  // namespace s4tp
