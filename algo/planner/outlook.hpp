#pragma once
/// What driving on in each lane promises beyond the horizon: overtaking when it pays (METHOD section 4).
/// 3 s see a slow car ahead, but not that the lane beside it would have saved 8 s by the goal. The outlook
/// drives on in thought, in closed form: we at the limit, everybody else as fast as now.

#include "algo/core/bounded.hpp"
#include "algo/core/parameters.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

class Outlook {
 public:
  /// Looks at every path of the scene, once a cycle. \param keep_going  where the others are meanwhile
  void look(const Scene& scene, const KinematicSet& keep_going, const Parameters& parameters);

  /// Time lost [s] against driving at the limit, until the goal or 150 m from here, by whoever is at `s_m`
  /// with `speed_mps` at the horizon's end and then stays in the lane of `path`: behind the slower ones in
  /// it, and behind those in the lanes of the route that he cannot pass before he has to be back there.
  /// Counts less, then nothing, as the room for lane changes that we have to make shortens.
  [[nodiscard]] float delay_s(int path, float s_m, float speed_mps) const;

  /// How much the gaps to the vehicles of the path's lane fall short of what a change into it takes, at the
  /// horizon's end [m].
  [[nodiscard]] float gap_shortage_m(int path, float s_m, float speed_mps) const;

 private:
  /// A vehicle at the horizon's end, along a path.
  struct Seen {
    float s_m = 0.0F;  ///< of its box centre
    float length_m = 0.0F;
    float speed_mps = 0.0F;
    bool in_lane = false;  ///< of the path; else in a lane we have to return to
  };
  struct Lane {
    BoundedVector<Seen, kMaxTracks> seen;
    float target_s_m = 0.0F;  ///< how far the outlook goes
    float return_s_m = 0.0F;  ///< where a way back to the route's lane must have begun
    float limit_mps = 1.0F;
  };
  BoundedVector<Lane, decltype(Scene::ego_paths)::kCapacity> lanes_;
  float way_m_ = 0.0F;
  float weight_ = 1.0F;    ///< of time: 1 while there is ample room for the lane changes left to do
  float length_m_ = 0.0F;  ///< ours
  float centre_m_ = 0.0F;  ///< from our rear axle
  float acceleration_mps2_ = 1.0F;
  float standstill_gap_m_ = 0.0F;
  float headway_s_ = 0.0F;
};

}  // namespace s4tp
