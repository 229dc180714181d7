#pragma once
/// What drivers do along roads: headways, following, changes of lane and the gaps they take for them.

#include <span>
#include <vector>

#include "sim_host/metrics/traffic_statistics.hpp"
#include "sim_host/world/judge/journey.hpp"

namespace s4tp::metrics {

void add_headways(const world::Network& network, const std::vector<world::Journey>& tracks,
                  TrafficSamples& samples);
void add_following(const world::Network& network, const world::Snapshot& snapshot, TrafficSamples& samples);
/// Merges at a lane's end are among the choices.
void add_lane_changes(const world::Network& network, std::span<const world::Snapshot> snapshots,
                      TrafficSamples& samples);

}  // namespace s4tp::metrics
