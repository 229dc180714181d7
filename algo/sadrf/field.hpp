#pragma once
/// Driving risk field of one driver: how strongly each point ahead is perceived as "where I am about to be".
///
/// \code
///          . - outer sigma_2 - .
///   car ==>------ path -------->   a(s) falls from p (v t_la)^2 at the car to 0 at the look-ahead distance
///          ' - inner sigma_1 - '
/// \endcode
/// Source: method.md 3 (Kolekar et al. 2020, eq. 1 to 4; the exponent is squared).

#include "algo/core/geometry.hpp"
#include "algo/core/parameters.hpp"

namespace s4tp::sadrf {

/// What rounds off the field's step at the car and its kink at zero steering, for who follows its slopes.
struct FieldSmoothing {
  float ramp_m = 0.0F;        ///< the field begins over this length; 0: with a step
  float steering_rad = 0.0F;  ///< b: |delta| is sqrt(delta^2 + b^2) - b
};
/// As method.md 4.8 asks for it.
inline constexpr FieldSmoothing kSmoothField = {1.0F, 0.01F};

struct FieldParams {
  float steepness;       ///< p, 1/m^2 per (unit risk); > 0
  float look_ahead_s;    ///< t_la; 0.5 .. 8
  float widening;        ///< m, growth of sigma per metre driven straight; 0 .. 0.2
  float widening_inner;  ///< k1, extra growth per rad of steering inside the turn
  float widening_outer;  ///< k2, the same outside
  float base_width_m;    ///< c, sigma at the car = vehicle width / 4
  FieldSmoothing smoothing = {};
};

/// A driver: rear-axle pose, speed >= 0, road-wheel angle, wheelbase > 0.
struct DriverState {
  Pose rear_axle;
  float speed_mps;
  float steering_rad;
  float wheelbase_m;
};

/// A field made ready for many points: everything that depends on the driver alone.
struct Field {
  Point origin;           ///< rear axle
  Point ahead;            ///< unit vector of the heading
  float curvature_1pm;    ///< kappa, of the path
  float look_ahead_m;     ///< d_la
  float steepness;        ///< p
  float widening_left;    ///< growth of sigma per metre to the left of the path
  float widening_right;   ///< and to the right
  float base_width_m;     ///< c
  float ramp_m;           ///< FieldSmoothing's; heeded where a gradient is asked for
  float lateral_reach_m;  ///< no point of the field beyond kFieldReach sigma has a larger |y|
};

/// Beyond this many sigma the field counts as nothing when boxes are integrated: exp(-8) = 0.0003.
inline constexpr float kFieldReach = 4.0F;

inline constexpr float kShortestLookAheadM = 1.0F;

/// Presets of method.md 3; c = width / 4.
[[nodiscard]] FieldParams paper_preset(float vehicle_width_m);
[[nodiscard]] FieldParams kolekar2020_preset(float vehicle_width_m);
/// The field of Parameters::risk.
[[nodiscard]] FieldParams field_params(const Parameters& parameters, float vehicle_width_m);

/// t_la' at `t_s` into the horizon: max(t_la - t, 1 s), or t_la when `shrinks` is false.
[[nodiscard]] float look_ahead_at(float look_ahead_s, bool shrinks, float t_s);

[[nodiscard]] Field prepare_field(const FieldParams& params, const DriverState& driver);
/// The same, for who knows the path already. \pre curvature = tan(steering) / wheelbase
[[nodiscard]] Field prepare_field(const FieldParams& params, Point rear_axle, Point ahead, float speed_mps,
                                  float curvature_1pm, float steering_rad);

/// Risk density at a point.
/// \return >= 0; exactly 0 behind the car, beyond the look-ahead distance, and for speed 0 beyond 1 m
/// \note no failure; bounded work: one sqrt, one atan2, one exp
[[nodiscard]] float field_at(const FieldParams& params, const DriverState& driver, Point point_m);
[[nodiscard]] float field_at(const Field& field, Point point_m);

}  // namespace s4tp::sadrf
