#pragma once
/// Who may come: flows to draw from in each episode (scenario.toml), or what a route file of SUMO's says.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace s4tp::scenario {

/// A uniform range to draw from.
struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// One kind of driver and car; SUMO's names and defaults.
struct DriverModel {
  std::string name;
  double weight = 1.0;  ///< share of this kind among those of its flow
  double acceleration_mps2 = 2.6;
  double deceleration_mps2 = 4.5;
  double sigma = 0.5;  ///< imperfection, 0 .. 1
  double headway_s = 1.0;
  double min_gap_mean_m = 2.5;
  double min_gap_deviation_m = 0.0;
  double speed_factor_mean = 1.0;
  double speed_factor_deviation = 0.1;
  double max_speed_mps = 55.0;
  double svo_rad = 0.0;       ///< social value orientation: 0 its own gain only, pi/4 that of others as much
  bool lane_keeping = false;  ///< never changes lane by its own wish
  double length_m = 5.0;
  double width_m = 1.8;
};

/// One way traffic may take: edges, and the lane it starts and ends in (SUMO's numbers; -1: any).
struct TrafficRoute {
  std::vector<std::string> edges;
  int start_lane = -1;
  int end_lane = -1;
};

/// A group of possible flows, of which some are drawn in each episode.
struct FlowGroup {
  std::vector<TrafficRoute> routes;
  int choose_low = 1;  ///< how many of the routes are drawn
  int choose_high = 1;
  Range vehicles_per_minute;  ///< each flow's own rate
  Range begin_s;
  bool random_spacing = false;           ///< exponential gaps instead of even ones
  std::vector<DriverModel> drivers{{}};  ///< each car draws one by weight; never empty
};

/// Where on its first edge, and how fast, a car enters; SUMO's words.
struct DepartWish {
  enum class Lane { kNumber, kFirst, kRandom, kBest };
  enum class Position { kBase, kNumber, kRandom };
  enum class Speed { kNumber, kAsTrafficAllows, kRandom };

  Lane lane = Lane::kFirst;
  int lane_number = 0;  ///< SUMO's
  Position position = Position::kBase;
  double position_m = 0.0;  ///< of the front bumper; < 0 from the lane's end
  Speed speed = Speed::kNumber;
  double speed_mps = 0.0;
};

/// A vehicle (a flow of one), trip or flow.
struct DemandFlow {
  enum class Spacing { kEven, kExponential, kPerSecond };

  std::string id;
  double begin_s = 0.0;
  double end_s = std::numeric_limits<double>::infinity();
  int number = std::numeric_limits<int>::max();  ///< of cars, at most
  Spacing spacing = Spacing::kEven;
  double period_s = 1.0;            ///< mean
  double probability = 0.0;         ///< of one in each second
  std::vector<std::size_t> routes;  ///< into Demand::routes, one drawn by weight
  std::vector<double> route_weights;
  std::vector<DriverModel> drivers;  ///< one drawn by weight
  DepartWish depart;
};

struct Demand {
  std::vector<TrafficRoute> routes;
  std::vector<DemandFlow> flows;
  std::vector<std::string> notes;  ///< what was left out because it does no harm, one line each
};

}  // namespace s4tp::scenario
