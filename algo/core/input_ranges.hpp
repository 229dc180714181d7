#pragma once
/// Ranges of what the planner is told, the numbers that world_state.hpp and s4tp.h promise: in one place, for
/// the ECU, which brings what it hears within them, and the planner, which refuses what lies further out.

#include "algo/core/world_state.hpp"

namespace s4tp {

struct InputRange {
  float low;  ///< promised: low .. high
  float high;
  float least;  ///< taken: least .. most, with what a caller's noise or rounding may add
  float most;
};

inline constexpr InputRange kEgoSpeedMps = {0.0F, 60.0F, 0.0F, 60.0F};
inline constexpr InputRange kEgoAccelerationMps2 = {-12.0F, 12.0F, -12.0F, 12.0F};
inline constexpr InputRange kEgoYawRateRadps = {-2.0F, 2.0F, -2.1F, 2.1F};
inline constexpr InputRange kEgoSteeringRad = {-0.8F, 0.8F, -0.8F, 0.8F};

inline constexpr InputRange kTrackSpeedMps = {0.0F, 60.0F, 0.0F, 61.0F};
inline constexpr InputRange kTrackAccelerationMps2 = {-12.0F, 12.0F, -13.0F, 13.0F};
inline constexpr InputRange kTrackYawRateRadps = {-1.3F, 1.3F, -1.3F, 1.3F};
inline constexpr InputRange kTrackLengthM = {0.5F, 25.0F, 0.5F, 26.0F};
inline constexpr InputRange kTrackWidthM = {0.3F, 3.0F, 0.3F, 3.2F};

inline constexpr float kFarthestInputM = 1e5F;        ///< |x| and |y| are below it
inline constexpr float kMostInputHeadingRad = 10.0F;  ///< |heading| is below it, before it is wrapped

/// `value` brought to low .. high.
[[nodiscard]] float limited(float value, const InputRange& range);

/// The track with every value brought to low .. high and its heading wrapped. \pre its position is in range
[[nodiscard]] Track limited(const Track& track);

/// Whether the value is a number within least .. most.
[[nodiscard]] bool is_taken(float value, const InputRange& range);

}  // namespace s4tp
