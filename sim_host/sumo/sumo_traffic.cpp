#include "sim_host/sumo/sumo_traffic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sim_host/sumo/sumo_routes.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::sumo {
namespace {

using traci::Domain;
using traci::Writer;
using traffic::CarState;
using traffic::DrivenBy;

constexpr double kStep_s = 0.1;
constexpr int kTicksPerStep = 10;
constexpr double kBesideCentre_m = 0.2;  // further out a car is changing lanes
constexpr double kStands_mps = 0.1;
constexpr double kLengthKept_m = 0.05;  // as told, while it is no further off
constexpr int kRouteOrNone = 3;         // moveToXY's keepRoute: a lane of its route, or else off the road
constexpr int kAnyOrNone = 2;
constexpr int kStrategicChanges = 1;  // lane change mode: those its route needs, and no others
constexpr int kVaporized = 3;         // SUMO's reason for a removal that is no arrival

const std::vector<int> kObserved{traci::kPosition,     traci::kAngle,  traci::kSpeed,
                                 traci::kAcceleration, traci::kLaneId, traci::kLateralPosition,
                                 traci::kLength,       traci::kWidth};

double compass_deg(double heading_rad) {
  return 90.0 - heading_rad * 180.0 / std::numbers::pi;
}

/// Where a car will be when it keeps acceleration and yaw rate.
CarState after(const CarState& car, double time_s) {
  const double until_stop_s =
      car.acceleration_mps2 < 0.0 ? std::min(time_s, -car.speed_mps / car.acceleration_mps2) : time_s;
  const double way_m = (car.speed_mps + 0.5 * car.acceleration_mps2 * until_stop_s) * until_stop_s;
  CarState later = car;
  later.heading_rad = car.heading_rad + 0.5 * car.yaw_rate_radps * until_stop_s;
  later.centre = ahead_of(later, way_m);
  later.heading_rad = map::wrap_angle(car.heading_rad + car.yaw_rate_radps * until_stop_s);
  later.speed_mps = std::max(0.0, car.speed_mps + car.acceleration_mps2 * until_stop_s);
  return later;
}

/// Of a car that has left the network: the step ends as it began.
CarState rolled_on(const CarState& car) {
  CarState straight = car;
  straight.acceleration_mps2 = straight.yaw_rate_radps = 0.0;
  return after(straight, kStep_s);
}

const std::vector<std::string>& ids(const traci::Variables& variables, int variable) {
  return std::get<std::vector<std::string>>(variables.at(variable));
}

}  // namespace

Traffic::Traffic(const scenario::Scenario& scenario, const traffic::EngineOptions& options,
                 const EgoCoupling& coupling)
    : scenario_(scenario),
      options_(options),
      coupling_(coupling),
      ego_reach_(scenario.network),
      sumo_(start_sumo(scenario, options, coupling.driver)) {
  for (std::size_t i = 0; i < scenario.network.lanes.size(); ++i) {
    lane_of_[scenario.network.lanes[i].name] = static_cast<map::LaneId>(i);
  }
  const std::int64_t entry = std::llround(scenario.mission.entry_time_s / traffic::kTick_s);
  if (options.ego == DrivenBy::kEngine && (entry <= 0 || entry % kTicksPerStep != 0)) {
    throw std::runtime_error("SUMO's driver enters at a multiple of 0.1 s, at least 0.1 s; entry_time_s is " +
                             std::to_string(scenario.mission.entry_time_s));
  }
  try {
    sumo_.client->subscribe(Domain::kSimulation, "", {traci::kDeparted, traci::kArrived});
  } catch (const traci::Error& error) {  // it listens before it loads
    fail(error);
  }
}

Traffic::~Traffic() {
  sumo_.client->close();
  sumo_.process->wait_for_end();
}

void Traffic::fail(const traci::Error& error) {
  sumo_.process->wait_for_end();
  const std::string what = "SUMO's traffic at " + std::to_string(time_s()) + " s: " + error.what();
  const std::string words = "; SUMO's last words: " + sumo_.process->last_words();
  if (sumo_.process->lives()) throw std::runtime_error(what + words);
  throw traffic::EngineEnded(what + "; it has ended" + words);
}

void Traffic::step(const traffic::EgoSeen* ego) {
  if (ticks_ % kTicksPerStep == 0) {
    try {
      sumo_step(ego);
    } catch (const traci::Error& error) {
      fail(error);
    }
  }
  ++ticks_;
}

