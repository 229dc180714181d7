#pragma once
/// How far a vehicle is from every lane, by the shortest legal way (method.md 4.9): successors, lane changes,
/// whatever way is likely. OCC-003 Each lane that successors and lane changes lead to is reached, by the
/// shortest way there is. OCC-004 Where the map left lanes out, whoever is on none of the others may be on one
/// of those: it may come, straight from where it is, into each lane that no other leads into, but no sooner than grip turns it
/// there.
///
/// \code
///   ====[car]======> lane 3 ------> lane 7 (junction) ---->     to lane 7: what is left of lane 3
///   ===============> lane 4 ------> lane 8 (junction) ---->     to lane 8: the same, a change in between
/// \endcode

#include <cstdint>

#include "algo/scene/scene.hpp"

namespace s4tp::occupancy {

/// Stands for "no legal way" [m].
inline constexpr float kNoWayM = 300.0F;

class LaneReach {
 public:
  /// Measures from the centre of the agent's box. An agent on no lane reaches none,
  /// or what OCC-004 says.
  /// \note bounded work: each of the map's lanes is looked at a few times
  /// \param changes  false: without lane changes, along the lanes it is in or changes to already
  /// \return what it took [WorkMeter's units]
  int measure(const LaneMap& map, const scene::Agent& agent, bool changes = true);

  /// Way from the vehicle's centre to the start of the lane; negative on the lane, kNoWayM when no way leads
  /// there. \pre lane is an index of the map
  [[nodiscard]] float to_start_m(LaneIndex lane) const;

  /// As measured, but from so much further back on the same lane, or on what leads into it.
  void move_back(float way_m);

 private:
  std::int16_t to_start_cm_[kMaxLanes];
  float back_m_ = 0.0F;
};

}  // namespace s4tp::occupancy
