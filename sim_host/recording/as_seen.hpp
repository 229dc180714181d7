#pragma once
/// A drive as the ECU saw it, for a page: where the world it came from is not known.

#include <array>
#include <cstdint>
#include <set>

#include "algo/core/parameters.hpp"
#include "firmware/ecu/ecu_core.hpp"
#include "firmware/wire/lane_map.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::recording {

/// \pre core.inputs().ego_known()
[[nodiscard]] traffic::Snapshot snapshot_of(const ecu::EcuCore& core, const Parameters& parameters);

/// Coordinates are the odometry frame's. Vehicles are those of the track lists, with their ids and errors;
/// lanes are those of the map on the bus; nothing is known of a goal or of touches.
class AsSeen {
 public:
  /// REC-040 After every tick. \param time_s  on the page's clock
  void look(const ecu::EcuCore& core, const Parameters& parameters, double time_s);
  [[nodiscard]] bool empty() const { return recording_.snapshots.empty(); }
  [[nodiscard]] traffic::Recording recording() const;
  /// Its network only.
  [[nodiscard]] const scenario::Scenario& scenario() const { return scenario_; }

 private:
  void keep_lanes(const wire::Map& map);

  traffic::Recording recording_;
  scenario::Scenario scenario_;
  std::set<std::array<long, 4>> known_;  ///< first and last points of lanes kept [m]
  std::uint32_t revision_ = 0;
  double clock_s_ = 0.0;  ///< vehicle time at 0 of the page's clock
  int ticks_ = 0;
};

}  // namespace s4tp::recording