void Traffic::add_ego() {
  const map::Lane& goal_lane = scenario_.network.lanes[static_cast<std::size_t>(scenario_.mission.goal_lane)];
  Writer value;  // route, type, depart, lane, position, speed; arrival lane, position, speed; the rest unused
  value.compound(14).typed_text(kEgoName).typed_text(kEgoName).typed_text("now");
  value.typed_text("first").typed_text("base").typed_text("0");
  value.typed_text(coupling_.wishes || options_.ego == DrivenBy::kEngine ? std::to_string(goal_lane.index)
                                                                         : "current");
  value.typed_text("max").typed_text("current");
  value.typed_text("").typed_text("").typed_text("").typed_integer(0).typed_integer(0);
  sumo_.client->set(Domain::kVehicle, traci::kAddFull, kEgoName, value);
  if (options_.ego != DrivenBy::kEngine) {
    sumo_.client->set(Domain::kVehicle, traci::kSpeedMode, kEgoName,
                      Writer().typed_integer(coupling_.speed_mode));
    sumo_.client->set(Domain::kVehicle, traci::kLaneChangeMode, kEgoName,
                      Writer().typed_integer(coupling_.wishes ? kStrategicChanges : 0));
  }
  ego_there_ = true;
}

/// The ego stands at the mission's start when the step that ends at entry is over, so that everybody sees it
/// from entry on, and nobody before.
void Traffic::enter_ego() {
  const scenario::Mission& mission = scenario_.mission;
  const std::int64_t entry = std::llround(mission.entry_time_s / traffic::kTick_s);
  if (ticks_ + kTicksPerStep == entry) {
    const map::PolylinePose pose =
        scenario_.network.lanes[static_cast<std::size_t>(mission.start_lane)].centre.at(mission.start_s_m);
    CarState start;
    start.centre = pose.point;
    start.heading_rad = pose.heading_rad;
    add_ego();
    put_ego(start);
  } else if (ticks_ == entry && ego_there_) {
    sumo_.client->set(Domain::kVehicle, traci::kPreviousSpeed, kEgoName,
                      Writer().typed_real(mission.start_speed_mps));
    cars_.at(kEgoName).before.speed_mps = mission.start_speed_mps;
  }
}

/// In a junction many ways overlap, and moveToXY takes the nearest: others then take a car that turns for one
/// on another way, and give way to it, or not, as to that one. So it is looked for on its route first.
void Traffic::put_ego(const CarState& place) {
  const auto known = cars_.find(kEgoName);
  const bool lost = known != cars_.end() && known->second.lanes.empty();
  const double length_m = coupling_.along_lanes ? ego_reach_.length_m(place) : ego_length_m_;
  if (std::abs(length_m - ego_length_m_) > kLengthKept_m) {
    ego_length_m_ = length_m;
    sumo_.client->set(Domain::kVehicle, traci::kLength, kEgoName, Writer().typed_real(length_m));
  }
  const map::Vec2 bumper = ahead_of(place, 0.5 * place.length_m);
  Writer value;
  value.compound(6).typed_text("").typed_integer(-1).typed_real(bumper.x).typed_real(bumper.y);
  value.typed_real(compass_deg(place.heading_rad))
      .typed_byte(coupling_.on_route && !lost ? kRouteOrNone : kAnyOrNone);
  sumo_.client->set(Domain::kVehicle, traci::kMoveToXy, kEgoName, value);
}

void Traffic::sumo_step(const traffic::EgoSeen* ego) {
  for (auto entry = cars_.begin(); entry != cars_.end();) {
    Car& car = entry->second;
    car.before = car.after;
    car.known_before = true;
    if (!car.arrived) {
      ++entry;
    } else if (entry->first == kEgoName && options_.ego == DrivenBy::kEngine) {
      car.after = rolled_on(car.before);
      ++entry;
    } else {
      entry = cars_.erase(entry);
    }
  }
  if (options_.ego == DrivenBy::kEngine || (options_.ego == DrivenBy::kUs && coupling_.early)) {
    enter_ego();
  }
  if (options_.ego == DrivenBy::kUs && ego != nullptr) {
    if (!ego_there_) {
      add_ego();
    }
    put_ego(coupling_.ahead ? after(ego->car, kStep_s) : ego->car);
  }
  std::map<Domain, traci::Observations> seen = sumo_.client->step();
  const traci::Variables& events = seen[Domain::kSimulation][""];
  for (const std::string& name : ids(events, traci::kDeparted)) {
    Car car;
    car.after.id = name == kEgoName ? 0 : next_id_++;
    observe(car, sumo_.client->subscribe(Domain::kVehicle, name, kObserved));
    cars_[name] = car;
  }
  for (const auto& [name, variables] : seen[Domain::kVehicle]) {
    if (const auto known = cars_.find(name); known != cars_.end()) {
      observe(known->second, variables);
    }
  }
  for (const std::string& name : ids(events, traci::kArrived)) {
    if (const auto known = cars_.find(name); known != cars_.end()) {
      known->second.arrived = true;
      known->second.after = rolled_on(known->second.before);
      finished_ += name == kEgoName ? 0 : 1;
    }
    ego_there_ = ego_there_ && name != kEgoName;
  }
}

