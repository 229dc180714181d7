#pragma once
/// What scene building works out once a cycle about every lane, and which lanes a pose may belong to.

#include "algo/core/bounded.hpp"
#include "algo/core/world_state.hpp"
#include "algo/scene/lane_path.hpp"

namespace s4tp::scene {

struct LaneFacts {
  bool usable = false;    ///< false: everything else is meaningless
  float length_m = 0.0F;  ///< of the centre line
  float turn_rad = 0.0F;  ///< last chord's heading minus the first one's, left positive
  Point low;              ///< bounding box of the vertices
  Point high;
};

/// Bend of the way a lane leads into: of the lane itself, or of the whole chain of lanes across a junction
/// where it is cut into parts.
struct Bend {
  float turn_rad = 0.0F;  ///< left positive
  float length_m = 0.0F;
  float speed_limit_mps = 0.0F;  ///< the lowest on it
};

/// One lane a pose may be driving on.
struct LaneFit {
  LaneIndex lane = kNoLaneIndex;
  LaneFix fix;
  float turn_rad = 0.0F;  ///< pose's heading minus the lane's
  float score = 0.0F;     ///< smaller is better [m]
};

/// What makes one lane likelier than another beside distance and heading.
struct LaneHint {
  LaneIndex previous = kNoLaneIndex;  ///< the lane it was on: stays unless another is clearly better
  bool follows_route = false;         ///< us: prefers our own lanes and those on the route
};

class LaneTable {
 public:
  static constexpr int kMaxFits = 4;
  using Fits = BoundedVector<LaneFit, kMaxFits>;

  /// \param map  null: no lane is valid
  explicit LaneTable(const LaneMap* map);

  [[nodiscard]] const LaneMap& map() const { return *map_; }  ///< \pre some lane is valid
  [[nodiscard]] const Lane& lane(LaneIndex index) const { return map_->lanes[index]; }
  [[nodiscard]] const LaneFacts& facts(LaneIndex index) const { return facts_[index]; }
  /// \pre valid(index)
  [[nodiscard]] Bend bend(LaneIndex index) const;
  /// Whether an index from outside names a lane that can be used.
  [[nodiscard]] bool valid(LaneIndex index) const;

  /// Lanes within half their width + 1 m of the pose and 60 degrees of its heading, best first. For us + 2.5 m of the one we
  /// come along, and 100 degrees of its: turns sharper than we can be steered lead out of their lane, we turn later than it, and
  /// there it still is our way.
  void fit(const Pose& pose, const LaneHint& hint, Fits& fits) const;

  /// The lane that begins at most 40 m straight ahead of a pose that is on none, or kNoLaneIndex: lanes go on
  /// straight before their start.
  [[nodiscard]] LaneIndex lane_ahead(const Pose& pose) const;

  /// Adds `lane` to the end of `path`. \return false when it is full, or would run in a circle
  [[nodiscard]] bool append(LanePath& path, LaneIndex lane) const;

  /// What making the table and using it has taken [WorkMeter's units]; whoever builds with it adds its own.
  [[nodiscard]] int work() const { return work_; }
  void spend(int units) const { work_ += units; }

 private:
  const LaneMap* map_;
  mutable int work_ = 0;
  LaneFacts facts_[kMaxLanes];
};

}  // namespace s4tp::scene
