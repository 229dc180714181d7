#include "sim_host/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/version.hpp"
#include "sim_host/world/attribution.hpp"
#include "sim_host/world/box.hpp"
#include "sim_host/world/locator.hpp"
#include "sim_host/world/map_node.hpp"
#include "sim_host/world/traffic_engine.hpp"

namespace s4tp::world {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kClearHeadway_s = 1.5;
constexpr double kUndisturbed_s = 1.0;  // after entry: a touch within it is the draw's fault
constexpr int kRedrawsMax = 100;
constexpr int kDeadTicks = 200;
constexpr double kAfterTouch_s = 1.0;
constexpr int kMapFramesPerTick = 3;
constexpr int kMapFramesPerTickAtStart = 7;
constexpr std::uint32_t kMapUpdate_ms = 200;
constexpr std::uint32_t kPerceptionPhase_ms = 70;  // a list is complete before the next 100 ms boundary
constexpr std::uint32_t kSlow_ms = 1000;

/// MapOrigin reaches 838 km: of coordinates counted from further away (UTM's) it says the last 1000 km.
double on_the_wire(double coordinate_m) {
  return std::remainder(coordinate_m, 1e6);
}

Vec2 rounded(Vec2 point) {  // as MapOrigin can say it
  return {std::round(point.x * 10.0) / 10.0, std::round(point.y * 10.0) / 10.0};
}

}  // namespace

struct World::Impl {
  Impl(const Scenario& with_scenario, const WorldOptions& with_options);

  [[nodiscard]] std::unique_ptr<TrafficEngine> traffic_until(std::uint64_t seed, double traffic_time_s,
                                                             EgoDriver ego_driver) const;
  void free_start_zone(TrafficEngine& with_traffic) const;
  void run_pre_roll();
  [[nodiscard]] bool touched_at_entry(std::uint64_t seed) const;
  [[nodiscard]] CarState ego_on_lane(double time_s) const;
  [[nodiscard]] CarState ego_state() const;
  void move_ego();
  void watch();
  void watch_collisions();
  void note_collisions(std::vector<Collision>& list, Box (*box)(const CarState&));
  void judge();
  void end(Ending ending);
  [[nodiscard]] Snapshot snapshot() const;
  void publish(std::vector<wire::Frame>& frames);
  void publish_map(std::vector<wire::Frame>& frames);
  template <class Message>
  void append(const Message& message, wire::E2eSender& sender, std::vector<wire::Frame>& frames);

  const Scenario& scenario;
  const Network& network;
  const Mission& mission;
  WorldOptions options;
  LaneId start_lane;
  LaneId goal_lane;
  RouteGuide guide;
  Vec2 origin;
  Locator locator;
  std::unique_ptr<TrafficEngine> traffic;       ///< at entry or later
  std::vector<std::vector<CarState>> pre_roll;  ///< who is shown in each of its ticks
  VehicleNode vehicle;
  Perception perception;
  MapNode map_node;
  wire::MapSender map_sender;
  wire::E2eSender origin_sender;
  wire::E2eSender version_sender;
  wire::E2eSender tick_sender;
  bool map_shown = false;
  int entry_tick;
  int tick_number = 0;
  LanePlace place;
  CarState ego;
  std::vector<CarState> others;
  Recording recording;
};

World::Impl::Impl(const Scenario& with_scenario, const WorldOptions& with_options)
    : scenario(with_scenario),
      network(with_scenario.network),
      mission(with_scenario.mission),
      options(with_options),
      start_lane(mission.start_lane),
      goal_lane(mission.goal_lane),
      guide(network, mission.edges, goal_lane, mission.goal_s_m),
      origin(rounded(network.lanes[static_cast<std::size_t>(start_lane)].centre.at(mission.start_s_m).point)),
      locator(network, guide),
      vehicle(options.sensors, origin, next_seed(options.seed ^ 0x5E45)),
      perception(options.perception, origin, next_seed(options.seed ^ 0x9E8C)),
      map_node(network, guide, origin),
      entry_tick(static_cast<int>(std::lround(options.pre_roll_s / kTick_s))) {
  recording.scenario = scenario.name;
  recording.seed = options.seed;
  std::uint64_t seed = options.seed;
  while (recording.redrawn < kRedrawsMax && touched_at_entry(seed)) {
    seed = next_seed(seed);
    ++recording.redrawn;
  }
  traffic = traffic_until(seed, mission.entry_time_s - options.pre_roll_s,
                          options.ego_by_traffic ? EgoDriver::kEngine : EgoDriver::kUs);
  run_pre_roll();
}

