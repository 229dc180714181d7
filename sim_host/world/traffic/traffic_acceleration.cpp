/// How the built-in traffic's drivers accelerate: the least of what each thing ahead asks for.

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::traffic {
namespace {

// Of sigma times acceleration: costs 2 to 3 % of speed, as SUMO's does.
constexpr double kDistractionShare = 0.4;
constexpr double kFree = std::numeric_limits<double>::infinity();  // nothing is asked for

}  // namespace

double Traffic::wanted_speed_mps(const Car& car, const std::vector<WayPart>& way) const {
  double wanted = car.driver.max_speed_mps;
  for (const WayPart& part : way) {
    const double allowed = lane(part.lane).speed_limit_mps * car.driver.speed_factor;
    wanted = std::min(
        wanted, std::sqrt(allowed * allowed + 2.0 * kComfortableBraking_mps2 * std::max(0.0, part.start_m)));
  }
  return wanted;
}

double Traffic::follow(Car& car, const Actor& self, const TrafficView& view, const Leader& leader,
                       double wanted_mps) {
  const double free = free_acceleration_mps2(car.driver, car.speed_mps, wanted_mps);
  if (leader.actor == nullptr) {
    car.known_leader = car.surprise = kNoCar;
    car.known_gap_m = std::numeric_limits<double>::infinity();
    return free;
  }
  const int id = leader.actor->id;
  const bool cut_in =
      id != car.known_leader && car.known_leader != Car::kLooking && leader.gap_m < car.known_gap_m - 2.0;
  if (cut_in) {
    if (car.surprise != id) {
      car.surprise = id;
      car.surprise_since_s = time_s();
    }
    if (time_s() - car.surprise_since_s < car.driver.reaction_s) {  // until then it follows who was there
      const Leader known = view.leader(self.way, car.id, car.length_m, id);
      return known.actor == nullptr ? free
                                    : following_acceleration_mps2(car.driver, car.speed_mps, wanted_mps,
                                                                  known.gap_m, known.actor->speed_mps);
    }
  }
  car.known_leader = id;
  car.known_gap_m = leader.gap_m;
  car.surprise = kNoCar;
  return following_acceleration_mps2(car.driver, car.speed_mps, wanted_mps, leader.gap_m,
                                     leader.actor->speed_mps);
}

double Traffic::for_lane_end(const Car& car, const Actor& self, double wanted_mps) const {
  const WayPart& last = self.way.back();
  const bool leads_on = lane(last.lane).edge == plan_->ways[car.way].last_edge ||
                        self.guide->advice(last.lane).next != map::kNoLane;
  if (leads_on) {
    return kFree;
  }
  const double to_end_m = last.start_m + lane(last.lane).centre.length_m() - 0.5 * car.length_m - 1.0;
  return stopping_acceleration_mps2(car.driver, car.speed_mps, wanted_mps, to_end_m);
}

double Traffic::for_junction(Car& car, const JunctionChoice& choice, double wanted_mps) const {
  car.lets_go = choice.lets_go;
  car.queues = choice.queues;
  car.waits_for = choice.waits_for;
  car.committed = car.committed || choice.goes_first;
  car.gave_way_s += choice.lets_go != kNoCar ? kDecision_s : 0.0;
  if (!choice.near) {
    car.waited_s = 0.0;
  } else if (choice.line_m < kNear_m && car.speed_mps < 1.0) {
    car.waited_s += kDecision_s;
  }
  if (lane(car.lane).in_junction) {
    car.committed = false;
    car.gave_way_s = 0.0;
  }
  if (!choice.near) {
    return kFree;
  }
  const double ordinary_stop_m = car.speed_mps * car.speed_mps / (2.0 * car.driver.deceleration_mps2) +
                                 car.speed_mps * kTick_s * kDecisionTicks;
  const bool can_stop =
      choice.line_m > -0.5 && (choice.line_m >= ordinary_stop_m * 0.5 || car.speed_mps < 2.0);
  if (choice.stop && can_stop) {
    return stopping_acceleration_mps2(car.driver, car.speed_mps, wanted_mps, choice.line_m);
  }
  car.committed = car.committed || choice.line_m < ordinary_stop_m + 0.5;
  return kFree;
}

double Traffic::for_hazard(Car& car, const JunctionChoice& choice, double wanted_mps) const {
  if (choice.hazard != car.hazard) {
    car.hazard_since_s = car.hazard == Car::kLooking ? time_s() - car.driver.reaction_s : time_s();
    car.hazard = choice.hazard;
  }
  if (car.hazard < 0 || time_s() - car.hazard_since_s < car.driver.reaction_s) {
    return kFree;
  }
  return stopping_acceleration_mps2(car.driver, car.speed_mps, wanted_mps, choice.hazard_m);
}

double Traffic::acceleration(Car& car, const Actor& self, const TrafficView& view) {
  const double wanted = wanted_speed_mps(car, self.way);
  const Leader leader = view.leader(self.way, car.id, car.length_m);
  double result = towards_merging(car, self, view, leader, wanted, follow(car, self, view, leader, wanted));
  for (const WayPart& part : self.also) {  // the lane being left counts until the car is out of it
    const Leader old = view.leader({part}, car.id, car.length_m);
    if (old.actor != nullptr) {
      result = std::min(result, following_acceleration_mps2(car.driver, car.speed_mps, wanted, old.gap_m,
                                                            old.actor->speed_mps));
    }
  }
  const JunctionChoice choice = choose_at_junction(
      view, {&self, &car.driver, wanted, car.waited_s, car.gave_way_s, car.lets_go, car.committed, leader});
  result = std::min({result, for_lane_end(car, self, wanted), for_junction(car, choice, wanted),
                     for_hazard(car, choice, wanted)});
  result -= kDistractionShare * car.driver.imperfection * car.driver.acceleration_mps2 *
            distraction(seed_, car.id, time_s());
  return std::clamp(result, -car.driver.emergency_mps2, car.driver.acceleration_mps2);
}

}  // namespace s4tp::traffic
