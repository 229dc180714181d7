#pragma once
/// One of the map's conflicts as the driver on one of its two lanes sees it.

#include "algo/core/world_state.hpp"

namespace s4tp::scene {

struct ConflictView {
  LaneIndex own = kNoLaneIndex;
  LaneIndex other = kNoLaneIndex;
  Priority priority = Priority::kFirstCome;  ///< kFirstYields: the driver on `own` yields
  float own_entry_m = 0.0F;
  float own_exit_m = 0.0F;
  float other_entry_m = 0.0F;
  float other_exit_m = 0.0F;
};

/// Whether indices and arc lengths make sense (the lanes themselves may still be missing).
[[nodiscard]] bool sound(const Conflict& conflict);

/// \pre sound(conflict)
[[nodiscard]] ConflictView view_from(const Conflict& conflict, bool from_second);

}  // namespace s4tp::scene