std::unique_ptr<TrafficEngine> World::Impl::traffic_until(std::uint64_t seed, double traffic_time_s,
                                                          EgoDriver ego_driver) const {
  std::unique_ptr<TrafficEngine> fresh =
      make_engine(scenario, {options.engine, seed, options.seed, ego_driver});
  const long ticks = std::lround(traffic_time_s / kTick_s);
  for (long i = 0; i < ticks; ++i) {
    fresh->step(nullptr);
  }
  return fresh;
}

void World::Impl::free_start_zone(TrafficEngine& with_traffic) const {
  const double half_m = 0.5 * vehicle.vehicle().parameters().length_m;
  const double limit_mps = network.lanes[static_cast<std::size_t>(start_lane)].speed_limit_mps;
  with_traffic.clear(
      start_lane, mission.start_s_m - half_m - kClearHeadway_s * std::max(limit_mps, mission.start_speed_mps),
      mission.start_s_m + half_m + kClearHeadway_s * mission.start_speed_mps);
}

/// Nothing of it depends on the ego, so it is driven before it is shown: who is taken out of the start zone
/// at entry has never been there, or the ECU would still believe in him.
void World::Impl::run_pre_roll() {
  for (int tick = 1; tick <= entry_tick; ++tick) {
    if (mission.entry_time_s + (tick - entry_tick) * kTick_s > 0.5 * kTick_s) {
      traffic->step(nullptr);
    }
    pre_roll.push_back(traffic->cars());
  }
  const std::vector<CarState> before = traffic->cars();
  free_start_zone(*traffic);
  const std::vector<CarState> after = traffic->cars();
  const auto among = [](const std::vector<CarState>& cars, int id) {
    return std::any_of(cars.begin(), cars.end(), [&](const CarState& car) { return car.id == id; });
  };
  for (std::vector<CarState>& shown : pre_roll) {
    std::erase_if(shown, [&](const CarState& car) { return among(before, car.id) && !among(after, car.id); });
  }
}

bool World::Impl::touched_at_entry(std::uint64_t seed) const {
  const std::unique_ptr<TrafficEngine> trial = traffic_until(seed, mission.entry_time_s, EgoDriver::kUs);
  free_start_zone(*trial);
  const int ticks = static_cast<int>(std::lround(kUndisturbed_s / kTick_s));
  LaneId before = start_lane;
  for (int i = 0; i <= ticks; ++i) {
    const CarState self = ego_on_lane(i * kTick_s);
    if (i > 0) {
      const LanePlace at = locator.locate(self.centre, self.heading_rad, before);
      before = at.lane;
      const EgoSeen seen{self, locator.actor(self, at)};
      trial->step(&seen);
    }
    for (const CarState& car : trial->cars()) {
      if (overlap(box_of(self), box_of(car))) {
        return true;
      }
    }
  }
  return false;
}

/// The world's own control: along the start lane at entry speed, straight before its start.
CarState World::Impl::ego_on_lane(double time_s) const {
  const PolylinePose pose = network.lanes[static_cast<std::size_t>(start_lane)].centre.at(
      mission.start_s_m + mission.start_speed_mps * time_s);
  CarState state;
  state.centre = pose.point;
  state.heading_rad = pose.heading_rad;
  state.speed_mps = mission.start_speed_mps;
  state.length_m = vehicle.vehicle().parameters().length_m;
  state.width_m = vehicle.vehicle().parameters().width_m;
  state.lane = start_lane;
  return state;
}

