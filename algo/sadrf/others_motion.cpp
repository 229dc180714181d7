#include "algo/sadrf/others_motion.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::sadrf {
namespace {

constexpr int kWindow = 3;               // steps
constexpr float kRearAxleShare = 0.3F;   // of its length behind its centre
constexpr float kWheelbaseShare = 0.6F;  // of its length
static_assert(kMotionWindowS == static_cast<float>(kWindow) * kStepS);

int first_of_window(int step) {
  return step >= kWindow ? step - kWindow : 0;
}

}  // namespace

Point moved_at(const satp::Mode& mode, int step) {
  const int first = first_of_window(step);
  return position(mode.steps[first + kWindow]) - position(mode.steps[first]);
}

RecentMotion motion_at(const satp::Mode& mode, int step) {
  return motion_at(mode, step, moved_at(mode, step));
}

RecentMotion motion_at(const satp::Mode& mode, int step, Point moved) {
  constexpr float kShortestM = 0.5F;
  constexpr float kSharpest_1pm = 0.2F;
  const int first = first_of_window(step);
  const float turned_rad =
      wrap_angle(mode.steps[first + kWindow].heading_rad - mode.steps[first].heading_rad);
  const float moved_m = norm(moved);
  return {moved_m / kMotionWindowS,
          clamp(turned_rad / max(moved_m, kShortestM), -kSharpest_1pm, kSharpest_1pm)};
}

Field field_of_other(const FieldParams& params, const Pose& centre, const RecentMotion& motion,
                     float length_m) {
  const Point ahead = direction(centre.heading_rad);
  const Point rear_axle = position(centre) - (kRearAxleShare * length_m) * ahead;
  const float steering_rad = atan(kWheelbaseShare * length_m * motion.curvature_1pm);
  return prepare_field(params, rear_axle, ahead, motion.speed_mps, motion.curvature_1pm, steering_rad);
}

}  // namespace s4tp::sadrf
