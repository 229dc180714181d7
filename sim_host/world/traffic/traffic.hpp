#pragma once
/// The built-in traffic: drivers who follow, change lanes on their route, accept gaps at junctions, and react
/// to the ego as to any car. Decisions at 10 Hz from one common instant, motion at 100 Hz.
///
/// Drivers are honest, not superhuman: something unexpected (a car cutting in, a car entering without right
/// of way) is acted upon only after a reaction time of 0.5 to 1 s and with at most 4.5 to 9 m/s^2; inside a
/// junction nobody brakes for crossing traffic.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"
#include "sim_host/world/traffic/traffic_flow.hpp"
#include "sim_host/world/traffic/traffic_junction.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::traffic {

/// One car of the traffic; its box centre is at `s_m` along the lane, `offset_m` to the left of it.
struct Car {
  static constexpr int kLooking = -2;  ///< attentive just now: whoever is there is no surprise

  int id = 0;  ///< 1 + the index of its departure: no draw, and nobody's delay, changes it
  std::size_t way = 0;
  Driver driver;
  map::LaneId lane = map::kNoLane;
  double s_m = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double length_m = 5.0;
  double width_m = 1.8;

  map::LaneId leaving = map::kNoLane;  ///< lane being left during a change
  double change_from_m = 0.0;          ///< offset at the start of the change
  double change_done = 1.0;            ///< 0 .. 1
  double next_change_s = 0.0;          ///< no wish before

  bool committed = false;
  double waited_s = 0.0;
  double gave_way_s = 0.0;  ///< standing or braking out of courtesy, at this junction
  int lets_go = kNoCar;
  bool queues = false;  ///< this and the next: JunctionChoice's
  std::vector<int> waits_for;
  int known_leader = kNoCar;  ///< whom it follows
  double known_gap_m = 0.0;
  int surprise = kNoCar;  ///< who appeared unexpectedly, and since when
  double surprise_since_s = 0.0;
  int hazard = kNoCar;
  double hazard_since_s = 0.0;

  [[nodiscard]] double offset_m() const;
};

class Traffic : public TrafficEngine {
 public:
  /// WORLD-021 The same network, groups and seed give the same traffic to the bit. WORLD-022 Whoever enters
  /// late shifts nobody else's id, order or draws: who does not meet it drives on to the bit.
  Traffic(const map::Network& network, const std::vector<scenario::FlowGroup>& groups, std::uint64_t seed);
  /// \param episode  chooses among the scenario's route files
  Traffic(const scenario::Scenario& scenario, std::uint64_t episode, std::uint64_t seed);

  void step(const EgoSeen* ego) override;
  [[nodiscard]] std::unique_ptr<TrafficEngine> clone() const override;
  [[nodiscard]] double time_s() const override { return static_cast<double>(ticks_) * 0.01; }
  [[nodiscard]] std::vector<CarState> cars() const override;
  [[nodiscard]] std::vector<CarFlags> flags() const override;
  void clear(map::LaneId lane, double from_m, double to_m) override;
  [[nodiscard]] int finished() const override { return finished_; }

  [[nodiscard]] const std::vector<Car>& details() const { return cars_; }

 protected:
  static constexpr int kDecisionTicks = 10;
  static constexpr double kDecision_s = kTick_s * kDecisionTicks;
  static constexpr double kNear_m = 8.0;  ///< of the line: waiting time counts

  /// What everybody does in the next 0.1 s. \param ego  null: not there
  virtual void decide(const Actor* ego);
  /// Whether a driver who wants to change into a lane does. \param beside  the lane, from the car's place on
  [[nodiscard]] virtual bool may_change(const Car& /*car*/, const WayPart& /*beside*/) const { return true; }
  /// Whether a car for which there is room comes into the world now.
  [[nodiscard]] virtual bool may_come_in(const Car& /*car*/) const { return true; }
  [[nodiscard]] Actor actor_of(const Car& car) const;
  [[nodiscard]] std::vector<Actor> actors(const Actor* ego) const;
  /// As the driver would like it, everybody in `view` considered.
  [[nodiscard]] double acceleration(Car& car, const Actor& self, const TrafficView& view);
  void consider_lane_change(Car& car, const Actor& self, const TrafficView& view);
  void insert_waiting(const Actor* ego);
  [[nodiscard]] const map::Lane& lane(map::LaneId id) const { return road_->lane(id); }

  std::shared_ptr<const RoadIndex> road_;  ///< what never changes is shared with the copies
  std::shared_ptr<const FlowPlan> plan_;
  std::uint64_t seed_;
  std::vector<Car> cars_;  ///< by id

 private:
  [[nodiscard]] double wanted_speed_mps(const Car& car, const std::vector<WayPart>& way) const;
  [[nodiscard]] double follow(Car& car, const Actor& self, const TrafficView& view, const Leader& leader,
                              double wanted_mps);
  // What each of these asks for at most [m/s^2]; infinity: nothing. The car remembers what it decided.
  [[nodiscard]] double for_lane_end(const Car& car, const Actor& self, double wanted_mps) const;
  [[nodiscard]] double for_junction(Car& car, const JunctionChoice& choice, double wanted_mps) const;
  [[nodiscard]] double for_hazard(Car& car, const JunctionChoice& choice, double wanted_mps) const;
  [[nodiscard]] double towards_merging(const Car& car, const Actor& self, const TrafficView& view,
                                       const Leader& leader, double wanted_mps, double result) const;
  [[nodiscard]] double lane_change_gain(const Car& car, const TrafficView& view, const WayPart& beside) const;
  [[nodiscard]] bool safe_beside(const Car& car, const WayPart& beside, const TrafficView& view,
                                 bool urgent) const;
  void watch_ego(const Actor& ego, const TrafficView& view);
  [[nodiscard]] const Driver& driver_of(int id) const;
  [[nodiscard]] bool somebody_comes(const TrafficView& view, const Car& car) const;
  [[nodiscard]] std::optional<double> entry_speed_mps(const TrafficView& view, const Car& car,
                                                      const Departure& departure) const;
  void move(Car& car);

  std::vector<std::deque<std::size_t>> waiting_;  ///< departures, by lane
  std::size_t next_departure_ = 0;
  int finished_ = 0;
  std::int64_t ticks_ = 0;
  double ego_waited_s_ = 0.0;
  bool ego_queues_ = false;
  std::vector<int> ego_waits_for_;
  Driver ego_driver_;  ///< what others take the ego's driver to be
};

}  // namespace s4tp::traffic
