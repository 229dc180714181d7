#pragma once
/// How long until two cars touch when both go on as they do.

#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::metrics {

/// Both keep speed and yaw rate: straight on, exactly; on arcs, sampled every 0.05 s. With headings frozen
/// every car that turns past another one would seem about to hit it.
/// \return 0 when they touch already; `horizon_s` when not before it
[[nodiscard]] double time_to_collision_s(const traffic::CarState& a, const traffic::CarState& b,
                                         double horizon_s);

}  // namespace s4tp::metrics
