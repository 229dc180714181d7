#pragma once
/// What the ego of a branch sees of the cars around it, without the wire.

#include <cstdint>
#include <map>
#include <vector>

#include "algo/scene/scene.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::train {

/// The nearest in range, under lasting ids, with the errors of a perception.
class BranchTracks {
 public:
  BranchTracks(const scenario::PerceptionOptions& errors, map::Vec2 origin, std::uint64_t seed)
      : errors_(errors), origin_(origin), random_(seed) {}

  /// Takes over the ids of a scene. \param cars  as they are at its time
  void adopt(const scene::Scene& scene, const std::vector<traffic::CarState>& cars);
  [[nodiscard]] TrackList of(const traffic::CarState& ego, std::vector<traffic::CarState> cars);

 private:
  double noisy(double value, double deviation);
  Track track_of(const traffic::CarState& car);

  scenario::PerceptionOptions errors_;
  map::Vec2 origin_;
  traffic::Random random_;
  std::map<int, std::uint8_t> ids_;
  int last_id_ = 0;
};

}  // namespace s4tp::train
