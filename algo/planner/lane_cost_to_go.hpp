#pragma once
/// What driving on in each lane promises beyond the horizon: overtaking when it pays (method.md 4.7).
/// 3 s see a slow car ahead, but not that the lane beside it would have saved 8 s by the goal. This
/// drives on in thought, in closed form: we at the limit, everybody else as fast as now.

#include "algo/core/bounded.hpp"
#include "algo/core/parameters.hpp"
#include "algo/planner/lane_gap.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp::planner {

/// Room for a lane change left to do at which it starts to press.
inline constexpr float kChangeRoomM = 60.0F;

class LaneCostToGo {
 public:
  /// Looks at every path of the scene, once a cycle. \param constant_velocity  where the others are meanwhile, from
  /// plan start, `lead_s` after the scene's time \return what it took [WorkMeter's units]
  int look(const scene::Scene& scene, const satp::KinematicSet& constant_velocity, float lead_s,
           const Parameters& parameters);

  /// Time lost [s] against driving at the limit, until the goal or 150 m from here, by whoever is at `s_m`
  /// with `speed_mps` at the horizon's end and then stays in the lane of `path`: behind the slower ones in
  /// it, and behind those in the route's lane of whose gaps none further ahead can be joined before the room for it ends.
  /// Counts less, then nothing, as the room for lane changes that we have to make shortens (kChangeRoomM).
  [[nodiscard]] float delay_s(int path, float s_m, float speed_mps) const;

  /// Speed at which one closes up on whoever is ahead in the lane of `path`, to stand as far behind it as behind one that
  /// stands; large where nobody is. \param start_s_m  of our rear axle at plan start \param s_m  `time_s` later
  [[nodiscard]] float closing_up_mps(int path, float start_s_m, float s_m, float time_s) const;

  /// Time [s] from the horizon's end until who is at `s_m` of `path` with `speed_mps` then is in the gap
  /// there that we can meet; 0 when there is none, or no need of one.
  [[nodiscard]] float time_to_gap_s(int path, float s_m, float speed_mps) const;

  /// What asking for the delay and the gap of every path takes [WorkMeter's units].
  [[nodiscard]] int asking_work() const;

  /// Where to be for the gap of `path` that we can meet, along the keep path at plan start.
  [[nodiscard]] trajectory::MergeTarget merge_target(const scene::Scene& scene, int path) const;

 private:
  struct Lane {
    LaneVehicles seen;
    bool returns = false;     ///< somebody is in the route's lane, which we have to change to
    LaneGap gap;              ///< that we can meet, in a lane beside ours
    float target_s_m = 0.0F;  ///< how far we drive on in thought
    float room_s_m = 0.0F;    ///< where we must have come to rest if a change due has not been made
    float limit_mps = 1.0F;
  };

  /// From our centre to that of whoever stands ahead of us.
  [[nodiscard]] float standing_gap_m(const LaneVehicle& other) const;
  /// When we are at `to_s_m`, behind the other.
  [[nodiscard]] float behind_s(const LaneVehicle& other, float to_s_m) const;
  /// When we are at the lane's target, from `s_m`, alone or behind somebody in the lane.
  [[nodiscard]] float arrival_s(const Lane& lane, float s_m, float speed_mps) const;
  /// Whether whoever goes from `s_m` to a place in a gap may be there after `time_s`: before the room for the change ends,
  /// and not by running into somebody ahead.
  [[nodiscard]] bool can_be_at(const Lane& lane, float place_s_m, float time_s, float s_m) const;
  /// Whether we can be in the gap of the route's lane behind `front`, at its speed, or ahead of all. \pre not both nullptr
  [[nodiscard]] bool can_join(const Lane& lane, const LaneVehicle* front, const LaneVehicle* rear, float s_m,
                              float speed_mps) const;
  /// When we are at the lane's target by way of the route's: in the foremost gap there that can be joined, or from rest at the
  /// last place when all have passed. \pre lane.returns
  [[nodiscard]] float return_s(const Lane& lane, float s_m, float speed_mps) const;
  void find_gaps(const scene::Scene& scene, float lead_s);

  BoundedVector<Lane, decltype(scene::Scene::ego_paths)::kCapacity> lanes_;
  const Parameters* parameters_ = nullptr;
  float way_m_ = 0.0F;
  float weight_ = 1.0F;    ///< of time: 1 while there is ample room for the lane changes left to do
  float centre_m_ = 0.0F;  ///< from our rear axle
  float our_s_m_ = 0.0F;   ///< along the keep path, at plan start
};

}  // namespace s4tp::planner
