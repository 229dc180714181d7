#include "algo/trajectory/lateral_offset.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kStandsMps = 0.3F;  // all that a standing car's measured speed may be
constexpr float kStepM = 0.5F;
constexpr int kStepsAhead = 60;
constexpr float kWideM = 100.0F;  // wider than any lane
constexpr float kRoundingM = 0.01F;
constexpr float kAcrossCos = 0.7071F;  // 45 degrees

constexpr float kAsidesM[] = {0.0F, -0.35F, 0.35F, -0.7F, 0.7F};
constexpr int kAsides = static_cast<int>(sizeof(kAsidesM) / sizeof(kAsidesM[0]));
constexpr unsigned kAnywhere = (1U << kAsides) - 1U;

Box box_of(const scene::Agent& agent) {
  return {agent.track.centre, agent.track.length_m, agent.track.width_m};
}

/// Our box with the rear axle `aside_m` left of a point of the centre line.
Box box_beside(const Pose& centre_line, float aside_m, const Parameters& parameters) {
  const Point beside = offset_point(centre_line, 0.0F, aside_m);
  return ego_box({beside.x_m, beside.y_m, centre_line.heading_rad}, parameters);
}

bool leaves_room(const Pose& centre_line, float aside_m, const Box& other, const Parameters& parameters) {
  return separation(box_beside(centre_line, aside_m, parameters), other) >= kBystanderGapM;
}

/// Of the places in `from` (bit k: kAsidesM[k]), those from which our box at one point of the centre line
/// leaves room to `other`.
unsigned passed_from(const Pose& centre_line, const Box& other, unsigned from, const Parameters& parameters,
                     int& tried) {
  const float reach_m = parameters.vehicle.length_m + 0.5F * (other.length_m + other.width_m) + 1.0F;
  const Point apart = position(other.centre) - position(centre_line);
  const bool across =
      dot(direction(other.centre.heading_rad), direction(centre_line.heading_rad)) < kAcrossCos;
  if (!across || dot(apart, apart) > square(reach_m)) return from;
  unsigned left = 0;
  for (int k = 0; k < kAsides; ++k) {
    const bool open = (from >> k & 1U) != 0;
    tried += open ? 1 : 0;
    if (open && leaves_room(centre_line, kAsidesM[k], other, parameters)) left |= 1U << k;
  }
  return left;
}

/// Those within a lane of `width_m`.
unsigned within_lane(float width_m, const Parameters& parameters) {
  unsigned within = 1U;
  for (int k = 1; k < kAsides; ++k) {
    if (2.0F * abs(kAsidesM[k]) + parameters.vehicle.width_m <= width_m + kRoundingM) within |= 1U << k;
  }
  return within;
}

float find_aside_m(const scene::Scene& scene, const scene::EgoPath& path, const Parameters& parameters,
                   int& tried) {
  unsigned from[kMaxTracks];
  for (unsigned& one : from) one = kAnywhere;
  float width_m = kWideM;
  scene::PathCursor cursor(*scene.map, path.path);
  for (int i = 0; i < kStepsAhead; ++i) {
    const scene::PathPoint point = cursor.at(path.frenet.s_m + static_cast<float>(i) * kStepM);
    width_m = min(width_m, point.width_m);
    for (int k = 0; k < scene.agents.size(); ++k) {
      const scene::Agent& agent = scene.agents[k];
      if (is_standing(agent) && from[k] != 0)
        from[k] = passed_from(point.pose, box_of(agent), from[k], parameters, tried);
    }
  }
  unsigned all = within_lane(width_m, parameters);
  for (const unsigned one : from) {
    if ((all & one) != 0) all &= one;
  }
  int least = 0;
  while ((all >> least & 1U) == 0) ++least;
  return kAsidesM[least];
}

}  // namespace

bool is_standing(const scene::Agent& agent) {
  return agent.track.speed_mps < kStandsMps;
}

int set_lateral_offsets(const Parameters& parameters, scene::Scene& scene) {
  int tried = 0;
  bool somebody_stands = false;
  for (const scene::Agent& agent : scene.agents) somebody_stands = somebody_stands || is_standing(agent);
  for (scene::EgoPath& path : scene.ego_paths) {
    path.aside_m = somebody_stands ? find_aside_m(scene, path, parameters, tried) : 0.0F;
  }
  return tried;
}

}  // namespace s4tp::trajectory
