#include "algo/trajectory/driven_lines.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/long_vehicles.hpp"
#include "algo/trajectory/tight_bends.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kStepM = 0.5F;
constexpr int kStepsAhead = 60;
constexpr float kReachM = kStepM * static_cast<float>(kStepsAhead);
constexpr float kSeekM = 10.0F;   // each way of where plans begin along a path
constexpr float kWideM = 100.0F;  // wider than any lane
constexpr float kRoundingM = 0.01F;
constexpr float kAcrossCos = 0.7071F;  // 45 degrees

// Work (WorkMeter's units).
constexpr int kTwoPointsWork = 4;
constexpr int kTwoPassedWork = 3;

constexpr float kLateralOffsetsM[] = {0.0F, -0.35F, 0.35F, -0.7F, 0.7F};
constexpr int kLateralOffsets = static_cast<int>(sizeof(kLateralOffsetsM) / sizeof(kLateralOffsetsM[0]));
constexpr unsigned kAnywhere = (1U << kLateralOffsets) - 1U;

/// One who stands, and from which places (bit k: kLateralOffsetsM[k]) our box has left room to it so far.
struct Bystander {
  Point centre;
  Point ahead;  ///< unit vector of its heading
  float half_length_m;
  float half_width_m;
  unsigned from;
};
using Bystanders = BoundedVector<Bystander, kMaxTracks>;

/// Of the places it is passed from so far, those from which our box at one point of the line leaves room, too.
/// The gap along each axis that may separate the boxes (geometry.hpp, separation()) is linear in the place.
unsigned passed_from(const Pose& line, Point ahead, const Bystander& other, const Parameters& parameters) {
  const float half_length_m = 0.5F * parameters.vehicle.length_m;
  const float half_width_m = 0.5F * parameters.vehicle.width_m;
  const float reach_m = parameters.vehicle.length_m + (other.half_length_m + other.half_width_m) + 1.0F;
  const Point apart = other.centre - position(line);
  const float cosine = dot(ahead, other.ahead);
  if (cosine >= kAcrossCos || dot(apart, apart) > square(reach_m)) return other.from;
  const float sine = cross(ahead, other.ahead);
  const float along = abs(cosine);
  const float across = abs(sine);
  const Point offset = apart - rear_axle_to_centre_m(parameters) * ahead;
  const float long_enough_m =
      kBystanderGapM + half_length_m + (other.half_length_m * along + other.half_width_m * across);
  if (abs(dot(ahead, offset)) >= long_enough_m) return other.from;
  const float wide_enough_m =
      kBystanderGapM + half_width_m + (other.half_length_m * across + other.half_width_m * along);
  const float its_long_enough_m =
      kBystanderGapM + other.half_length_m + (half_length_m * along + half_width_m * across);
  const float its_wide_enough_m =
      kBystanderGapM + other.half_width_m + (half_length_m * across + half_width_m * along);
  const float left_m = cross(ahead, offset);
  const float its_ahead_m = dot(other.ahead, offset);
  const float its_left_m = cross(other.ahead, offset);
  unsigned passed = 0;
  for (int k = 0; k < kLateralOffsets; ++k) {
    const float lateral_offset_m = kLateralOffsetsM[k];
    const bool passes = abs(left_m - lateral_offset_m) >= wide_enough_m ||
                        abs(its_ahead_m - lateral_offset_m * sine) >= its_long_enough_m ||
                        abs(its_left_m - lateral_offset_m * cosine) >= its_wide_enough_m;
    if (passes) passed |= 1U << k;
  }
  return other.from & passed;
}

/// Those within the lanes of the path over the way looked at, and at which no bend is tighter than we can steer.
unsigned drivable_from(const scene::Scene& scene, const scene::EgoPath& path, float left_1pm, float right_1pm,
                       const Parameters& parameters) {
  float width_m = kWideM;
  for (const scene::PathLane& part : path.path.lanes) {
    const Lane& lane = scene.map->lanes[part.lane];
    const float to_start_m = part.start_s_m - path.frenet.s_m;
    if (to_start_m < kReachM && to_start_m + lane.length_m > 0.0F) width_m = min(width_m, lane.width_m);
  }
  const float limit_1pm = curvature_for(parameters.vehicle.steering_max_rad, parameters.vehicle.wheelbase_m);
  unsigned from = 1U;
  for (int k = 1; k < kLateralOffsets; ++k) {
    const float lateral_offset_m = kLateralOffsetsM[k];
    const bool within = 2.0F * abs(lateral_offset_m) + parameters.vehicle.width_m <= width_m + kRoundingM;
    const bool steerable = left_1pm <= limit_1pm * (1.0F - left_1pm * lateral_offset_m) &&
                           -right_1pm <= limit_1pm * (1.0F - right_1pm * lateral_offset_m);
    if (within && steerable) from |= 1U << k;
  }
  return from;
}

float find_lateral_offset_m(const scene::Scene& scene, const scene::EgoPath& path, const ReferenceLine& line,
                            const Parameters& parameters, Bystanders& bystanders, int& work) {
  for (Bystander& other : bystanders) other.from = kAnywhere;
  float left_1pm = 0.0F;  // the sharpest bend to either side
  float right_1pm = 0.0F;
  for (int i = 0; i < kStepsAhead; ++i) {
    const ReferenceLine::Sample point = reference_at(line, path.frenet.s_m + static_cast<float>(i) * kStepM);
    left_1pm = max(left_1pm, point.curvature_1pm);
    right_1pm = min(right_1pm, point.curvature_1pm);
    const Point ahead = direction(point.pose.heading_rad);
    for (Bystander& other : bystanders) other.from = passed_from(point.pose, ahead, other, parameters);
  }
  work += kStepsAhead * (kTwoPointsWork + kTwoPassedWork * bystanders.size()) / 2;
  unsigned all = drivable_from(scene, path, left_1pm, right_1pm, parameters);
  for (const Bystander& other : bystanders) {
    if ((all & other.from) != 0) all &= other.from;
  }
  int least = 0;
  while ((all >> least & 1U) == 0) ++least;
  return kLateralOffsetsM[least];
}

}  // namespace

bool is_standing(const scene::Agent& agent) {
  return agent.track.speed_mps < kStandingMps;
}

int build_lines(const TrajectoryPoint& start, float lead_s, const Parameters& parameters, scene::Scene& scene,
                ReferenceLines& lines) {
  int work = 0;
  Bystanders bystanders;
  for (const scene::Agent& agent : scene.agents) {
    if (!is_standing(agent)) continue;
    (void)bystanders.push({position(agent.track.centre), direction(agent.track.centre.heading_rad),
                           0.5F * agent.track.length_m, 0.5F * agent.track.width_m, kAnywhere});
  }
  for (int i = 0; i < scene.ego_paths.size(); ++i) {
    scene::EgoPath& path = scene.ego_paths[i];
    const float guess_s_m = path.frenet.s_m + lead_s * scene.ego.speed_mps;
    const scene::Frenet frenet =
        scene::project(*scene.map, path.path, position(start.rear_axle), guess_s_m, kSeekM, work);
    work += build_reference(*scene.map, path.path, frenet.s_m, start.speed_mps, parameters, lines[i]);
    path.lateral_offset_m = bystanders.empty()
                                ? 0.0F
                                : find_lateral_offset_m(scene, path, lines[i], parameters, bystanders, work);
    lines[i].lateral_offset_m = path.lateral_offset_m;
    path.driven = &lines[i];
    work += add_zones_beside(scene, parameters, path);
    work += widen_zones(scene, parameters, lead_s, path);
  }
  return work;
}

}  // namespace s4tp::trajectory
