#include "sim_host/metrics/junction_statistics.hpp"

#include <algorithm>
#include <optional>

#include "sim_host/world/map/lane_of.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::metrics {
namespace {

using judge::Journey;
using map::kNoLane;
using map::Lane;
using map::LaneId;
using map::Rule;

constexpr double kMoving_mps = 3.0;
constexpr double kPetMax_s = 10.0;
constexpr double kFirstInLine_m = 15.0;
constexpr double kTurn_rad = 0.6;
constexpr double kStuck_s = 60.0;

void post_encroachment(const map::Network& network, const std::vector<Journey>& tracks,
                       TrafficSamples& samples) {
  struct Stay {
    double in_s = 0.0;
    double out_s = 0.0;
    bool first_lane = false;
  };
  for (const map::Conflict& zone : network.conflicts) {
    std::vector<Stay> stays;
    for (const Journey& track : tracks) {
      for (const bool first : {true, false}) {
        const LaneId lane = first ? zone.first : zone.second;
        const auto in_s = track.time_at(lane, first ? zone.first_entry_m : zone.second_entry_m);
        const auto out_s = track.time_at(lane, first ? zone.first_exit_m : zone.second_exit_m);
        if (in_s && out_s) {
          stays.push_back({*in_s, *out_s, first});
        }
      }
    }
    std::sort(stays.begin(), stays.end(), [](const Stay& a, const Stay& b) { return a.in_s < b.in_s; });
    for (std::size_t i = 1; i < stays.size(); ++i) {
      const double pet_s = stays[i].in_s - stays[i - 1].out_s;
      if (stays[i].first_lane != stays[i - 1].first_lane && pet_s < kPetMax_s) {
        samples.post_encroachment_s.push_back(pet_s);
      }
    }
  }
}

/// Ground of a junction somebody has to give way on.
struct YieldZone {
  LaneId own = kNoLane;
  double own_entry_m = 0.0;
  LaneId other = kNoLane;
  double other_entry_m = 0.0;
};

/// Of a way through a junction that begins with this lane (some have two, to wait between).
std::vector<YieldZone> yield_zones(const map::Network& network, LaneId first_lane) {
  std::vector<YieldZone> zones;
  LaneId lane = first_lane;
  for (int part = 0; part < 3 && lane != kNoLane && lane_of(network, lane).in_junction; ++part) {
    for (const map::Conflict& c : network.conflicts) {
      if (c.first == lane && c.rule == Rule::kFirstYields) {
        zones.push_back({lane, c.first_entry_m, c.second, c.second_entry_m});
      } else if (c.second == lane && c.rule == Rule::kFirstHasPriority) {
        zones.push_back({lane, c.second_entry_m, c.first, c.first_entry_m});
      }
    }
    const std::vector<LaneId>& next = lane_of(network, lane).successors;
    lane = next.empty() ? kNoLane : next.front();
  }
  return zones;
}

/// By the angle between the lanes before and behind the junction.
Manoeuvre turn_of(const map::Network& network, LaneId inside) {
  const Lane& before = lane_of(network, lane_of(network, inside).predecessors.front());
  LaneId after = inside;
  for (int part = 0; part < 3 && lane_of(network, after).in_junction; ++part) {
    if (lane_of(network, after).successors.empty()) {
      break;
    }
    after = lane_of(network, after).successors.front();
  }
  const double turn_rad = map::wrap_angle(lane_of(network, after).centre.at(0.0).heading_rad -
                                          before.centre.at(before.centre.length_m()).heading_rad);
  return turn_rad > kTurn_rad    ? Manoeuvre::kLeftTurn
         : turn_rad < -kTurn_rad ? Manoeuvre::kRightTurn
                                 : Manoeuvre::kStraight;
}

/// When a driver is first in line near the end of a lane: nobody of the others on it is still before it.
std::optional<double> first_in_line_s(const Journey& self, LaneId lane, double length_m,
                                      const std::vector<Journey>& tracks, double entered_s) {
  const double near_m = length_m - kFirstInLine_m - 0.5 * self.length_m;
  const auto near_s = self.time_at(lane, near_m);
  if (!near_s && (self.points.front().lane != lane || self.points.front().s_m < near_m)) {
    return std::nullopt;
  }
  double since_s = near_s.value_or(self.points.front().time_s);
  for (const Journey& other : tracks) {
    const auto left_s = other.time_at(lane, length_m - 0.5 * other.length_m);
    if (other.id != self.id && left_s && *left_s < entered_s) {
      since_s = std::max(since_s, *left_s);
    }
  }
  return since_s;
}

void add_choice(const std::vector<double>& others_s, double since_s, double taken_s, Manoeuvre manoeuvre,
                TrafficSamples& samples) {
  GapChoice choice;
  double before_s = since_s;
  bool any = false;
  for (const double other_s : others_s) {
    if (other_s <= since_s) {
      continue;
    }
    any = true;
    if (other_s >= taken_s) {
      choice.accepted_s = other_s - before_s;
      samples.accepted_s.push_back(choice.accepted_s);
      break;
    }
    samples.rejected_s.push_back(other_s - before_s);
    choice.largest_rejected_s = std::max(choice.largest_rejected_s, other_s - before_s);
    before_s = other_s;
  }
  if (any) {
    samples.choices[manoeuvre].push_back(choice);
  }
}

/// Others' passages of the ground, referred to the line; none where the recording ends too early to say.
std::optional<std::vector<double>> others_at_line_s(const std::vector<YieldZone>& zones, const Journey& self,
                                                    double entered_s, const std::vector<Journey>& tracks) {
  std::vector<double> times_s;
  for (const YieldZone& zone : zones) {
    const auto own_s = self.time_at(zone.own, zone.own_entry_m);
    if (!own_s) {
      return std::nullopt;
    }
    for (const Journey& other : tracks) {
      const auto other_s = other.time_at(zone.other, zone.other_entry_m);
      if (other_s && other.id != self.id) {
        times_s.push_back(*other_s - (*own_s - entered_s));
      }
    }
  }
  std::sort(times_s.begin(), times_s.end());
  return times_s;
}

void junction_gaps(const map::Network& network, const std::vector<Journey>& tracks, TrafficSamples& samples) {
  for (std::size_t id = 0; id < network.lanes.size(); ++id) {
    const Lane& inside = network.lanes[id];
    if (!inside.in_junction || inside.predecessors.empty() ||
        lane_of(network, inside.predecessors.front()).in_junction) {
      continue;
    }
    const std::vector<YieldZone> zones = yield_zones(network, static_cast<LaneId>(id));
    if (zones.empty()) {
      continue;
    }
    const Manoeuvre manoeuvre = turn_of(network, static_cast<LaneId>(id));
    const LaneId before = inside.predecessors.front();
    const double before_m = lane_of(network, before).centre.length_m();
    for (const Journey& self : tracks) {
      const auto entered_s = self.time_at(before, before_m - 0.5 * self.length_m);
      if (!entered_s || !self.time_at(static_cast<LaneId>(id), 0.0)) {
        continue;
      }
      const auto since_s = first_in_line_s(self, before, before_m, tracks, *entered_s);
      const auto others_s = others_at_line_s(zones, self, *entered_s, tracks);
      if (since_s) {
        samples.waits_s[manoeuvre].push_back(*entered_s - *since_s);
      }
      if (since_s && others_s) {
        add_choice(*others_s, *since_s, *entered_s, manoeuvre, samples);
      }
    }
  }
}

/// Who stands at the end of a lane that leads into a junction when the recording ends, and has for long.
void still_waiting(const map::Network& network, const std::vector<Journey>& tracks, double last_s,
                   TrafficSamples& samples) {
  for (const Journey& track : tracks) {
    const judge::JourneyPoint& last = track.points.back();
    const Lane& lane = lane_of(network, last.lane);
    const bool at_line = !lane.successors.empty() && lane_of(network, lane.successors.front()).in_junction &&
                         last.s_m > lane.centre.length_m() - kFirstInLine_m - 0.5 * track.length_m;
    const auto moved = std::find_if(track.points.rbegin(), track.points.rend(),
                                    [](const judge::JourneyPoint& p) { return p.speed_mps > kMoving_mps; });
    const double since_s = moved == track.points.rend() ? track.points.front().time_s : moved->time_s;
    if (at_line && !lane.in_junction && last.time_s > last_s - 0.5 * traffic::kSnapshotPeriod_s &&
        last_s - since_s > kStuck_s) {
      ++samples.still_waiting;
    }
  }
}

}  // namespace

void add_junctions(const map::Network& network, const std::vector<Journey>& tracks, double last_s,
                   TrafficSamples& samples) {
  post_encroachment(network, tracks, samples);
  junction_gaps(network, tracks, samples);
  still_waiting(network, tracks, last_s, samples);
}

}  // namespace s4tp::metrics
