#pragma once
/// Our own motion as another driver sees it: along that driver's path where we are on it or about to be, and
/// through the zones where the paths cross.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/satp/path_hypothesis.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::satp {

/// We on somebody's path, every kEgoKnotS from plan start.
inline constexpr int kEgoKnots = 7;
inline constexpr float kEgoKnotS = 0.5F;

struct EgoOnPath {
  bool ever = false;            ///< false: never in its way, the rest is meaningless
  bool from_start = false;      ///< already there at plan start
  float headway_s = 0.0F;       ///< then: what the vehicle behind us keeps
  bool present[kEgoKnots];      ///< in its way then, or within the next 0.5 s
  float rear_s_m[kEgoKnots];    ///< of our hindmost corner
  float centre_s_m[kEgoKnots];  ///< of our box centre
  float speed_mps[kEgoKnots];   ///< along its path
};

/// When we are in a zone; entry > exit: never.
struct TimeInZone {
  float entry_s = occupancy::kNeverS;
  float exit_s = 0.0F;
};

class EgoMotion {
 public:
  /// \param plan  null: we keep lane and speed (conditioned() is then false)
  EgoMotion(const scene::Scene& scene, const Parameters& parameters, float lead_s, const Trajectory* plan);

  [[nodiscard]] bool conditioned() const { return plan_ != nullptr; }
  /// \param their_s_m  where the vehicle is on its path at plan start
  [[nodiscard]] EgoOnPath on_path(const scene::LanePath& path, float their_s_m, const Track& track) const;
  [[nodiscard]] TimeInZone time_in_zone(const PathConflict& conflict) const;
  /// Whether our box is inside the crossing at plan start.
  [[nodiscard]] bool inside(const PathConflict& conflict) const;

 private:
  [[nodiscard]] bool zone_on_our_path(const PathConflict& conflict, float& entry_s_m, float& exit_s_m) const;

  const scene::Scene& scene_;
  const Parameters& parameters_;
  const Trajectory* plan_;
  Pose centre_[kEgoKnots];
  float speed_[kEgoKnots];
  const scene::EgoPath* path_ = nullptr;  ///< the one we follow
  float s_m_[kEgoKnots];                  ///< of our centre along it
};

}  // namespace s4tp::satp