void Traffic::observe(Car& car, const traci::Variables& variables) {
  const auto real = [&](int variable) { return std::get<double>(variables.at(variable)); };
  CarState& state = car.after;
  state.length_m =
      state.id == 0 && options_.ego == DrivenBy::kUs ? CarState{}.length_m : real(traci::kLength);
  state.width_m = real(traci::kWidth);
  state.speed_mps = real(traci::kSpeed);
  state.acceleration_mps2 = real(traci::kAcceleration);
  state.heading_rad = map::wrap_angle((90.0 - real(traci::kAngle)) * std::numbers::pi / 180.0);
  state.centre = std::get<map::Vec2>(variables.at(traci::kPosition));
  state.centre = ahead_of(state, -0.5 * state.length_m);
  state.yaw_rate_radps =
      car.known_before ? map::wrap_angle(state.heading_rad - car.before.heading_rad) / kStep_s : 0.0;
  follow_lanes(car, std::get<std::string>(variables.at(traci::kLaneId)));
  if (state.id == 0) ego_reach_.follow(car.lanes.empty() ? map::kNoLane : car.lanes.back());
  car.changing_lane = std::abs(real(traci::kLateralPosition)) > kBesideCentre_m;
}

/// SUMO says where the front bumper is; a car's lane is that of its box centre, here as everywhere.
void Traffic::follow_lanes(Car& car, const std::string& bumper_lane) const {
  const auto known = lane_of_.find(bumper_lane);
  if (known == lane_of_.end()) {
    car.lanes.clear();
    car.after.lane = map::kNoLane;
    return;
  }
  if (car.lanes.empty() || car.lanes.back() != known->second) {
    car.lanes.push_back(known->second);
  }
  const auto begun = [&](map::LaneId lane) {
    return scenario_.network.lanes[static_cast<std::size_t>(lane)].centre.project(car.after.centre).s_m >=
           0.0;
  };
  const auto centre = std::find_if(car.lanes.rbegin(), std::prev(car.lanes.rend()), begun);
  car.lanes.erase(car.lanes.begin(), std::prev(centre.base()));
  car.after.lane = car.lanes.front();
}

CarState Traffic::between(const Car& car) const {
  const double part = static_cast<double>((ticks_ + kTicksPerStep - 1) % kTicksPerStep + 1) / kTicksPerStep;
  CarState state = part < 0.5 ? car.before : car.after;
  const auto mix = [part](double from, double to) { return from + part * (to - from); };
  state.centre = {mix(car.before.centre.x, car.after.centre.x), mix(car.before.centre.y, car.after.centre.y)};
  state.heading_rad = map::wrap_angle(car.before.heading_rad +
                                      part * map::wrap_angle(car.after.heading_rad - car.before.heading_rad));
  state.speed_mps = mix(car.before.speed_mps, car.after.speed_mps);
  state.acceleration_mps2 = car.after.acceleration_mps2;
  state.yaw_rate_radps = car.after.yaw_rate_radps;
  return state;
}

std::vector<CarState> Traffic::cars() const {
  std::vector<CarState> states;
  for (const auto& [name, car] : cars_) {
    if (name == kEgoName) {
      continue;
    }
    if (car.known_before) {
      states.push_back(between(car));
    } else if (ticks_ % kTicksPerStep == 0) {  // entered at the end of the step
      states.push_back(car.after);
    }
  }
  std::sort(states.begin(), states.end(), [](const CarState& a, const CarState& b) { return a.id < b.id; });
  return states;
}

std::vector<traffic::CarFlags> Traffic::flags() const {
  std::vector<traffic::CarFlags> all;
  for (const auto& [name, car] : cars_) {
    if (name != kEgoName) {
      all.push_back({car.after.id, car.changing_lane, car.after.speed_mps < kStands_mps});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const traffic::CarFlags& a, const traffic::CarFlags& b) { return a.id < b.id; });
  return all;
}

std::optional<CarState> Traffic::ego_seen() const {
  const auto ego = cars_.find(kEgoName);
  return ego == cars_.end() || !ego->second.known_before ? std::nullopt : std::optional(between(ego->second));
}

std::optional<CarState> Traffic::driven_ego() const {
  return options_.ego == DrivenBy::kEngine ? ego_seen() : std::nullopt;
}

void Traffic::clear(map::LaneId lane, double from_m, double to_m) {
  const map::Lane& cleared = scenario_.network.lanes[static_cast<std::size_t>(lane)];
  std::erase_if(cars_, [&](const auto& entry) {
    const auto& [name, car] = entry;
    const CarState now = car.known_before ? between(car) : car.after;
    if (name == kEgoName || car.arrived || now.lane == map::kNoLane ||
        scenario_.network.lanes[static_cast<std::size_t>(now.lane)].edge != cleared.edge) {
      return false;
    }
    const map::PolylineProjection at = cleared.centre.project(now.centre);
    const bool inside = std::abs(at.d_m) < 0.5 * (cleared.width_m + now.width_m) &&
                        at.s_m + 0.5 * now.length_m > from_m && at.s_m - 0.5 * now.length_m < to_m;
    if (inside) {
      try {
        sumo_.client->unsubscribe(Domain::kVehicle, name);
        sumo_.client->set(Domain::kVehicle, traci::kRemove, name, Writer().typed_byte(kVaporized));
      } catch (const traci::Error& error) {
        fail(error);
      }
    }
    return inside;
  });
}

}  // namespace s4tp::sumo
