#include "sim_host/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "sim_host/world/ego_road.hpp"
#include "sim_host/world/judge/attribution.hpp"
#include "sim_host/world/nodes/vehicle_node.hpp"
#include "sim_host/world/nodes/world_nodes.hpp"
#include "sim_host/world/scenario/cut.hpp"
#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"
#include "sim_host/world/world_entry.hpp"

namespace s4tp::world {
namespace {

constexpr int kDeadTicks = 200;
constexpr double kAfterTouch_s = 1.0;

/// A cut's world is the one that was recorded.
WorldOptions as_recorded(WorldOptions options, const scenario::Scenario& scenario) {
  if (!scenario.cut) return options;
  if (options.ego_by_traffic) throw std::invalid_argument("a cut needs an ECU; SUMO's driver is none");
  options.seed = scenario.cut->seed;
  options.engine = scenario::engine_of(scenario.cut->traffic);
  options.perception = scenario::perception_preset(scenario.cut->perception);
  return options;
}

map::Vec2 rounded(map::Vec2 point) {  // as MapOrigin can say it
  return {std::round(point.x * 10.0) / 10.0, std::round(point.y * 10.0) / 10.0};
}

}  // namespace

struct World::Impl {
  Impl(const scenario::Scenario& with_scenario, const WorldOptions& with_options);

  void move_ego();
  void watch();
  void watch_collisions();
  void note_collisions(std::vector<traffic::Collision>& list, traffic::Box (*box)(const traffic::CarState&));
  void judge();
  void end(traffic::Ending ending);
  [[nodiscard]] traffic::Snapshot snapshot() const;
  /// Whether the vehicle does in this tick what was recorded.
  [[nodiscard]] bool follows_recording() const {
    return scenario.cut && tick_number <= scenario.cut->start_tick;
  }

