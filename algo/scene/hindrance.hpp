#pragma once
/// Whether a vehicle that stands has somebody to wait for.

#include "algo/scene/scene.hpp"

namespace s4tp {

/// Whether, on any of its ways of some likelihood, vehicle `index` gives way to one that moves and is in the
/// zone just now or can be within 5 s as it goes: who lets longer gaps pass does not wait for them. Those who
/// stand are no reason: they may wait for it. \pre scene.map is there
[[nodiscard]] bool waits_for_somebody(const Scene& scene, int index);

}  // namespace s4tp
