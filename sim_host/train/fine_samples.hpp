#pragma once
/// What the size full reads of a sample: lane points every metre and our plan every 0.1 s, where the sample holds
/// every third and every fifth of them. Between them lies a straight line.

#include "sim_host/train/sample.hpp"

namespace s4tp::train {

inline constexpr int kLaneFineness =
    3;  ///< points of full to one of a sample: 1 m apart instead of kLaneSpacingM
inline constexpr int kFineLanePoints =
    51;  ///< the last two are never there: a sample's lane path ends at 48 m

/// A lane path of full.
struct FineLane {
  int points = 0;  ///< there, from the first on: those between two that are there
  float row[kFineLanePoints][satp::kLaneFeatures] = {};
};
/// \param points  of the sample's rows that are there, at least 1
/// \return limit, rules and stop line are those of the segment's first point
[[nodiscard]] FineLane fine_lane(const float (&row)[satp::kLanePoints][satp::kLaneFeatures], int points);

/// Our plan of full, a row a decoder step.
struct FinePlan {
  float step[kHorizonSteps][satp::kPlanValues] = {};
};
/// \param pair  of the vehicle the plan is told to: our speed and our ways to the zone at the plan's begin
[[nodiscard]] FinePlan fine_plan(const float (&step)[satp::kDecoderSteps][satp::kPlanValues],
                                 const float (&pair)[satp::kPairFeatures]);

/// What we truly drove: our box centre's x, y, heading in our own frame at the end of each of the sample's plan steps.
struct EgoMotion {
  bool known = false;  ///< false: the plan is unknown, or there is nobody whose frame it is told in
  float pose[satp::kDecoderSteps][3] = {};
};
/// The plan is stored in the others' frames only; that of the first vehicle leads back to ours by its place. Both were
/// taken from the same track, so that an error of it has no say.
[[nodiscard]] EgoMotion ego_motion(const Sample& sample);

}  // namespace s4tp::train
