#include "algo/sadrf/road_risk.hpp"

#include "algo/core/check.hpp"
#include "algo/core/inline.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/field.hpp"

namespace s4tp::sadrf {
namespace {

constexpr int kSpacing = 3;    // trajectory points from station to station
constexpr int kExtension = 4;  // stations beyond the last point
constexpr int kStations = kHorizonSteps / kSpacing + 1 + kExtension;
static_assert(kHorizonSteps % kSpacing == 0);

// Work (WorkMeter's units).
constexpr std::int32_t kPlacingWork = 25;  // stations, and the strips near them
constexpr std::int32_t kAlongWork = 3;     // for a point of the trajectory
constexpr std::int32_t kAcrossWork = 2;    // to integrate a cross-section twice, and ...
constexpr std::int32_t kIntervalWork = 4;  // ... of each interval of it
constexpr std::int32_t kMostSectionWork = 600;

/// A place on the path with what the road costs across it, for a field as narrow as at its car and as wide as
/// at the furthest look-ahead distance.
struct Station {
  Pose pose;
  float path_m = 0.0F;
  float narrow_cost = 0.0F;
  float wide_cost = 0.0F;
};

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
  const float drivable = section.opposite ? covered(section.drivable, sigma_m) : ours;
  return parameters.risk.cost_off_road * max(kWhole * sigma_m - drivable, 0.0F) +
         parameters.risk.cost_opposite * max(drivable - ours, 0.0F);
}

/// \param x  distance from the car over the furthest one, 0 .. 1
float cost_at(const Station& station, float x) {
  return station.narrow_cost + min(x, 1.0F) * (station.wide_cost - station.narrow_cost);
}

/// The path of the trajectory, and its continuation for `beyond_m` on a circle.
void place(const Trajectory& trajectory, float beyond_m, Station (&stations)[kStations]) {
  constexpr int kOnPath = kStations - kExtension;
  for (int j = 0; j < kOnPath; ++j) {
    stations[j].pose = trajectory.points[j * kSpacing].rear_axle;
    if (j == 0) continue;
    const Station& before = stations[j - 1];
    stations[j].path_m = before.path_m + distance(position(before.pose), position(stations[j].pose));
  }
  const float step_m = beyond_m / static_cast<float>(kExtension);
  const float half_turn_rad = 0.5F * trajectory.points[kHorizonSteps].curvature_1pm * step_m;
  for (int j = kOnPath; j < kStations; ++j) {
    Pose pose = stations[j - 1].pose;
    pose.heading_rad += half_turn_rad;
    pose = shift_ahead(pose, step_m);
    pose.heading_rad = wrap_angle(pose.heading_rad + half_turn_rad);
    stations[j].pose = pose;
    stations[j].path_m = stations[j - 1].path_m + step_m;
  }
}

/// Integral of p (d - s)^2 cost(s) over s = 0 .. d from trajectory point `point` on, by Simpson's rule
/// between stations: exact for a cost that is linear there.
float along(const Station (&stations)[kStations], int point, float look_ahead_m, float furthest_m,
            float steepness) {
  const int first = point / kSpacing;
  const float part = static_cast<float>(point % kSpacing) / static_cast<float>(kSpacing);
  const float start_m = lerp(stations[first].path_m, stations[first + 1].path_m, part);
  float cost = lerp(stations[first].narrow_cost, stations[first + 1].narrow_cost, part);
  float left_m = look_ahead_m;  // of the look-ahead distance
  float sum = 0.0F;
  for (int j = first + 1; j < kStations && left_m > 0.0F; ++j) {
    const float next_m = stations[j].path_m - start_m;
    const float step_m = next_m - (look_ahead_m - left_m);
    if (step_m <= 0.0F) continue;
    float next_left_m = look_ahead_m - next_m;
    float next_cost = cost_at(stations[j], next_m / furthest_m);
    if (next_left_m < 0.0F) {
      next_cost = cost + (next_cost - cost) * (left_m / step_m);
      next_left_m = 0.0F;
    }
    const float middle_m = 0.5F * (left_m + next_left_m);
    sum +=
        (left_m - next_left_m) * (left_m * left_m * cost + 2.0F * middle_m * middle_m * (cost + next_cost) +
                                  next_left_m * next_left_m * next_cost);
    left_m = next_left_m;
    cost = next_cost;
  }
  return steepness * sum * (1.0F / 6.0F);
}

}  // namespace

void road_risk(const DrivableArea& area, const Trajectory& trajectory, const Parameters& parameters,
               int first, int stride, float (&road)[kHorizonSteps], WorkMeter& work) {
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
  for (int point = first; point < kTrajectoryPoints; point += stride) {
    furthest_m = max(furthest_m, look_ahead_m(point));
  }
  Station stations[kStations];
  place(trajectory, look_ahead_m(kHorizonSteps), stations);

  // Beyond, erf is 1 in float: the ground costs nothing.
  constexpr float kNothingBeyond = 5.7F;
  const float narrow_m = field.base_width_m;
  const float wide_m = narrow_m + field.widening * furthest_m;
  const float reach_m = kNothingBeyond * wide_m;
  Bounds bounds;
  for (const Station& station : stations) include(bounds, position(station.pose));
  NearStrips near;
  near_strips(area, bounds, reach_m, near);
  work.spend(kPlacingWork + kAlongWork * (kHorizonSteps / stride));
  CrossSection section;
  int last_charged = -1;  // station: who is past it pays nothing
  for (int j = 0; j < kStations; ++j) {
    Station& station = stations[j];
    if (!work.allows(kMostSectionWork)) {  // as where it was looked at last
      station.narrow_cost = j > 0 ? stations[j - 1].narrow_cost : 0.0F;
      station.wide_cost = j > 0 ? stations[j - 1].wide_cost : 0.0F;
      if (j > 0 && last_charged == j - 1) last_charged = j;
      continue;
    }
    cross_section(area, near, station.pose, reach_m, section, work);
    work.spend(kAcrossWork +
               kIntervalWork * (section.ours.size() + (section.opposite ? section.drivable.size() : 0)));
    if (section.ours.size() == 1 && section.ours[0].left_m - section.ours[0].right_m >= 2.0F * reach_m)
      continue;
    station.narrow_cost = cost_across(section, narrow_m, parameters);
    station.wide_cost = cost_across(section, wide_m, parameters);
    if (station.narrow_cost != 0.0F || station.wide_cost != 0.0F) last_charged = j;
  }
  for (int point = first; point < kTrajectoryPoints; point += stride) {
    const bool past = point / kSpacing > last_charged;
    road[point - 1] =
        past ? 0.0F : along(stations, point, look_ahead_m(point), furthest_m, parameters.risk.steepness);
  }
}

}  // namespace s4tp::sadrf
