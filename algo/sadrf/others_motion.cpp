#include "algo/sadrf/others_motion.hpp"

#include "algo/core/math.hpp"

namespace s4tp {

Motion motion_at(const Mode& mode, int step) {
  constexpr int kWindow = 3;
  constexpr float kShortestM = 0.5F;
  constexpr float kSharpest_1pm = 0.2F;
  const int first = step >= kWindow ? step - kWindow : 0;
  const Pose& from = mode.steps[first];
  const Pose& to = mode.steps[first + kWindow];
  Motion motion;
  motion.moved = position(to) - position(from);
  const float moved_m = norm(motion.moved);
  motion.speed_mps = moved_m / (static_cast<float>(kWindow) * kStepS);
  motion.curvature_1pm = clamp(wrap_angle(to.heading_rad - from.heading_rad) / max(moved_m, kShortestM),
                               -kSharpest_1pm, kSharpest_1pm);
  return motion;
}

DriverState driver_of(const Pose& centre, const Motion& motion, float length_m) {
  const float wheelbase_m = 0.6F * length_m;
  return {shift_ahead(centre, -0.3F * length_m), motion.speed_mps, atan(wheelbase_m * motion.curvature_1pm),
          wheelbase_m};
}

}  // namespace s4tp
