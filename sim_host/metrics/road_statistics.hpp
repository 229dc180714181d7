#pragma once
/// What drivers do along roads: headways, following, changes of lane and the gaps they take for them.

#include <span>
#include <vector>

#include "sim_host/metrics/traffic_statistics.hpp"
#include "sim_host/world/judge/journey.hpp"

namespace s4tp::metrics {

void add_headways(const map::Network& network, const std::vector<judge::Journey>& tracks,
                  TrafficSamples& samples);
void add_following(const map::Network& network, const traffic::Snapshot& snapshot, TrafficSamples& samples);
/// Merges at a lane's end are among the choices.
void add_lane_changes(const map::Network& network, std::span<const traffic::Snapshot> snapshots,
                      TrafficSamples& samples);

}  // namespace s4tp::metrics
