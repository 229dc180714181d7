#pragma once
/// A branch of a world: from one recorded state it runs on with the ego driven another way, all else equal,
/// the drivers' hidden character and noise included (method.md 2: a plan is an intervention).
///
/// \code
///                       .---- branch, ego goes    ----> who yields now?
///   world ---- t -------+---- branch, ego yields  ----> who goes now?
///                       '---- the world itself    ---->
/// \endcode
/// The ego is driven past the bus: no frames, no ECU, no judge; the car's own dynamics and actuators stay.

#include <memory>
#include <vector>

#include "sim_host/world/ego_road.hpp"
#include "sim_host/world/nodes/vehicle.hpp"
#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::world {

/// What the car is asked for, as a command frame asks it.
struct EgoCommand {
  double acceleration_mps2 = 0.0;
  double steering_rad = 0.0;  ///< road-wheel angle, left positive
};

class Branch;

/// Who drives the ego of a branch.
class EgoDriver {
 public:
  virtual ~EgoDriver() = default;
  /// Called once a tick, before it, with the branch as it is then. \return what acts during the tick
  [[nodiscard]] virtual EgoCommand drive(const Branch& now) = 0;
};

class Branch {
 public:
  /// The state it begins with; World::fork() fills it in.
  struct Start {
    std::shared_ptr<const EgoRoad> road;
    std::unique_ptr<traffic::TrafficEngine> traffic;
    nodes::Vehicle vehicle;
    traffic::LanePlace place;
    double time_s = 0.0;
  };
  /// \param driver  must outlive the branch
  Branch(Start start, EgoDriver& driver);

  /// Advances 10 ms. It goes on whatever happens: after a touch, beyond the goal, off the road.
  void step();

  [[nodiscard]] double time_s() const;  ///< since the ECU took over, as the world counts it
  [[nodiscard]] const EgoRoad& road() const { return *start_.road; }
  [[nodiscard]] const nodes::Vehicle& vehicle() const { return start_.vehicle; }
  [[nodiscard]] const traffic::LanePlace& place() const { return start_.place; }
  [[nodiscard]] const traffic::CarState& ego() const { return ego_; }
  [[nodiscard]] const std::vector<traffic::CarState>& others() const { return others_; }
  /// Id of the first car the ego's box has overlapped so far; kNoCar: none.
  [[nodiscard]] int touched() const { return touched_; }

 private:
  void look();

  Start start_;
  EgoDriver& driver_;
  int ticks_ = 0;
  traffic::CarState ego_;
  std::vector<traffic::CarState> others_;
  int touched_ = traffic::kNoCar;
};

}  // namespace s4tp::world
