#include "algo/sadrf/field.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/path_coordinates.hpp"

namespace s4tp::sadrf {

FieldParams paper_preset(float vehicle_width_m) {
  return {0.0064F, 3.5F, 0.05F, 0.5F, 1.38F, 0.25F * vehicle_width_m, {}};
}

FieldParams kolekar2020_preset(float vehicle_width_m) {
  return {0.0064F, 3.5F, 0.001F, 0.0F, 1.3823F, 0.25F * vehicle_width_m, {}};
}

FieldParams field_params(const Parameters& parameters, float vehicle_width_m) {
  const auto& risk = parameters.risk;
  return {risk.steepness,
          risk.look_ahead_s,
          risk.widening,
          risk.widening_inner,
          risk.widening_outer,
          0.25F * vehicle_width_m,
          {}};
}

float look_ahead_at(float look_ahead_s, bool shrinks, float t_s) {
  constexpr float kShortestS = 1.0F;
  return shrinks ? max(look_ahead_s - t_s, kShortestS) : look_ahead_s;
}

Field prepare_field(const FieldParams& params, Point rear_axle, Point ahead, float speed_mps,
                    float curvature_1pm, float steering_rad) {
  const float blend_rad = params.smoothing.steering_rad;
  const float steering =
      blend_rad > 0.0F ? sqrt(square(steering_rad) + square(blend_rad)) - blend_rad : abs(steering_rad);
  const float inner = params.widening + params.widening_inner * steering;
  const float outer = params.widening + params.widening_outer * steering;
  const bool to_left = steering_rad > 0.0F;
  Field field;
  field.origin = rear_axle;
  field.ahead = ahead;
  field.curvature_1pm = curvature_1pm;
  field.look_ahead_m = max(speed_mps * params.look_ahead_s, kShortestLookAheadM);
  field.steepness = params.steepness;
  field.widening_left = to_left ? inner : outer;
  field.widening_right = to_left ? outer : inner;
  field.base_width_m = params.base_width_m;
  field.ramp_m = params.smoothing.ramp_m;
  // The path itself leaves the tangent by at most kappa d^2 / 2.
  field.lateral_reach_m = 0.5F * abs(curvature_1pm) * square(field.look_ahead_m) +
                          kFieldReach * (params.base_width_m + max(inner, outer) * field.look_ahead_m);
  return field;
}

Field prepare_field(const FieldParams& params, const DriverState& driver) {
  return prepare_field(params, position(driver.rear_axle), direction(driver.rear_axle.heading_rad),
                       driver.speed_mps, tan(driver.steering_rad) / driver.wheelbase_m, driver.steering_rad);
}

float field_at(const Field& field, Point point_m) {
  const Point offset = point_m - field.origin;
  const PathCoordinates at =
      path_coordinates(field.curvature_1pm, dot(field.ahead, offset), cross(field.ahead, offset));
  if (at.s_m < 0.0F || at.s_m > field.look_ahead_m) return 0.0F;
  const float widening = at.e_m > 0.0F ? field.widening_left : field.widening_right;
  const float sigma = widening * at.s_m + field.base_width_m;
  return field.steepness * square(field.look_ahead_m - at.s_m) * exp(-0.5F * square(at.e_m / sigma));
}

float field_at(const FieldParams& params, const DriverState& driver, Point point_m) {
  return field_at(prepare_field(params, driver), point_m);
}

}  // namespace s4tp::sadrf
