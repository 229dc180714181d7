#pragma once
/// Whether a vehicle that stands has somebody to wait for.

#include "algo/scene/scene.hpp"

namespace s4tp {

/// Whether, on any of its ways, vehicle `index` gives way to one that moves and is coming or in the zone just
/// now. Those who stand are no reason: they may wait for it. \pre scene.map is there
[[nodiscard]] bool waits_for_somebody(const Scene& scene, int index);

}  // namespace s4tp
