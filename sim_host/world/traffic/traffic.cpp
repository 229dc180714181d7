#include "sim_host/world/traffic/traffic.hpp"

#include <algorithm>
#include <cmath>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::traffic {
namespace {

constexpr double kInvites_s = 4.5;  // somebody waiting; it stops a little longer, lest both go at once
constexpr double kChange_s = 3.0;   // a lane change takes this long
constexpr double kChange_m = 15.0;  // and this way at least
constexpr double kSideGone = 0.75;  // of a change, when the old lane is free again

}  // namespace

double Car::offset_m() const {
  const double p = change_done;
  return change_from_m * (1.0 - p * p * p * (10.0 - 15.0 * p + 6.0 * p * p));
}

Traffic::Traffic(const map::Network& network, const std::vector<scenario::FlowGroup>& groups,
                 std::uint64_t seed)
    : road_(std::make_shared<const RoadIndex>(network)), seed_(seed), waiting_(network.lanes.size()) {
  Random random(seed);
  plan_ = std::make_shared<const FlowPlan>(draw_flows(network, groups, kDrawnUntil_s, random));
}

Traffic::Traffic(const scenario::Scenario& scenario, std::uint64_t episode, std::uint64_t seed)
    : Traffic(scenario.network, scenario.flows, seed) {
  if (!scenario.demands.empty()) {
    const scenario::Mission& mission = scenario.mission;
    Random random(seed);
    plan_ = std::make_shared<const FlowPlan>(
        draw_demand(scenario.network, scenario.demands[episode % scenario.demands.size()],
                    std::max(kDrawnUntil_s, mission.entry_time_s + mission.time_limit_s), random));
  }
}

std::unique_ptr<TrafficEngine> Traffic::clone() const {
  return std::make_unique<Traffic>(*this);
}

void Traffic::step(const EgoSeen* ego) {
  if (ticks_ % kDecisionTicks == 0) {
    decide(ego == nullptr ? nullptr : &ego->actor);
  }
  ++ticks_;
  for (Car& car : cars_) {
    move(car);
  }
  std::erase_if(cars_, [](const Car& car) { return car.lane == map::kNoLane; });
}

void Traffic::decide(const Actor* ego) {
  const TrafficView view(*road_, actors(ego));
  const std::size_t first = ego != nullptr ? 1 : 0;
  for (std::size_t i = 0; i < cars_.size(); ++i) {
    const Actor& self = view.actors()[first + i];
    cars_[i].acceleration_mps2 = acceleration(cars_[i], self, view);
    consider_lane_change(cars_[i], self, view);
  }
  insert_waiting(ego);
  if (ego != nullptr) {
    watch_ego(view.actors().front(), view);
  }
}

std::vector<Actor> Traffic::actors(const Actor* ego) const {
  std::vector<Actor> all;
  if (ego != nullptr) {
    all.push_back(*ego);
    all.back().waited_s = ego_waited_s_;
    all.back().queues = ego_queues_;
    all.back().waits_for = ego_waits_for_;
  }
  for (const Car& car : cars_) {
    all.push_back(actor_of(car));
  }
  return all;
}

/// How long the ego has stood at a line, and for whom it seems to, as others see it.
void Traffic::watch_ego(const Actor& ego, const TrafficView& view) {
  Approach approach;
  approach.self = &ego;
  approach.driver = &ego_driver_;
  approach.wanted_mps = ego.lane == map::kNoLane ? ego.speed_mps : lane(ego.lane).speed_limit_mps;
  approach.waited_s = ego_waited_s_;
  approach.leader = view.leader(ego.way, ego.id, ego.length_m);
  const JunctionChoice choice = choose_at_junction(view, approach);
  const bool at_line = choice.near && choice.line_m < kNear_m;
  ego_waited_s_ = !at_line ? 0.0 : ego_waited_s_ + (ego.speed_mps < 1.0 ? kDecision_s : 0.0);
  ego_queues_ = choice.queues;
  ego_waits_for_ = choice.waits_for;
}

Actor Traffic::actor_of(const Car& car) const {
  Actor actor;
  actor.id = car.id;
  actor.lane = car.lane;
  actor.s_m = car.s_m;
  actor.speed_mps = car.speed_mps;
  actor.length_m = car.length_m;
  actor.guide = &plan_->ways[car.way].guide;
  actor.committed = car.committed;
  actor.waited_s = car.waited_s;
  actor.queues = car.queues;
  actor.waits_for = car.waits_for;
  actor.lets_go = car.gave_way_s < kInvites_s ? car.lets_go : kNoCar;
  if (car.leaving != map::kNoLane) {
    actor.also.push_back({car.leaving, -car.s_m});
  }
  return actor;
}

void Traffic::move(Car& car) {
  car.speed_mps = std::max(0.0, car.speed_mps + car.acceleration_mps2 * kTick_s);
  car.s_m += car.speed_mps * kTick_s;
  if (car.change_done < 1.0) {
    car.change_done =
        std::min(1.0, car.change_done + kTick_s * std::min(1.0 / kChange_s, car.speed_mps / kChange_m));
    if (car.change_done > kSideGone) {
      car.leaving = map::kNoLane;
    }
  }
  const double length_m = lane(car.lane).centre.length_m();
  if (car.s_m < length_m) {
    return;
  }
  const map::LaneId next = plan_->ways[car.way].guide.advice(car.lane).next;
  if (next != map::kNoLane) {
    car.s_m -= length_m;
    car.lane = next;
    car.leaving = map::kNoLane;
  } else if (lane(car.lane).edge == plan_->ways[car.way].last_edge) {
    car.lane = map::kNoLane;
    ++finished_;
  } else {
    car.s_m = length_m;
    car.speed_mps = 0.0;
  }
}

void Traffic::clear(map::LaneId lane, double from_m, double to_m) {
  std::erase_if(cars_, [&](const Car& car) {
    return (car.lane == lane || car.leaving == lane) && car.s_m + 0.5 * car.length_m > from_m &&
           car.s_m - 0.5 * car.length_m < to_m;
  });
}

std::vector<CarFlags> Traffic::flags() const {
  std::vector<CarFlags> all;
  all.reserve(cars_.size());
  for (const Car& car : cars_) {
    all.push_back({car.id, car.change_done < 1.0, car.speed_mps < 0.1});
  }
  return all;
}

std::vector<CarState> Traffic::cars() const {
  std::vector<CarState> states;
  states.reserve(cars_.size());
  for (const Car& car : cars_) {
    const map::PolylinePose pose = lane(car.lane).centre.at(car.s_m);
    const double p = car.change_done;
    const double sideways = -car.change_from_m * 30.0 * p * p * (1.0 - p) * (1.0 - p);
    const double change_way_m = std::max(kChange_s * car.speed_mps, kChange_m);
    const double offset_m = car.offset_m();
    CarState state;
    state.id = car.id;
    state.centre = {pose.point.x - offset_m * std::sin(pose.heading_rad),
                    pose.point.y + offset_m * std::cos(pose.heading_rad)};
    state.heading_rad = map::wrap_angle(pose.heading_rad + std::atan2(sideways, change_way_m));
    state.speed_mps = car.speed_mps;
    state.acceleration_mps2 = car.speed_mps > 0.0 ? car.acceleration_mps2 : 0.0;
    state.yaw_rate_radps = car.speed_mps * pose.curvature_1pm;
    state.length_m = car.length_m;
    state.width_m = car.width_m;
    state.lane = car.lane;
    states.push_back(state);
  }
  return states;
}

}  // namespace s4tp::traffic
