#pragma once
/// The futures of all vehicles in one list, whoever predicted them.

#include "algo/core/bounded.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::sadrf {

/// One future of one vehicle.
struct Future {
  const satp::Mode* mode = nullptr;
  float probability = 0.0F;
  int agent = 0;                 ///< index into Scene::agents
  const Track* track = nullptr;  ///< the agent's
};

/// In the order of agents, the modes of one side by side.
using Futures = BoundedVector<Future, kMaxAgents * kMaxModes + kMaxTracks>;

/// Every mode of the predicted vehicles; for the others their kinematic future, as if it were certain.
[[nodiscard]] Futures all_modes(const scene::Scene& scene, const satp::PredictionSet& prediction,
                                const satp::KinematicSet& others);

/// Keeps the likeliest mode of each vehicle, as if it were certain.
void keep_likeliest(Futures& futures);

}  // namespace s4tp::sadrf
