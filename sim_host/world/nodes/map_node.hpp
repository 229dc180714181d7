#pragma once
/// The map node: shows the ECU the lanes within the horizon, as wire records with stable slots.
/// The kinds `ours` and `opposite` are those of lane_roles.hpp.

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "firmware/wire/lane_map.hpp"
#include "sim_host/world/map/network.hpp"

namespace s4tp::nodes {

class MapNode {
 public:
  /// \param network, guide  must outlive the node  \param origin  network coordinates of the odometry frame's
  /// origin
  MapNode(const map::Network& network, const map::RouteGuide& guide, map::Vec2 origin,
          double horizon_m = 150.0);

  /// Chooses the lanes around `position` (network coordinates) and fills the wire map.
  ///
  /// MAP-001 A lane keeps its slot while it stays within the horizon; it leaves it 10 m later than it came.
  ///
  /// MAP-002 Lanes that 12 vertices cannot show within 0.03 m, or longer than 250 m, are sent in parts, each
  /// the successor of the one before; all arc lengths are those of the vertices sent.
  ///
  /// MAP-003 Over 64: the route, then lanes in conflict with it and those leading there, then neighbours,
  /// then the rest, nearest first; those left out are counted.
  const wire::Map& update(map::Vec2 position);

 private:
  /// A lane as it goes over the wire: the whole of a network lane, or a part of it.
  struct Part {
    map::LaneId lane = map::kNoLane;
    double from_m = 0.0;  ///< along the network's lane
    double to_m = 0.0;
    double scale = 1.0;  ///< length of the vertices sent per metre of the network's lane
    int rank = 0;        ///< MAP-003, 0 first
    map::Polyline line;  ///< as sent, network coordinates
    wire::Lane record;   ///< without links
  };
  /// A conflict between two parts.
  struct PartConflict {
    int first = 0;
    int second = 0;
    int rank = 0;
    wire::Conflict record;  ///< without slots
  };

  void split_into_parts();
  void fill_record(Part& part, bool ours, bool last) const;
  void split_conflicts();
  void choose_lanes(map::Vec2 position);
  void choose_conflicts();
  [[nodiscard]] wire::Lane linked(int part) const;
  [[nodiscard]] std::uint8_t slot_of(int part) const;
  [[nodiscard]] int part_beside(const Part& part, map::LaneId neighbour) const;

  const map::Network& network_;
  const map::RouteGuide& guide_;
  map::Vec2 origin_;
  double horizon_m_;
  std::vector<Part> parts_;
  std::vector<std::pair<int, int>> parts_of_lane_;  ///< first, and one beyond the last
  std::vector<PartConflict> conflicts_;
  std::map<int, int> slot_of_part_;
  std::map<int, int> slot_of_conflict_;
  wire::Map map_;
};

}  // namespace s4tp::nodes