CarState World::Impl::ego_state() const {
  const Vehicle& car = vehicle.vehicle();
  CarState state;
  state.centre = car.box_centre();
  state.heading_rad = car.heading_rad();
  state.speed_mps = car.speed_mps();
  state.acceleration_mps2 = car.acceleration_mps2();
  state.yaw_rate_radps = car.yaw_rate_radps();
  state.length_m = car.parameters().length_m;
  state.width_m = car.parameters().width_m;
  state.lane = place.inside ? place.lane : kNoLane;
  return state;
}

void World::Impl::move_ego() {
  const int since_entry = tick_number - entry_tick;
  if (since_entry <= 0) {
    const CarState state = ego_on_lane(since_entry * kTick_s);
    vehicle.vehicle().place(state.centre, state.heading_rad, state.speed_mps);
    vehicle.idle();
    place = {start_lane, mission.start_s_m + mission.start_speed_mps * since_entry * kTick_s, 0.0, true};
  } else if (options.ego_by_traffic) {
    ego = traffic->driven_ego().value();
    vehicle.vehicle().place(ego.centre, ego.heading_rad, ego.speed_mps);
    vehicle.idle();
    place = locator.locate(ego.centre, ego.heading_rad, place.lane);
    ego.lane = place.inside ? place.lane : kNoLane;
    return;
  } else {
    vehicle.drive();
    place = locator.locate(vehicle.vehicle().box_centre(), vehicle.vehicle().heading_rad(), place.lane);
  }
  ego = ego_state();
}

Snapshot World::Impl::snapshot() const {
  Snapshot result;
  result.time_s = (tick_number - entry_tick) * kTick_s;
  result.ego = ego;
  result.ego_steering_rad = vehicle.vehicle().steering_rad();
  result.ego_lane_offset_m = place.d_m;
  if (place.lane != kNoLane) {
    result.ego_lane_width_m = network.lanes[static_cast<std::size_t>(place.lane)].width_m;
  }
  result.others = others;
  return result;
}

void World::Impl::note_collisions(std::vector<Collision>& list, Box (*box)(const CarState&)) {
  for (const CarState& car : others) {
    const bool known =
        std::any_of(list.begin(), list.end(), [&](const Collision& c) { return c.other == car.id; });
    if (known || !overlap(box(ego), box(car))) {
      continue;
    }
    std::vector<Snapshot> history = recording.snapshots;
    if (history.empty() || history.back().time_s < (tick_number - entry_tick - 0.5) * kTick_s) {
      history.push_back(snapshot());
    }
    const Verdict verdict = attribute(network, history, car.id);
    list.push_back({history.back().time_s, car.id, verdict.fault, verdict.cause});
  }
}

void World::Impl::watch_collisions() {
  const bool touched = !recording.collisions.empty();
  note_collisions(recording.collisions_competition, competition_box_of);
  if (!touched) {
    note_collisions(recording.collisions, box_of);
  }
}

void World::Impl::end(Ending ending) {
  recording.ending = ending;
  const Vec2 goal = network.lanes[static_cast<std::size_t>(goal_lane)].centre.at(mission.goal_s_m).point;
  recording.goal = goal;
  recording.goal_distance_m = std::abs(goal.x - ego.centre.x) + std::abs(goal.y - ego.centre.y);
}

