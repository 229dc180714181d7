#pragma once
/// Traffic by SUMO: a child process, driven over TraCI on loopback, ten steps a second.
///
/// \code
///   our ticks    t      t+0.01   ...          t+0.1
///   SUMO         A ------ one step, made at t ---- B      cars() lies between A and B
///   the ego      seen at t; SUMO is told where it will be at t+0.1, so that in B everybody
///                stands at one time
/// \endcode

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim_host/sumo/ego_reach.hpp"
#include "sim_host/sumo/sumo_session.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::sumo {

/// How SUMO is told of an ego it does not drive. The defaults are those that touch least
/// (docs/sumo_coupling.md); the others are there to be measured against.
struct EgoCoupling {
  bool early = true;   ///< in the network from entry on with its speed, not a step later and at first at rest
  bool ahead = true;   ///< placed where it will be at the step's end, not where it was at its start
  bool wishes = true;  ///< SUMO's driver in it wishes the lane changes of the mission, so others make room
  bool on_route = true;     ///< on a lane of its route as long as it is on one, however near another runs
  bool along_lanes = true;  ///< as long as its box is along its lanes (EgoReach)
  int speed_mode = 0;       ///< 0: SUMO takes it for one who goes through junctions whoever comes
  std::string driver = {};  ///< further attributes of its vehicle type, as XML
};

class Traffic final : public traffic::TrafficEngine {
 public:
  Traffic(const scenario::Scenario& scenario, const traffic::EngineOptions& options,
          const EgoCoupling& coupling = {});
  ~Traffic() override;

  void step(const traffic::EgoSeen* ego) override;
  [[nodiscard]] double time_s() const override { return static_cast<double>(ticks_) * 0.01; }
  [[nodiscard]] std::vector<traffic::CarState> cars() const override;
  [[nodiscard]] std::vector<traffic::CarFlags> flags() const override;
  void clear(map::LaneId lane, double from_m, double to_m) override;
  [[nodiscard]] int finished() const override { return finished_; }
  [[nodiscard]] std::optional<traffic::CarState> driven_ego() const override;
  [[nodiscard]] pid_t process() const { return sumo_.process->id(); }
  /// The ego as SUMO has it, however it is driven; none before it is there.
  [[nodiscard]] std::optional<traffic::CarState> ego_seen() const;

 private:
  struct Car {
    traffic::CarState before;  ///< at the step's start
    traffic::CarState after;   ///< at its end
    bool known_before = false;
    bool arrived = false;  ///< within the step
    bool changing_lane = false;
    std::vector<map::LaneId> lanes;  ///< its box is on: from the centre's to the one SUMO says, the bumper's
  };

  [[noreturn]] void fail(const traci::Error& error);
  void sumo_step(const traffic::EgoSeen* ego);
  void add_ego();
  void put_ego(const traffic::CarState& place);
  void enter_ego();
  void observe(Car& car, const traci::Variables& variables);
  void follow_lanes(Car& car, const std::string& bumper_lane) const;
  [[nodiscard]] traffic::CarState between(const Car& car) const;

  const scenario::Scenario& scenario_;
  traffic::EngineOptions options_;
  EgoCoupling coupling_;
  std::unordered_map<std::string, map::LaneId> lane_of_;
  EgoReach ego_reach_;
  Session sumo_;
  std::map<std::string, Car> cars_;                     ///< by SUMO's id
  double ego_length_m_ = traffic::CarState{}.length_m;  ///< as SUMO was told
  bool ego_there_ = false;
  int next_id_ = 1;
  int finished_ = 0;
  std::int64_t ticks_ = 0;
};

}  // namespace s4tp::sumo
