#pragma once
/// The distance that responsibility-sensitive safety asks of a follower. Source: Shalev-Shwartz et al. 2017,
/// definition 1.
///
/// \code
///   rear --v_r-->  [   d_long   ]  front --v_f-->     safe: gap >= d_long(v_r, v_f)
/// \endcode

#include "algo/core/parameters.hpp"

namespace s4tp::occupancy {

/// RSS-001 Smallest safe longitudinal distance of a follower behind a leader, same direction [m], >= 0.
/// \pre speeds >= 0
[[nodiscard]] float safe_distance_m(float rear_speed_mps, float front_speed_mps,
                                    const Parameters& parameters);

}  // namespace s4tp::occupancy