  const scenario::Scenario& scenario;
  const map::Network& network;
  const scenario::Mission& mission;
  WorldOptions options;
  map::LaneId start_lane;
  map::LaneId goal_lane;
  std::shared_ptr<const EgoRoad> road;
  const map::RouteGuide& guide;
  const traffic::Locator& locator;
  map::Vec2 origin;
  std::unique_ptr<traffic::TrafficEngine> traffic;       ///< at entry or later
  std::vector<std::vector<traffic::CarState>> pre_roll;  ///< who is shown in each of its ticks
  nodes::VehicleNode vehicle;
  nodes::WorldNodes nodes;
  int entry_tick;
  int tick_number = 0;
  traffic::LanePlace place;
  bool was_on_last_edge = false;  ///< a tick before
  traffic::CarState ego;
  std::vector<traffic::CarState> others;
  traffic::Recording recording;
};

World::Impl::Impl(const scenario::Scenario& with_scenario, const WorldOptions& with_options)
    : scenario(with_scenario),
      network(with_scenario.network),
      mission(with_scenario.mission),
      options(as_recorded(with_options, with_scenario)),
      start_lane(mission.start_lane),
      goal_lane(mission.goal_lane),
      road(std::make_shared<const EgoRoad>(with_scenario)),
      guide(road->guide),
      locator(road->locator),
      origin(rounded(network.lanes[static_cast<std::size_t>(start_lane)].centre.at(mission.start_s_m).point)),
      vehicle(options.sensors, origin, traffic::next_seed(options.seed ^ 0x5E45)),
      nodes(network, guide, origin, options.perception, traffic::next_seed(options.seed ^ 0x9E8C)),
      entry_tick(static_cast<int>(std::lround(options.pre_roll_s / traffic::kTick_s))) {
  recording.scenario = scenario.name;
  recording.seed = with_options.seed;
  EnteredTraffic entered = draw_entry(scenario, options, locator);
  recording.redrawn = entered.redrawn;
  traffic = std::move(entered.traffic);
  pre_roll = std::move(entered.pre_roll);
}

void World::Impl::move_ego() {
  const int since_entry = tick_number - entry_tick;
  if (since_entry <= 0) {
    const traffic::CarState state = ego_at_entry(scenario, since_entry * traffic::kTick_s);
    vehicle.vehicle().place(state.centre, state.heading_rad, state.speed_mps, state.yaw_rate_radps);
    vehicle.idle();
    place = {start_lane, mission.start_s_m + mission.start_speed_mps * since_entry * traffic::kTick_s, 0.0,
             true};
  } else if (options.ego_by_traffic) {
    ego = traffic->driven_ego().value();
    vehicle.vehicle().place(ego.centre, ego.heading_rad, ego.speed_mps);
    vehicle.idle();
    place = locator.locate(ego.centre, ego.heading_rad, place.lane);
    ego.lane = place.inside ? place.lane : map::kNoLane;
    return;
  } else {
    vehicle.drive();
    place = locator.locate(vehicle.vehicle().box_centre(), vehicle.vehicle().heading_rad(), place.lane);
  }
  ego = ego_state(vehicle.vehicle(), place);
}

traffic::Snapshot World::Impl::snapshot() const {
  traffic::Snapshot result;
  result.time_s = (tick_number - entry_tick) * traffic::kTick_s;
  result.ego = ego;
  result.ego_steering_rad = vehicle.vehicle().steering_rad();
  result.ego_lane_offset_m = place.d_m;
  if (place.lane != map::kNoLane) {
    result.ego_lane_width_m = network.lanes[static_cast<std::size_t>(place.lane)].width_m;
  }
  result.others = others;
  return result;
}

void World::Impl::note_collisions(std::vector<traffic::Collision>& list,
                                  traffic::Box (*box)(const traffic::CarState&)) {
  for (const traffic::CarState& car : others) {
    const bool known =
        std::any_of(list.begin(), list.end(), [&](const traffic::Collision& c) { return c.other == car.id; });
    if (known || !traffic::overlap(box(ego), box(car))) {
      continue;
    }
    std::vector<traffic::Snapshot> history = recording.snapshots;
    if (history.empty() || history.back().time_s < (tick_number - entry_tick - 0.5) * traffic::kTick_s) {
      history.push_back(snapshot());
    }
    const judge::Verdict verdict = judge::attribute(network, guide, history, car.id);
    list.push_back({history.back().time_s, car.id, verdict.fault, verdict.cause});
  }
}

void World::Impl::watch_collisions() {
  const bool touched = !recording.collisions.empty();
  note_collisions(recording.collisions_competition, traffic::competition_box_of);
  if (!touched) {
    note_collisions(recording.collisions, traffic::box_of);
  }
}

void World::Impl::end(traffic::Ending ending) {
  recording.ending = ending;
  const map::Vec2 goal = network.lanes[static_cast<std::size_t>(goal_lane)].centre.at(mission.goal_s_m).point;
  recording.goal = goal;
  recording.goal_distance_m = std::abs(goal.x - ego.centre.x) + std::abs(goal.y - ego.centre.y);
}

void World::Impl::judge() {
  const double time_s = (tick_number - entry_tick) * traffic::kTick_s;
  watch_collisions();
  if (!recording.collisions.empty()) {
    if (time_s >= recording.collisions.front().time_s + kAfterTouch_s ||
        !recording.collisions_competition.empty()) {
      end(traffic::Ending::kCollision);
    }
    return;
  }
  const bool on_last_edge = place.lane != map::kNoLane &&
                            network.lanes[static_cast<std::size_t>(place.lane)].edge == mission.edges.back();
  const map::PolylineProjection at_goal =
      network.lanes[static_cast<std::size_t>(goal_lane)].centre.project(ego.centre);
  // Whoever passes the end of a lane that leads on is on the next lane by then.
  const bool comes_from_last_edge = on_last_edge || was_on_last_edge;
  was_on_last_edge = on_last_edge;
  if (comes_from_last_edge && at_goal.s_m >= mission.goal_s_m) {
    const double half_lane_m = 0.5 * network.lanes[static_cast<std::size_t>(goal_lane)].width_m;
    end(std::abs(at_goal.d_m) <= half_lane_m ? traffic::Ending::kGoal : traffic::Ending::kTimeOut);
  } else if (locator.off_road(ego.centre)) {
    end(traffic::Ending::kOffRoad);
  } else if (!options.ego_by_traffic &&
             std::min(vehicle.silent_ticks(), tick_number - entry_tick) >= kDeadTicks) {
    end(traffic::Ending::kDeadEcu);
  } else if (time_s >= mission.time_limit_s) {
    end(traffic::Ending::kTimeOut);
  }
}

void World::Impl::watch() {
  others = tick_number <= entry_tick ? pre_roll[static_cast<std::size_t>(tick_number - 1)] : traffic->cars();
  if (tick_number >= entry_tick) {
    judge();
  }
  if (tick_number % 10 == 0 || recording.ending != traffic::Ending::kRunning) {
    recording.snapshots.push_back(snapshot());
  }
}

World::World(const scenario::Scenario& scenario, const WorldOptions& options)
    : impl_(std::make_unique<Impl>(scenario, options)) {}

World::~World() = default;

void World::tick(std::vector<wire::Frame>& frames) {
  Impl& w = *impl_;
  ++w.tick_number;
  const int since_entry = w.tick_number - w.entry_tick;
  if (since_entry > 0) {
    const traffic::EgoSeen self{w.ego, w.locator.actor(w.ego, w.place)};
    w.traffic->step(&self);
  }
  w.move_ego();
  w.watch();
  const std::uint32_t now_ms = static_cast<std::uint32_t>(w.tick_number) * 10U;
  w.vehicle.publish(now_ms, w.tick_number >= w.entry_tick, frames);
  w.nodes.publish(now_ms, w.ego, w.others, frames);
  if (!w.follows_recording()) return;
  for (const wire::Frame& frame : w.scenario.cut->commands[static_cast<std::size_t>(w.tick_number - 1)]) {
    w.vehicle.receive(frame);
  }
}

void World::receive(const wire::Frame& frame) {
  if (!impl_->follows_recording()) impl_->vehicle.receive(frame);
}

bool World::finished() const {
  return impl_->recording.ending != traffic::Ending::kRunning;
}

double World::time_s() const {
  return (impl_->tick_number - impl_->entry_tick) * traffic::kTick_s;
}

map::Vec2 World::origin() const {
  return impl_->origin;
}

std::unique_ptr<Branch> World::fork(EgoDriver& driver) const {
  if (impl_->tick_number < impl_->entry_tick) throw std::logic_error("fork: the ECU has not taken over yet");
  std::unique_ptr<traffic::TrafficEngine> traffic = impl_->traffic->clone();
  if (!traffic) throw std::logic_error("fork: this traffic cannot be copied");
  return std::make_unique<Branch>(
      Branch::Start{impl_->road, std::move(traffic), impl_->vehicle.vehicle(), impl_->place, time_s()},
      driver);
}

const traffic::Recording& World::recording() const {
  return impl_->recording;
}

}  // namespace s4tp::world