void World::Impl::judge() {
  const double time_s = (tick_number - entry_tick) * kTick_s;
  watch_collisions();
  if (!recording.collisions.empty()) {
    if (time_s >= recording.collisions.front().time_s + kAfterTouch_s ||
        !recording.collisions_competition.empty()) {
      end(Ending::kCollision);
    }
    return;
  }
  const bool on_last_edge = place.lane != kNoLane &&
                            network.lanes[static_cast<std::size_t>(place.lane)].edge == mission.edges.back();
  const PolylineProjection at_goal =
      network.lanes[static_cast<std::size_t>(goal_lane)].centre.project(ego.centre);
  if (on_last_edge && at_goal.s_m >= mission.goal_s_m) {
    const double half_lane_m = 0.5 * network.lanes[static_cast<std::size_t>(goal_lane)].width_m;
    end(std::abs(at_goal.d_m) <= half_lane_m ? Ending::kGoal : Ending::kTimeOut);
  } else if (locator.off_road(ego.centre)) {
    end(Ending::kOffRoad);
  } else if (!options.ego_by_traffic &&
             std::min(vehicle.silent_ticks(), tick_number - entry_tick) >= kDeadTicks) {
    end(Ending::kDeadEcu);
  } else if (time_s >= mission.time_limit_s) {
    end(Ending::kTimeOut);
  }
}

void World::Impl::watch() {
  others = tick_number <= entry_tick ? pre_roll[static_cast<std::size_t>(tick_number - 1)] : traffic->cars();
  if (tick_number >= entry_tick) {
    judge();
  }
  if (tick_number % 10 == 0 || recording.ending != Ending::kRunning) {
    recording.snapshots.push_back(snapshot());
  }
}

template <class Message>
void World::Impl::append(const Message& message, wire::E2eSender& sender, std::vector<wire::Frame>& frames) {
  wire::Frame frame;
  if (wire::encode(message, frame)) {
    sender.protect(frame);
    frames.push_back(frame);
  }
}

void World::Impl::publish_map(std::vector<wire::Frame>& frames) {
  const std::uint32_t now_ms = static_cast<std::uint32_t>(tick_number) * 10U;
  if (now_ms % kMapUpdate_ms == 10U) {
    map_sender.update(map_node.update(ego.centre));
  }
  const int allowed = map_shown ? kMapFramesPerTick : kMapFramesPerTickAtStart;
  for (int i = 0; i < allowed; ++i) {
    wire::Frame frame;
    if (!map_sender.next(now_ms, frame)) {
      map_shown = true;
      break;
    }
    frames.push_back(frame);
  }
}

void World::Impl::publish(std::vector<wire::Frame>& frames) {
  const std::uint32_t now_ms = static_cast<std::uint32_t>(tick_number) * 10U;
  vehicle.publish(now_ms, tick_number >= entry_tick, frames);
  if (now_ms % 100U == kPerceptionPhase_ms) {
    perception.observe(ego, others, now_ms);
  }
  perception.publish(now_ms, frames);
  publish_map(frames);
  if (now_ms % kSlow_ms == 10U) {
    wire::MapOrigin map_origin;
    map_origin.x_m = static_cast<float>(on_the_wire(origin.x));
    map_origin.y_m = static_cast<float>(on_the_wire(origin.y));
    append(map_origin, origin_sender, frames);
    wire::VersionWorld version;
    version.wire_version = wire::wire_version();
    version.layout_hash = wire::layout_hash();
    append(version, version_sender, frames);
  }
  wire::Tick tick;
  tick.tick = static_cast<std::uint16_t>(tick_number & 0xFFFF);
  append(tick, tick_sender, frames);
}

World::World(const Scenario& scenario, const WorldOptions& options)
    : impl_(std::make_unique<Impl>(scenario, options)) {}

World::~World() = default;

void World::tick(std::vector<wire::Frame>& frames) {
  Impl& w = *impl_;
  ++w.tick_number;
  const int since_entry = w.tick_number - w.entry_tick;
  if (since_entry > 0) {
    const EgoSeen self{w.ego, w.locator.actor(w.ego, w.place)};
    w.traffic->step(&self);
  }
  w.move_ego();
  w.watch();
  w.publish(frames);
}

void World::receive(const wire::Frame& frame) {
  impl_->vehicle.receive(frame);
}

bool World::finished() const {
  return impl_->recording.ending != Ending::kRunning;
}

double World::time_s() const {
  return (impl_->tick_number - impl_->entry_tick) * kTick_s;
}

Vec2 World::origin() const {
  return impl_->origin;
}

const Recording& World::recording() const {
  return impl_->recording;
}

}  // namespace s4tp::world
