#pragma once
/// The lines our paths are driven on, past those who stand beside them.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {

/// Gap our box needs beside one who stands: the strip that the guard asks for, and what tracking strays.
inline constexpr float kBystanderGapM = kStripM + 0.1F;

/// Whether the vehicle stands, as far as its measured speed tells.
[[nodiscard]] bool is_standing(const scene::Agent& agent);

/// Builds the line that each path is driven on, from where plans begin, and sets EgoPath::driven and lateral_offset_m
/// (CAND-018): the least of 0, 0.35 and 0.7 m to either side from which our box passes all who stand across or
/// against it, over the next 30 m, with kBystanderGapM. Never beyond the lanes' edges, nor tighter than we can steer; who
/// cannot be passed so is not minded, and who stands along the path is a leader, not a bystander.
/// \param lead_s  plan start after the scene's time \param lines  must outlive the scene's use
/// \pre scene.map is there, or there are no ego paths
/// \return what it took [WorkMeter's units]
int build_lines(const TrajectoryPoint& start, float lead_s, const Parameters& parameters, scene::Scene& scene,
                ReferenceLines& lines);

}  // namespace s4tp::trajectory
