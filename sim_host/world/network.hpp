#pragma once
/// A road network as the world knows it, read from a SUMO network file (.net.xml, made by netconvert).
/// Coordinates are the network's own [m]; every lane, those inside junctions too, is one entry.

#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/world/polyline.hpp"

namespace s4tp::world {

using LaneId = int;  ///< index into Network::lanes
inline constexpr LaneId kNoLane = -1;

struct NetworkLane {
  std::string name;  ///< SUMO's lane id, such as "south_in_0" or ":cross_3_0"
  std::string edge;
  int index = 0;  ///< within the edge, 0 is the rightmost
  Polyline centre;
  double width_m = 3.2;
  double speed_limit_mps = 13.89;
  bool in_junction = false;
  std::vector<LaneId> successors;  ///< direct: into the junction lane, and from there to the next edge's lane
  std::vector<LaneId> predecessors;
  LaneId left = kNoLane;  ///< same direction neighbours
  LaneId right = kNoLane;
};

enum class Rule { kFirstYields, kFirstHasPriority, kFirstCome };

/// Two lanes share ground (crossing or merging). Arc lengths are of a box centre (5.0 x 1.8 m boxes) on each.
struct NetworkConflict {
  LaneId first = kNoLane;
  LaneId second = kNoLane;
  Rule rule = Rule::kFirstCome;
  double first_entry_m = 0.0;
  double first_exit_m = 0.0;
  double second_entry_m = 0.0;
  double second_exit_m = 0.0;
};

struct Network {
  std::vector<NetworkLane> lanes;
  std::vector<NetworkConflict> conflicts;

  /// \return kNoLane when there is no such lane
  [[nodiscard]] LaneId find(const std::string& lane_name) const;
  [[nodiscard]] std::vector<LaneId> lanes_of(const std::string& edge) const;  ///< by index, rightmost first
};

/// Reads a network. \throws std::runtime_error naming file, element and what was expected
[[nodiscard]] Network load_network(const std::filesystem::path& file);

/// Way along a list of edges: for each lane of the network what a driver on it must know.
class RouteGuide {
 public:
  /// \param goal_lane  lane (of the last edge) to end in, or kNoLane: any  \param goal_s_m  along it
  RouteGuide(const Network& network, std::vector<std::string> edges, LaneId goal_lane, double goal_s_m);

  struct Advice {
    bool on_route = false;         ///< the lane's edge (or junction connection) belongs to the route
    int changes_needed = 0;        ///< lane changes to the lane that leads on: > 0 to the left
    double remaining_m = 0.0;      ///< from the lane's start, drivable along the route without a change
    double goal_distance_m = 0.0;  ///< from the lane's start along the route to the goal
    LaneId next = kNoLane;         ///< the successor the route takes, when changes_needed is 0
  };
  [[nodiscard]] const Advice& advice(LaneId lane) const { return advice_[static_cast<std::size_t>(lane)]; }

 private:
  std::vector<Advice> advice_;
};

}  // namespace s4tp::world
