#include "sim_host/metrics/vehicle_tracks.hpp"

#include <algorithm>
#include <map>

namespace s4tp::metrics {
namespace {

using world::kNoLane;
using world::LaneId;
using world::NetworkLane;

constexpr std::size_t kChainMax = 4;  // lanes passed in 0.1 s: seams between edges are 1 m long

const NetworkLane& lane_of(const world::Network& network, LaneId id) {
  return network.lanes[static_cast<std::size_t>(id)];
}

/// Lanes from `from` to `to` going forward, both included; empty: not within reach.
std::vector<LaneId> chain(const world::Network& network, LaneId from, LaneId to, std::size_t most) {
  if (from == to) {
    return {from};
  }
  if (most <= 1) {
    return {};
  }
  for (const LaneId next : lane_of(network, from).successors) {
    std::vector<LaneId> rest = chain(network, next, to, most - 1);
    if (!rest.empty()) {
      rest.insert(rest.begin(), from);
      return rest;
    }
  }
  return {};
}

void add_segments(const world::Network& network, VehicleTrack& track, const TrackPoint& before,
                  world::Vec2 centre_before, const TrackPoint& now) {
  const std::vector<LaneId> lanes = chain(network, before.lane, now.lane, kChainMax);
  if (lanes.empty()) {  // a change of lane
    const double from_m = lane_of(network, now.lane).centre.project(centre_before).s_m;
    track.segments.push_back({now.lane, before.time_s, now.time_s, from_m, now.s_m});
    return;
  }
  double whole_m = now.s_m - before.s_m;
  for (std::size_t i = 0; i + 1 < lanes.size(); ++i) {
    whole_m += lane_of(network, lanes[i]).centre.length_m();
  }
  double from_m = before.s_m;
  for (const LaneId lane : lanes) {
    track.segments.push_back({lane, before.time_s, now.time_s, from_m, from_m + whole_m});
    from_m -= lane_of(network, lane).centre.length_m();
  }
}

}  // namespace

std::optional<double> VehicleTrack::time_at(LaneId lane, double s_m) const {
  for (const TrackSegment& segment : segments) {
    if (segment.lane == lane && segment.from_m < s_m && s_m <= segment.until_m) {
      return segment.from_s +
             (segment.until_s - segment.from_s) * (s_m - segment.from_m) / (segment.until_m - segment.from_m);
    }
  }
  return std::nullopt;
}

std::vector<VehicleTrack> tracks_of(const world::Network& network,
                                    std::span<const world::Snapshot> snapshots) {
  struct Last {
    std::size_t track = 0;
    world::Vec2 centre;
  };
  std::vector<VehicleTrack> tracks;
  std::map<int, Last> last;
  for (const world::Snapshot& snapshot : snapshots) {
    for (const world::CarState& car : snapshot.others) {
      if (car.lane == kNoLane) {
        continue;
      }
      const TrackPoint now{snapshot.time_s, car.lane,
                           lane_of(network, car.lane).centre.project(car.centre).s_m, car.speed_mps};
      const auto [entry, fresh] = last.try_emplace(car.id, Last{tracks.size(), car.centre});
      if (fresh) {
        tracks.push_back({car.id, car.length_m, {}, {}});
      } else {
        VehicleTrack& track = tracks[entry->second.track];
        add_segments(network, track, track.points.back(), entry->second.centre, now);
        entry->second.centre = car.centre;
      }
      tracks[entry->second.track].points.push_back(now);
    }
  }
  return tracks;
}

}  // namespace s4tp::metrics
