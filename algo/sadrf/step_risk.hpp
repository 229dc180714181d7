#pragma once
/// The risk of one instant of a trajectory: our field on their boxes, their fields on ours.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/sadrf/box_slices.hpp"
#include "algo/sadrf/cost_map.hpp"
#include "algo/sadrf/futures.hpp"

namespace s4tp::sadrf {

/// How well a field is integrated over a box.
enum class Precision : std::uint8_t {
  kLines,   ///< two lines: for ranking
  kSlices,  ///< slices where it matters
};

/// What all steps of one trajectory share.
struct StepInputs {
  const scene::Scene& scene;
  const Futures& futures;
  const Trajectory& trajectory;
  const Parameters& parameters;
  Precision precision;
  FieldParams params;            ///< our driver's, but for the look-ahead
  float modulation[kMaxTracks];  ///< g of each agent
};

[[nodiscard]] StepInputs step_inputs(const scene::Scene& scene, const Futures& futures,
                                     const Trajectory& trajectory, const Parameters& parameters,
                                     Precision precision);

struct StepRisk {
  float obstacle = 0.0F;    ///< R_ego of the vehicles
  float social = 0.0F;      ///< R_soc, unweighted
  float share[kMaxTracks];  ///< of each of the scene's agents, both sides weighted as in the sum
};

/// Both sides at step `step` + 1 of the trajectory.
/// CORE-074 Where `work` does not allow more, a box is integrated by two lines, and what others cover of it
/// is read at its centre: least_work() is then what a step takes at most.
/// \param boxes  scratch, too large to be made anew at every step
[[nodiscard]] StepRisk risk_at(const StepInputs& inputs, int step, CostBoxes& boxes, WorkMeter& work);
[[nodiscard]] std::int32_t least_work(int futures);

/// Derivatives of both parts by x, y, heading, speed and road-wheel angle of the trajectory's point; R_soc
/// knows neither speed nor steering of ours.
struct StepSlope {
  float obstacle_risk = 0.0F;
  float social_risk = 0.0F;
  FieldGradient obstacle = {};
  FieldGradient social = {};
};

/// CORE-069 Values and slopes at step `step` + 1; what covers what counts as fixed. Boxes whose risk is below
/// 20 have no slope, nor have those for which `work` does not allow one: least_work() is then what a step takes at most.
[[nodiscard]] StepSlope slope_at(const StepInputs& inputs, int step, CostBoxes& boxes, WorkMeter& work);

}  // namespace s4tp::sadrf
