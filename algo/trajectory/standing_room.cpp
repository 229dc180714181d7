#include "algo/trajectory/standing_room.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp {
namespace {

constexpr float kStandsMps = 0.3F;  // all that a standing car's measured speed may be
constexpr float kStepM = 0.5F;
constexpr int kMostSteps = 80;

}  // namespace

bool is_standing(const Agent& agent) {
  return agent.track.speed_mps < kStandsMps;
}

bool leaves_room(const Scene& scene, const EgoPath& path, const Agent& agent, float from_s_m, float to_s_m,
                 const Parameters& parameters) {
  const Box other{agent.track.centre, agent.track.length_m, agent.track.width_m};
  PathCursor cursor(*scene.map, path.path);
  float s_m = from_s_m;
  for (int i = 0; i < kMostSteps && s_m < to_s_m; ++i, s_m = s_m + kStepM) {
    if (separation(ego_box(cursor.at(s_m).pose, parameters), other) < kStandingRoomM) return false;
  }
  return true;
}

}  // namespace s4tp
