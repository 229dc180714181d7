#pragma once
/// How another driver moves along a predicted future: what its own field needs.

#include "algo/sadrf/field.hpp"
#include "algo/satp/prediction.hpp"

namespace s4tp::sadrf {

inline constexpr float kMotionWindowS = 0.3F;

/// Speed and path curvature over the 0.3 s up to a step (the first three steps: over the first 0.3 s).
struct RecentMotion {
  float speed_mps = 0.0F;
  float curvature_1pm = 0.0F;  ///< |kappa| <= 0.2
};

/// How far the box centre moves in those 0.3 s. \param step  index into mode.steps
[[nodiscard]] Point moved_at(const satp::Mode& mode, int step);

[[nodiscard]] RecentMotion motion_at(const satp::Mode& mode, int step);
/// \param moved  moved_at() of the same
[[nodiscard]] RecentMotion motion_at(const satp::Mode& mode, int step, Point moved);

/// The field of the driver of a vehicle of `length_m`: wheelbase 0.6 x length, rear axle 0.3 x length behind
/// the box centre (method.md 3).
[[nodiscard]] Field field_of_other(const FieldParams& params, const Pose& centre, const RecentMotion& motion,
                                   float length_m);

}  // namespace s4tp::sadrf
