#pragma once
/// The controller of Kolekar et al. 2020: one driver's risk field, four cases, no candidates and no
/// prediction.
///
/// \code
///                      v <= v_des                                   v > v_des
///   risk <= C_t   1: accelerate, heading control                 3: slow to v_des, heading control
///   risk >  C_t   2: search the steering of least risk:          4: slow down, steer for least risk
///                    still over C_t: steer there, slow down
///                    else: steer for risk = C_t, keep speed
/// \endcode
/// Risk is R_ego of method.md 3, preset kolekar2020: the field of the driver as it steers, on the boxes
/// of the others where they are now and on what the road costs. Heading control aims at a point of the
/// route's lane; the risk that decides is that of the steering it asks for. The plan is the law itself,
/// driven on for 3 s in a world that stands. Source: method.md 5. The field begins at the rear axle
/// and is v t_la long: at walking pace it ends within our own car, and reaches nobody.

#include <functional>

#include "algo/planner/planner.hpp"
#include "algo/sadrf/drivable.hpp"
#include "algo/sadrf/field.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::baselines {

struct DrfLaw {
  float threshold = 20000.0F;      ///< C_t; of 3, 5, 10 and 20 thousand the one that drives best
  float desired_mps = 60.0F;       ///< v_des, where limit and curves allow it
  float speed_gain_1ps = 1.0F;     ///< of accelerating and slowing to v_des
  float acceleration_mps2 = 2.0F;  ///< most
  float braking_mps2 = 2.5F;       ///< slowing to v_des; and for each C_t that least risk is over C_t
  float braking_max_mps2 = 8.0F;
};

/// A steering angle and an acceleration, and by which of the four cases.
struct DrfCommand {
  int which = 1;
  float steering_rad = 0.0F;
  float acceleration_mps2 = 0.0F;
};

/// The law. \param risk  of a steering angle; searched for within [low_rad, high_rad]
/// \param heading_rad  what heading control steers
[[nodiscard]] DrfCommand drf_command(const DrfLaw& law, const std::function<float(float)>& risk,
                                     float heading_rad, float low_rad, float high_rad, float speed_mps,
                                     float desired_mps);

class DrfControllerPlanner {
 public:
  [[nodiscard]] Status init(const Parameters& parameters);
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation);

  /// Risk of steering so from `state`, in the world of the last plan().
  [[nodiscard]] float risk_of(const TrajectoryPoint& state, float steering_rad) const;

  DrfLaw law;

 private:
  [[nodiscard]] DrfCommand command_at(const TrajectoryPoint& state, float guess_s_m) const;
  [[nodiscard]] float road_risk(const sadrf::Field& field) const;
  [[nodiscard]] sadrf::Ground ground(Point point) const;

  // The ground around us, looked up once a cell.
  static constexpr int kGroundCells = 256;
  static constexpr float kGroundCellM = 0.5F;

  Parameters parameters_;
  scene::SceneBuilder scene_builder_;
  scene::Scene scene_;
  sadrf::DrivableArea area_;
  trajectory::ReferenceLine line_;
  bool has_road_ = false;
  Point ground_corner_;
  mutable std::int8_t ground_[kGroundCells][kGroundCells];  ///< a Ground; < 0: not looked up yet
};

}  // namespace s4tp::baselines
