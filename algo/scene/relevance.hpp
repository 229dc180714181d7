#pragma once
/// Whom to watch (method.md 4.1).

#include "algo/scene/scene.hpp"

namespace s4tp::scene {

/// Puts the agents that matter most first and sets scene.watched. Equals keep their order.
/// \return what it took [WorkMeter's units]
int rank_agents(Relevance relevance, const Parameters& parameters, Scene& scene);

}  // namespace s4tp::scene
