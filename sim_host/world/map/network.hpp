#pragma once
/// A road network as the world knows it, read from a SUMO network file (.net.xml, made by netconvert).
/// Coordinates are the network's own [m]; every lane, those inside junctions too, is one entry.

#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/world/map/polyline.hpp"

namespace s4tp::map {

using LaneId = int;  ///< index into Network::lanes
inline constexpr LaneId kNoLane = -1;

struct Lane {
  std::string name;  ///< SUMO's lane id, such as "south_in_0" or ":cross_3_0"
  std::string edge;
  int index = 0;  ///< SUMO's within the edge, 0 is the rightmost; those cars may not use are left out
  Polyline centre;
  Polyline drawn;  ///< where SUMO's cars drive: the centre line as the network has it, corners and all
  double sumo_length_m = 0.0;  ///< as positions of SUMO's count; differs from the shape's where so written
  double width_m = 3.2;
  double speed_limit_mps = 13.89;
  bool in_junction = false;        ///< on the way through a junction, be it only a seam between two edges
  std::vector<LaneId> successors;  ///< direct: into the junction lane, and from there to the next edge's lane
  std::vector<LaneId> predecessors;
  LaneId left = kNoLane;  ///< same direction neighbours, change allowed
  LaneId right = kNoLane;
};

/// kFirstCome: zipper, right before left all round, or the network says nothing.
enum class Rule { kFirstYields, kFirstHasPriority, kFirstCome };

/// Two lanes share ground (crossing or merging). Arc lengths are of a box centre (5.0 x 1.8 m boxes, 0.1 m
/// spare around each) on each. Lanes that merge stay in conflict up to the end of
/// both. At least one of the two is inside the junction. NET-002 every pair whose boxes can touch is listed
/// once, with the network's own rule.
struct Conflict {
  LaneId first = kNoLane;
  LaneId second = kNoLane;
  Rule rule = Rule::kFirstCome;
  double first_entry_m = 0.0;
  double first_exit_m = 0.0;
  double second_entry_m = 0.0;
  double second_exit_m = 0.0;
};

struct Network {
  std::vector<Lane> lanes;
  std::vector<Conflict> conflicts;

  /// \return kNoLane when there is no such lane
  [[nodiscard]] LaneId find(const std::string& lane_name) const;
  /// \param index  SUMO's, which counts the lanes that cars may not use too
  [[nodiscard]] LaneId lane_of(const std::string& edge, int index) const;
  [[nodiscard]] std::vector<LaneId> lanes_of(const std::string& edge) const;  ///< by index, rightmost first
};

/// Reads a network. Lanes closed to passenger cars, walking areas and crossings are left out; signals are not
/// read (the junction's priorities hold). NET-001 \throws std::runtime_error naming file, element and what
/// was expected. NET-004 Reading it, and what a drive makes of it, costs memory and time by the size of the file:
/// no number in it makes that much more.
[[nodiscard]] Network load_network(const std::filesystem::path& file);

/// Way along a list of edges: for each lane of the network what a driver on it must know (as SUMO's
/// bestLanes). Of all lanes of an edge that lead on, the one is sought from which the goal takes the fewest
/// lane changes in all; of equals the furthest, so that changes needed only later are known early:
/// `remaining_m` says by when.
///
/// \code
///   ramp_0 ---> merge_0 x           merge_0: changes_needed 3, remaining 71 m (one change is due by then)
///   main_0 ---> merge_1 ---> out_0  merge_1: changes_needed 2, remaining 71 + 70 m
///   main_1 ---> merge_2 ---> out_1
///   main_2 ---> merge_3 ---> out_2  the goal lane (leftmost)
/// \endcode
class RouteGuide {
 public:
  /// NET-003 \throws std::runtime_error when the edges do not lead to each other
  /// \param goal_lane  lane (of the last edge) to end in, or kNoLane: any  \param goal_s_m  along it
  RouteGuide(const Network& network, std::vector<std::string> edges, LaneId goal_lane, double goal_s_m);

  struct Advice {
    bool on_route = false;         ///< the lane's edge (or junction connection) belongs to the route
    int changes_needed = 0;        ///< lane changes to the lane sought: > 0 to the left; inside a junction
                                   ///< those of the lane after it
    double remaining_m = 0.0;      ///< from the lane's start, drivable along the route without a change
    double goal_distance_m = 0.0;  ///< from the lane's start along the route to the goal
    LaneId next = kNoLane;         ///< the successor the route takes; none if the lane does not lead on
  };
  [[nodiscard]] const Advice& advice(LaneId lane) const;
  [[nodiscard]] std::size_t size() const { return lanes_.size(); }  ///< lanes on the route

 private:
  std::vector<LaneId> lanes_;   ///< on the route, ascending: there may be thousands of routes
  std::vector<Advice> advice_;  ///< of each of them
};

}  // namespace s4tp::map
