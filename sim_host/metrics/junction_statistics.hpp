#pragma once
/// What drivers do where lanes cross and merge: encroachments, gaps taken and let pass, waits at the line.

#include <vector>

#include "sim_host/metrics/traffic_statistics.hpp"
#include "sim_host/world/judge/journey.hpp"

namespace s4tp::metrics {

/// Adds choices, gaps, waits, post-encroachment times and who is still waiting at the recording's end.
void add_junctions(const map::Network& network, const std::vector<judge::Journey>& tracks, double last_s,
                   TrafficSamples& samples);

}  // namespace s4tp::metrics
