#pragma once
/// A point of a field's frame (rear axle, x ahead, y left) seen from the driver's circular path.
///
/// \code
///              centre of the turn
///                 + (0, 1/kappa)
///                /|        q / |kappa| = distance of the point from the centre
///               / |        e = distance from the path, left positive;  1 - kappa e = q
///       point  *  |        s = arc length to the foot of the point
///             /   |
///    path ---'----o rear axle ==>
/// \endcode
/// Source: method.md 3; smooth through straight driving.

namespace s4tp::sadrf {

struct PathCoordinates {
  float s_m;
  float e_m;
  float q;
  float tangent_x;  ///< unit tangent of the path at the foot, in the field's frame
  float tangent_y;
};

[[nodiscard]] PathCoordinates path_coordinates(float curvature_1pm, float x_m, float y_m);

}  // namespace s4tp::sadrf
