#pragma once
/// Risk of a trajectory: the field of a driver times the cost of what is there, per instant (method.md
/// 3).

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/sadrf/box_slices.hpp"
#include "algo/sadrf/drivable.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::sadrf {

/// Risk per future step, parts kept apart; index i is step i + 1 of the trajectory.
struct RiskProfile {
  float obstacle[kHorizonSteps];  ///< R_ego, vehicles: our field on their boxes
  float road[kHorizonSteps];      ///< R_ego, road: our field off the drivable area and on opposite lanes
  float social[kHorizonSteps];    ///< R_soc: their fields on our box, unweighted
  std::uint8_t dominating_agent = 255;  ///< whose share of any one step is largest; 255: nobody
  std::uint8_t dominating_step = 0;
};

/// dt * sum_t [R(t) + w_x max(0, R_obs(t) - C_t)], R = R_ego + w_soc R_soc (method.md 4.7).
[[nodiscard]] float risk_integral(const RiskProfile& profile, const Parameters& parameters);

/// CORE-062 All modes and steps, both sides. Modes of one vehicle add by probability; where boxes of several
/// vehicles overlap, the dearest covers the others. `others` covers agents beyond the predicted ones.
/// \param area  of scene.map, built once a cycle
void exact_risk(const scene::Scene& scene, const DrivableArea& area, const satp::PredictionSet& prediction,
                const satp::KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                RiskProfile& profile);
/// The same within `work`, of which it spends no more than kLeastExactWork or what there is. CORE-075 Every third step
/// comes first; those not reached any more have the risk of the nearest that was, and what is left for one
/// that cannot be precise (CORE-074) is enough for two lines through each box.
void exact_risk(const scene::Scene& scene, const DrivableArea& area, const satp::PredictionSet& prediction,
                const satp::KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                RiskProfile& profile, WorkMeter& work);

/// CORE-063 Cheap approximation of risk_integral for ranking: likeliest mode, every third step, culled by
/// distance. In two parts, both >= 0: of the vehicles, and of the road.
[[nodiscard]] float rank_risk_of_vehicles(const scene::Scene& scene, const satp::PredictionSet& prediction,
                                          const satp::KinematicSet& others, const Trajectory& trajectory,
                                          const Parameters& parameters, WorkMeter& work);
[[nodiscard]] float rank_risk_of_road(const DrivableArea& area, const Trajectory& trajectory,
                                      const Parameters& parameters, WorkMeter& work);
/// Of the ranking of one candidate, both parts, where there is no work left for more.
[[nodiscard]] std::int32_t least_rank_work(const scene::Scene& scene);

/// The risk at one point of a trajectory, and how it changes with that point.
struct SmoothRisk {
  float value = 0.0F;
  FieldGradient slope = {};  ///< by curvature instead of the road-wheel angle: times L / (1 + (L kappa)^2)
};

/// CORE-070 Each step's share of risk_integral (over dt, without the road part), made smooth, with its slopes
/// by the trajectory's point there: both sides, the excess over C_t, all modes. The field begins with a ramp
/// and widens smoothly (kSmoothField); the excess x is (x + sqrt(x^2 + (C_t / 10)^2)) / 2, less what that
/// is where there is no risk. Steps `first`, `first` + `stride`, ... are written. The road part follows the
/// whole path and has no slope of one point. \param risks  index i: point i + 1 \param work  where it does not allow a
/// box's slope, the box counts as if it had none; where not a step, that is as risky as the one before, without slope
void smooth_risk(const scene::Scene& scene, const satp::PredictionSet& prediction,
                 const satp::KinematicSet& others, const Trajectory& trajectory, const Parameters& parameters,
                 int first, int stride, SmoothRisk (&risks)[kHorizonSteps], WorkMeter& work);

}  // namespace s4tp::sadrf
