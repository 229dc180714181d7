#pragma once
/// A plain driver, as traffic simulations have them: keeps to the lane, follows by the intelligent driver
/// model, accepts gaps at junctions and for lane changes: those the route needs, and to pass somebody slow.
/// No prediction beyond "keeps its speed", no risk, no score.
///
/// \code
///   scene -> lane: own, or the one beside when the route needs it, or it gains much, and the gap is accepted
///         -> free motion along it -> first conflict zone whose gap is refused: stop before it
///         -> IDM on what asks for most: leader, stop, road end -> 3 s along the lane's centre line
/// \endcode

#include "algo/planner/planner.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/reference_line.hpp"
#include "sim_host/baselines/idm_driver.hpp"

namespace s4tp::baselines {

class IdmLanePlanner {
 public:
  [[nodiscard]] Status init(const Parameters& parameters);
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation);

  IdmDriver driver;

 private:
  /// A leader, as the place where we would touch it.
  struct Ahead {
    float touch_s_m;   ///< of our rear axle, at plan start
    float speed_mps;   ///< its own, kept
    float least_mps2;  ///< harder we do not brake for it
  };

  [[nodiscard]] const scene::EgoPath& choose_path();
  /// Our acceleration now, were we in the lane of `path`.
  [[nodiscard]] float prospect_mps2(const scene::EgoPath& path, const trajectory::Leader& ahead) const;
  /// Where our rear axle must stop to have room for the lane changes still due.
  [[nodiscard]] float change_room_s_m(const scene::EgoPath& path) const;
  void look_ahead(const scene::EgoPath& path, float lead_s);
  /// Acceleration at a point of our motion; braked for is what look_ahead() found.
  [[nodiscard]] float wanted_mps2(float time_s, float s_m, float speed_mps) const;
  /// Where our rear axle must stop because a gap is refused; far away: nowhere.
  [[nodiscard]] float stop_for_zones(const scene::EgoPath& path, planner::Explanation& explanation);
  [[nodiscard]] bool refuses(const scene::ConflictZone& zone, float in_s, float out_s, float margin_s,
                             planner::Explanation& explanation) const;
  void drive(Trajectory& trajectory) const;

  Parameters parameters_;
  scene::SceneBuilder scene_builder_;
  scene::Scene scene_;
  scene::Manoeuvre changing_ = scene::Manoeuvre::kKeep;  ///< lane change under way
  bool going_ = false;                                   ///< has set off into a junction

  // One cycle's situation, along the path chosen; s is that of our rear axle.
  TrajectoryPoint start_;
  trajectory::ReferenceLine line_;
  trajectory::ReferenceCoordinates where_;
  BoundedVector<Ahead, 3> leaders_;
  float stop_s_m_ = 0.0F;
};

}  // namespace s4tp::baselines
