#pragma once
/// A lane change: where the one in force stands. What it may do next stands in one table (lane_change.cpp).
///
/// \code
///             +-- dropped --+       +----- given up, our box over the line ----+
///             v             |       |                                          v
///   keep ---------> prepare ----> crossing ----> finish ----> settle ----> keep
///     ^                             ^              |            |
///     |                             +-- another ---+------------+
/// \endcode

#include "algo/behavior/transition.hpp"
#include "algo/core/manoeuvre.hpp"
#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::behavior {

/// What its transitions are decided by.
struct LaneChangeSituation {
  bool leads_over = false;  ///< the plan taken leads out of the lane under us
  bool goes_on = false;     ///< ... to the lane to which the change in force leads
  bool over_line = false;   ///< our box reaches beyond the line on the side it leads to
  bool over_half = false;   ///< the lane the change in force leads to is the one under us
  bool inside = false;      ///< our whole box is in the lane under us
  bool settled = false;     ///< others have had their time to get used to us
};

inline constexpr int kLaneChangeRows = 14;
extern const Transition<LaneChange, LaneChangeSituation> kLaneChangeTable[kLaneChangeRows];

/// \param side  to which the plan taken leads: 1 left, -1 right, 0: it stays in the lane under us
[[nodiscard]] LaneChangeSituation lane_change_situation(const ManoeuvreState& state, int side,
                                                        const scene::Scene& scene,
                                                        const Parameters& parameters);

/// Index of the ego path on which the change in force goes on; 0, the lane under us, where there is none, or where it leads
/// there already, or cannot go on.
[[nodiscard]] int leads_to(const ManoeuvreState& state, const scene::Scene& scene);

}  // namespace s4tp::behavior
