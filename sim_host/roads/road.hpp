#pragma once
/// A road as it is drawn: a plain network in netconvert's words, a mission and the traffic on it. What
/// depends on the network that netconvert makes of it (streams lane by lane, entry speed) is left to
/// scenario_toml().

#include <optional>
#include <string>
#include <vector>

#include "sim_host/world/map/polyline.hpp"
#include "sim_host/world/scenario/traffic_demand.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::roads {

inline constexpr double kLaneWidth_m = 3.2;
inline constexpr double kShortestArm_m = 25.0;  ///< of the lanes that a mission starts and ends in

struct PlainNode {
  std::string id;
  map::Vec2 at{};
  std::string type = "dead_end";
  double radius_m = 4.0;  ///< of the kerb's corners
};

struct PlainEdge {
  std::string id;
  std::string from;
  std::string to;
  int lanes = 1;
  double speed_mps = 13.89;
  int priority = 1;
  std::vector<map::Vec2> shape{};  ///< empty: straight; else from its first to its last point
  bool centred = false;            ///< lanes to both sides of the shape; else to its right
};

/// Of an edge that has none netconvert guesses them.
struct PlainConnection {
  std::string from;
  std::string to;
  int from_lane = 0;
  int to_lane = 0;
};

struct PlainNetwork {
  std::vector<PlainNode> nodes;
  std::vector<PlainEdge> edges;
  std::vector<PlainConnection> connections;
};

struct RoadMission {
  std::string start_edge;
  int start_lane = 0;
  std::string goal_edge;
  int goal_lane = 0;
  double start_share = 0.0;  ///< 0 .. 1: of the room there is to start later than 5 m along the lane
  double speed_share = 1.0;  ///< 0 .. 1: of the limit, or of what can still be stopped from if that is less
  double entry_time_s = 15.0;
};

/// Streams of traffic, of which each episode draws some.
struct Streams {
  std::vector<scenario::TrafficRoute> ways{};  ///< start_lane -1: one stream for each lane that leads on
  int choose_low = 0;
  int choose_high = 0;  ///< 0: every stream drives
  scenario::Range vehicles_per_minute{};
  std::string driver{};  ///< TOML of the table `driver`; empty: as all
};

struct RoadTraffic {
  std::string driver;  ///< TOML of [traffic.driver], what all have in common; empty: SUMO's defaults
  std::string mix;     ///< TOML of the key `mix`; empty: one kind of driver
  std::vector<Streams> streams;
};

struct Road {
  PlainNetwork network;
  RoadMission mission;
  RoadTraffic smarts;
  RoadTraffic social;
};

/// A kind of road; results are grouped by it.
struct Family {
  const char* name;
  Road (*draw)(traffic::Random& random);
};

/// In the order in which numbers have them: road number N is of family N modulo their number.
[[nodiscard]] const std::vector<Family>& families();

// The families, each of any geometry that its kind leaves open: lanes, lengths, angles, limits, rule.
[[nodiscard]] Road draw_crossing_left(traffic::Random& random);
[[nodiscard]] Road draw_crossing_straight(traffic::Random& random);
[[nodiscard]] Road draw_crossing_right(traffic::Random& random);
[[nodiscard]] Road draw_tee_left(traffic::Random& random);
[[nodiscard]] Road draw_tee_right(traffic::Random& random);
/// A turn with one or two lane changes due before it and one or two after it.
[[nodiscard]] Road draw_late_change(traffic::Random& random);
[[nodiscard]] Road draw_roundabout(traffic::Random& random);
/// The ramp ends in a junction: its connection merges into the right lane.
[[nodiscard]] Road draw_ramp_junction(traffic::Random& random);
/// The ramp goes on beside the road for 40 to 200 m.
[[nodiscard]] Road draw_ramp_lane(traffic::Random& random);
[[nodiscard]] Road draw_lane_drop(traffic::Random& random);
[[nodiscard]] Road draw_curve(traffic::Random& random);
[[nodiscard]] Road draw_cruise(traffic::Random& random);
[[nodiscard]] Road draw_overtake(traffic::Random& random);
[[nodiscard]] Road draw_cut_in(traffic::Random& random);

}  // namespace s4tp::roads
