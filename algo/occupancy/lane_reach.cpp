#include "algo/occupancy/lane_reach.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"

namespace s4tp::occupancy {
namespace {

constexpr float kChangeWayM = 8.0F;  // a lane change takes at least this much of the lane that is left
constexpr float kCmPerM = 100.0F;
constexpr float kMPerCm = 0.01F;
constexpr float kTinyM = 0.01F;  // no division by less
constexpr std::int16_t kNoWayCm = 30000;
constexpr float kHorizonM = 160.0F;  // the map's own, and a little
constexpr int kMostRounds = 12;      // lanes of a way, changes included

// Work (WorkMeter's units).
constexpr int kReachWork = 12;
constexpr int kTwoLooksWork = 5;  // of two lanes followed
constexpr int kLedIntoWork = 320;

/// Way from a vehicle that comes from no lane we know to a place: straight, but for what it drives until grip has turned it there.
float way_to_m(const Track& track, Point place) {
  const Point offset = place - position(track.centre);
  const float straight_m = norm(offset);
  const float towards_mps =
      track.speed_mps * dot(offset, direction(track.centre.heading_rad)) / max(straight_m, kTinyM);
  const float turned_s =
      (sqrt(square(towards_mps) + 2.0F * kGripMps2 * straight_m) - towards_mps) / kGripMps2;
  return max(straight_m, track.speed_mps * turned_s);
}

bool has_lane(const LaneMap& map, LaneIndex lane) {
  return lane >= 0 && lane < kMaxLanes && map.lanes[lane].present;
}

}  // namespace

float LaneReach::to_start_m(LaneIndex lane) const {
  if (to_start_cm_[lane] >= kNoWayCm) return kNoWayM;
  return kMPerCm * static_cast<float>(to_start_cm_[lane]) + back_m_;
}

void LaneReach::move_back(float way_m) {
  back_m_ = back_m_ + way_m;
}

int LaneReach::measure(const LaneMap& map, const scene::Agent& agent, bool changes) {
  for (std::int16_t& way_cm : to_start_cm_) way_cm = kNoWayCm;
  back_m_ = 0.0F;
  int work = kReachWork;
  LaneIndex front[kMaxLanes];  // lanes whose neighbours are still to be looked at
  int count = 0;
  bool waiting[kMaxLanes] = {};
  const auto offer = [&](LaneIndex lane, float way_m) {
    // What is not a number is no way.
    if (!has_lane(map, lane) || !(abs(way_m) < kHorizonM)) return;
    const std::int16_t way_cm = static_cast<std::int16_t>(to_int(kCmPerM * way_m, -kNoWayCm, kNoWayCm));
    if (way_cm >= to_start_cm_[lane]) return;
    to_start_cm_[lane] = way_cm;
    if (!waiting[lane]) {
      waiting[lane] = true;
      front[count++] = lane;
    }
  };
  for (int i = 0; i < agent.paths.size(); ++i) {
    for (const scene::PathLane& part : agent.paths[i].lanes)
      offer(part.lane, part.start_s_m - agent.frenet[i].s_m);
  }
  if (agent.paths.empty() && map.lanes_left_out > 0) {
    work += kLedIntoWork;
    bool led_into[kMaxLanes];
    scene::find_led_into(map, led_into);
    for (LaneIndex lane = 0; lane < kMaxLanes; ++lane) {
      if (!led_into[lane]) offer(lane, way_to_m(agent.track, map.lanes[lane].points[0]));
    }
  }
  // A shorter way found later is followed again: rounds bound how often.
  for (int round = 0; round < kMostRounds && count > 0; ++round) {
    LaneIndex now[kMaxLanes];
    const int waiting_now = count;
    work += 1 + kTwoLooksWork * waiting_now / 2;
    for (int i = 0; i < waiting_now; ++i) {
      now[i] = front[i];
      waiting[now[i]] = false;
    }
    count = 0;
    for (int i = 0; i < waiting_now; ++i) {
      const Lane& lane = map.lanes[now[i]];
      const float start_m = to_start_m(now[i]);
      const float end_m = start_m + lane.length_m;
      if (end_m < 0.0F) continue;  // it has left the lane
      for (const LaneIndex successor : lane.successors) offer(successor, end_m);
      if (!changes || lane.in_junction || min(lane.length_m, end_m) < kChangeWayM) continue;
      // Lanes side by side begin side by side.
      offer(lane.left, start_m);
      offer(lane.right, start_m);
    }
  }
  return work;
}

}  // namespace s4tp::occupancy
