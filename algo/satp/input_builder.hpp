#pragma once
/// From the scene to what the network sees. The firmware and the data generator of the training call the very
/// same functions.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/satp/network_input.hpp"
#include "algo/satp/path_hypothesis.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::satp {

/// The path hypotheses of the watched vehicles, as read_path_hypothesis gives them.
using PathHypotheses = PathHypothesis[kMaxAgents][kPathsPerAgent];

/// Reads every path of the watched vehicles. \param lead_s  plan start minus scene time, >= 0
void read_path_hypotheses(const scene::Scene& scene, float lead_s, PathHypotheses& hypotheses);

/// SATP-001 Every value is finite and what is missing is 0 and masked; the same scene gives the same bits.
/// SATP-002 Moving and turning scene and map as a whole changes no value but the anchors (up to rounding).
/// \param hypotheses  of this scene and lead
void build_network_input(const scene::Scene& scene, const Parameters& parameters, float lead_s,
                         const PathHypotheses& hypotheses, NetworkInput& input);

/// The same, for who has not read the hypotheses.
void build_network_input(const scene::Scene& scene, const Parameters& parameters, float lead_s,
                         NetworkInput& input);

/// \param plan  our motion from plan start \param input  of the same scene
void build_plan_input(const Trajectory& plan, const Parameters& parameters, const NetworkInput& input,
                      PlanInput& plan_input);
/// The same, for who has kept of the input the `hdvs` rows of `anchor` and `pair`.
void build_plan_input(const Trajectory& plan, const Parameters& parameters, int hdvs, const Pose* anchor,
                      const float (*pair)[kPairFeatures], PlanInput& plan_input);

/// `pose` of the odometry frame in the frame of `anchor`, and back; headings wrapped.
[[nodiscard]] Pose to_anchor(const Pose& anchor, const Pose& pose);
[[nodiscard]] Pose from_anchor(const Pose& anchor, const Pose& pose);

}  // namespace s4tp::satp
