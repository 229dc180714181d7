#pragma once
/// The firmware's view of the world, built outside it by the firmware's own functions: what training samples
/// are made of. A copy goes on by itself, as a branch of a world does.

#include <cstdint>
#include <memory>

#include "algo/core/parameters.hpp"
#include "algo/satp/predictor.hpp"
#include "algo/satp/yield_belief.hpp"
#include "algo/scene/scene_builder.hpp"
#include "sim_host/train/sample.hpp"

namespace s4tp::train {

/// Plan start after the scene: the plan of a boundary takes effect at the next one.
inline constexpr std::uint32_t kLeadMs = 100;
inline constexpr float kLeadS = 0.001F * static_cast<float>(kLeadMs);

class Observer {
 public:
  explicit Observer(const Parameters& parameters) : parameters_(parameters) {}

  /// Once every 100 ms. \param map  must live until the next call, in every copy
  /// \return whether there is a scene with a lane under us
  bool look(std::uint32_t now_ms, const EgoState& ego, const TrackList& tracks, std::uint32_t tracks_ms,
            const LaneMap& map);

  [[nodiscard]] const scene::Scene& scene() const { return scene_; }
  /// What the kinematic predictor expects without our plan, in the frames of `input`.
  void expect(const satp::NetworkInput& input, KinematicFuture (&futures)[kMaxAgents]) const;

 private:
  Parameters parameters_;
  scene::SceneBuilder builder_;
  satp::YieldBeliefs beliefs_;
  scene::Scene scene_;
};

}  // namespace s4tp::train
