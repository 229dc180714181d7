#pragma once
/// Room to pass those who stand beside our way.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/along_path.hpp"

namespace s4tp::trajectory {

/// Gap our box needs beside one who stands: the strip that the guard asks for, and what tracking strays.
inline constexpr float kBystanderGapM = kStripM + 0.1F;

/// Whether the vehicle stands, as far as its measured speed tells.
[[nodiscard]] bool is_standing(const scene::Agent& agent);

/// Sets EgoPath::lateral_offset_m of every path (CAND-018): the least of 0, 0.35 and 0.7 m to either side from which
/// our box passes all who stand across or against it, over the next 30 m, with kBystanderGapM. Never beyond
/// the lanes' edges; who cannot be passed so is not minded, and who stands along the path is a leader, not a
/// bystander. \pre scene.map is there, or there are no ego paths
/// \return what it took [WorkMeter's units]
int set_lateral_offsets(const Parameters& parameters, scene::Scene& scene);

}  // namespace s4tp::trajectory
