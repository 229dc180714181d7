#pragma once
/// M_obs, the vehicles' part of the cost map at one future step: what each point costs because of who stands
/// there.
///
/// \code
///   M_obs(p) = max over vehicles of  sum over modes of  prob * C_obs * g * [p in the mode's box]
/// \endcode
/// Modes add as an expectation; vehicles cover each other: one place never costs twice.
/// Source: method.md 3.

#include "algo/core/parameters.hpp"
#include "algo/sadrf/field.hpp"
#include "algo/sadrf/futures.hpp"

namespace s4tp::sadrf {

/// One mode of one vehicle at the step.
struct CostBox {
  Box box;
  Point ahead;        ///< unit vector of the box's heading
  float cost = 0.0F;  ///< prob * C_obs * g
  int agent = 0;
};

using CostBoxes = BoundedVector<CostBox, Futures::kCapacity>;  ///< the modes of one vehicle side by side

/// CORE-065 g of a vehicle, by its distance d from us and the speed c at which it closes in, now:
/// 1 + nearness exp(-d / 20 m) + closing max(c, 0) / (10 m/s). 1 with the default parameters.
[[nodiscard]] float modulation(const EgoState& ego, const Track& track, const Parameters& parameters);

/// Every future of every vehicle. \param step  0: kStepS from now
void place_obstacles(const scene::Scene& scene, const Futures& futures, int step,
                     const Parameters& parameters, CostBoxes& boxes);

/// Whether the point lies in the box.
[[nodiscard]] bool covers(const CostBox& one, Point point);

/// What vehicle `agent` alone costs at a point.
[[nodiscard]] float cost_of(const CostBoxes& boxes, int agent, Point point);

/// M_obs at a point.
[[nodiscard]] float obstacle_cost(const CostBoxes& boxes, Point point);

/// M_obs of a square cell: the mean of 4 x 4 sub-samples, so that a box counts by the area it covers.
/// \param cell  its centre and the heading of its sides
[[nodiscard]] float obstacle_cost(const CostBoxes& boxes, const Pose& cell, float side_m);

/// CORE-066 A cell's part of R_ego: the field at its centre times its cost times its area. Over cells that
/// cover everybody the sum converges to the integral: against that the error is at most 1 % (median) and 3 %
/// (p95) with sides of 0.25 m, and falls as they halve from 1 m.
[[nodiscard]] float cell_risk(const Field& field, const CostBoxes& boxes, const Pose& cell, float side_m);

}  // namespace s4tp::sadrf
