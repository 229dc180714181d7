#pragma once
/// The other end of the bus: vehicle, perception, map node and traffic, known to the ECU by frames only.

#include <cstdint>
#include <memory>
#include <vector>

#include "firmware/wire/frame.hpp"
#include "sim_host/world/branch.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/nodes/vehicle_node.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::world {

struct WorldOptions {
  std::uint64_t seed = 0;
  scenario::Engine engine = scenario::Engine::kBuiltin;
  /// WORLD-041 SUMO's own driver drives the ego from entry on; nobody waits for an ECU. SUMO only.
  bool ego_by_traffic = false;
  bool ego_on_any_lane = false;  ///< traffic::EngineOptions
  double pre_roll_s = 3.0;
  nodes::SensorOptions sensors = {};
  scenario::PerceptionOptions perception = {};
};

/// One episode. In the pre-roll every node publishes while the world itself moves the ego along its lane,
/// extended straight backwards, at entry speed; from time 0 on the ECU drives. WORLD-032 At entry nobody is
/// left within 1.5 s headway of the ego on its lane, and whoever is taken away for it is not shown in the
/// pre-roll either; a draw in which the ego would be touched within the first second without doing anything
/// is replaced by the next seed's, and counted.
///
/// Endings: WORLD-033 goal, the centre passes the goal on the goal's lane; WORLD-034 collision, own-size
/// boxes touch (the world goes on for 1 s to see whether the competition's smaller ones do as well);
/// WORLD-035 off the road; WORLD-036 time-out, the route's end passed on another lane included; WORLD-037
/// dead ECU, 200 ticks without a command frame.
class World {
 public:
  /// \param scenario  must outlive the world
  World(const scenario::Scenario& scenario, const WorldOptions& options);
  ~World();

  /// Advances 10 ms and appends this tick's frames: motion, steering, pose, track list, map, versions, and
  /// the TICK frame last. WORLD-030 The map takes 3 frames a tick, 7 until it has been shown whole.
  void tick(std::vector<wire::Frame>& frames);
  /// A frame from the ECU: taken only if its protection is right; it acts from the next tick on.
  void receive(const wire::Frame& frame);

  [[nodiscard]] bool finished() const;
  [[nodiscard]] double time_s() const;     ///< since the ECU took over
  [[nodiscard]] map::Vec2 origin() const;  ///< of the odometry frame, network coordinates
  [[nodiscard]] const traffic::Recording& recording() const;

  /// WORLD-050 A branch that begins as the world is now: the same commands make of it what they make of the
  /// world, to the bit. The world itself does not notice.
  /// \param driver  must outlive the branch; so must the scenario, but not the world
  /// \throws std::logic_error before the ECU has taken over, or where the traffic cannot be copied (SUMO)
  [[nodiscard]] std::unique_ptr<Branch> fork(EgoDriver& driver) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace s4tp::world
