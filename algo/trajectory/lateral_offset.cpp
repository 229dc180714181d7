#include "algo/trajectory/lateral_offset.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kStepM = 0.5F;
constexpr int kStepsAhead = 60;
constexpr float kWideM = 100.0F;  // wider than any lane
constexpr float kRoundingM = 0.01F;
constexpr float kAcrossCos = 0.7071F;  // 45 degrees

// Work (WorkMeter's units).
constexpr int kTwoPointsWork = 6;
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

/// Of the places it is passed from so far, those from which our box at one point of the centre line leaves room, too.
/// The gap along each axis that may separate the boxes (geometry.hpp, separation()) is linear in the place.
unsigned passed_from(const Pose& centre_line, Point ahead, const Bystander& other,
                     const Parameters& parameters) {
  const float half_length_m = 0.5F * parameters.vehicle.length_m;
  const float half_width_m = 0.5F * parameters.vehicle.width_m;
  const float reach_m = parameters.vehicle.length_m + (other.half_length_m + other.half_width_m) + 1.0F;
  const Point apart = other.centre - position(centre_line);
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

/// Those within a lane of `width_m`.
unsigned within_lane(float width_m, const Parameters& parameters) {
  unsigned within = 1U;
  for (int k = 1; k < kLateralOffsets; ++k) {
    if (2.0F * abs(kLateralOffsetsM[k]) + parameters.vehicle.width_m <= width_m + kRoundingM)
      within |= 1U << k;
  }
  return within;
}

float find_lateral_offset_m(const scene::Scene& scene, const scene::EgoPath& path,
                            const Parameters& parameters, Bystanders& bystanders, int& work) {
  for (Bystander& other : bystanders) other.from = kAnywhere;
  float width_m = kWideM;
  scene::PathCursor cursor(*scene.map, path.path);
  for (int i = 0; i < kStepsAhead; ++i) {
    const scene::PathPoint point = cursor.at(path.frenet.s_m + static_cast<float>(i) * kStepM);
    width_m = min(width_m, point.width_m);
    const Point ahead = direction(point.pose.heading_rad);
    for (Bystander& other : bystanders) other.from = passed_from(point.pose, ahead, other, parameters);
  }
  work += kStepsAhead * (kTwoPointsWork + kTwoPassedWork * bystanders.size()) / 2 +
          scene::kSeekWork * cursor.seeks();
  unsigned all = within_lane(width_m, parameters);
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

int set_lateral_offsets(const Parameters& parameters, scene::Scene& scene) {
  int work = 0;
  Bystanders bystanders;
  for (const scene::Agent& agent : scene.agents) {
    if (!is_standing(agent)) continue;
    (void)bystanders.push({position(agent.track.centre), direction(agent.track.centre.heading_rad),
                           0.5F * agent.track.length_m, 0.5F * agent.track.width_m, kAnywhere});
  }
  for (scene::EgoPath& path : scene.ego_paths) {
    path.lateral_offset_m =
        bystanders.empty() ? 0.0F : find_lateral_offset_m(scene, path, parameters, bystanders, work);
  }
  return work;
}

}  // namespace s4tp::trajectory
