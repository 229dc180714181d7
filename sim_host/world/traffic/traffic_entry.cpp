/// How the built-in traffic comes into the network: at its time, when there is room, surprising nobody.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sim_host/world/traffic/traffic.hpp"

namespace s4tp::traffic {
namespace {

constexpr double kMinimumBehind_m = 2.5;  // to somebody before whom a car appears

}  // namespace

/// Whether a car that appeared amid its lane would be too close before somebody.
bool Traffic::somebody_comes(const TrafficView& view, const Car& car) const {
  const Leader behind = view.follower(car.lane, car.s_m, -1, car.length_m);
  return behind.actor != nullptr && behind.gap_m < kMinimumBehind_m + behind.actor->speed_mps *
                                                                          behind.actor->speed_mps /
                                                                          (2.0 * kComfortableBraking_mps2);
}

/// The speed at which a car comes in, or nothing: there is no room for it now.
std::optional<double> Traffic::entry_speed_mps(const TrafficView& view, const Car& car,
                                               const Departure& departure) const {
  if (departure.s_m >= 0.0 && somebody_comes(view, car)) {
    return std::nullopt;
  }
  const std::vector<WayPart> way = view.way_from(car.lane, car.s_m, &plan_->ways[car.way].guide);
  if (surprises_at_junction(view, way)) {
    return std::nullopt;
  }
  double wanted = wanted_speed_mps(car, way);
  const auto junction =
      std::find_if(way.begin(), way.end(), [&](const WayPart& part) { return lane(part.lane).in_junction; });
  if (junction != way.end()) {  // slow enough to stop at its line
    wanted = std::min(wanted, std::sqrt(2.0 * 2.5 * std::max(0.1, junction->start_m - 0.5 * car.length_m)));
  }
  const double speed_mps = std::min(wanted, departure.speed_mps);
  const Leader leader = view.leader(way, -1, car.length_m);
  if (leader.actor == nullptr) {
    return speed_mps;
  }
  const double behind_mps =
      leader.gap_m < 40.0 ? std::min(speed_mps, std::max(leader.actor->speed_mps, 1.0)) : speed_mps;
  const bool room = leader.gap_m >= car.driver.min_gap_m + 0.5 * car.driver.headway_s * behind_mps &&
                    following_acceleration_mps2(car.driver, behind_mps, wanted, leader.gap_m,
                                                leader.actor->speed_mps) >= -kComfortableBraking_mps2;
  return room ? std::optional(behind_mps) : std::nullopt;
}

void Traffic::insert_waiting(const Actor* ego) {
  while (next_departure_ < plan_->departures.size() &&
         plan_->departures[next_departure_].time_s <= time_s()) {
    const Departure& departure = plan_->departures[next_departure_];
    waiting_[static_cast<std::size_t>(departure.lane)].push_back(next_departure_++);
  }
  if (std::all_of(waiting_.begin(), waiting_.end(), [](const auto& lane) { return lane.empty(); })) {
    return;
  }
  const TrafficView view(*road_, actors(ego));  // whoever is committed must not be surprised
  for (std::size_t id = 0; id < waiting_.size(); ++id) {
    if (waiting_[id].empty()) {
      continue;
    }
    const std::size_t index = waiting_[id].front();
    const Departure& departure = plan_->departures[index];
    Car car;
    car.id = static_cast<int>(index) + 1;
    car.way = departure.way;
    car.driver = departure.driver;
    car.lane = static_cast<map::LaneId>(id);
    car.length_m = departure.length_m;
    car.width_m = departure.width_m;
    car.s_m = departure.s_m < 0.0 ? 0.5 * car.length_m + 0.1 : departure.s_m;
    const std::optional<double> speed_mps = entry_speed_mps(view, car, departure);
    if (!speed_mps) {
      continue;
    }
    car.speed_mps = *speed_mps;
    if (!may_come_in(car)) {
      continue;
    }
    car.known_leader = car.hazard = Car::kLooking;  // nothing there at the start is a surprise
    car.next_change_s = time_s() + 1.0;
    const auto place =
        std::find_if(cars_.begin(), cars_.end(), [&](const Car& other) { return other.id > car.id; });
    cars_.insert(place, std::move(car));
    waiting_[id].pop_front();
  }
}

}  // namespace s4tp::traffic
