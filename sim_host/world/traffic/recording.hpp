#pragma once
/// What happened in an episode: the one source of metrics and pictures.

#include <cstdint>
#include <string>
#include <vector>

#include "sim_host/world/map/polyline.hpp"

namespace s4tp::traffic {

/// True state of one car at an instant, network coordinates; the point is the box centre.
struct CarState {
  int id = 0;  ///< 0 is the ego
  map::Vec2 centre;
  double heading_rad = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double yaw_rate_radps = 0.0;
  double length_m = 5.0;
  double width_m = 1.8;
  int lane = -1;  ///< network lane id; -1: off the network
};

inline constexpr double kSnapshotPeriod_s = 0.1;  ///< of a recording

struct Snapshot {
  double time_s = 0.0;  ///< since the ECU took over; negative in the pre-roll
  CarState ego;
  double ego_steering_rad = 0.0;
  double ego_lane_offset_m = 0.0;  ///< from the nearest lane centre
  double ego_lane_width_m = 3.2;
  std::vector<CarState> others;
};

enum class Ending { kRunning, kGoal, kCollision, kOffRoad, kTimeOut, kDeadEcu };
enum class Fault { kNone, kEgo, kOther };

/// What the one at fault did (judge/attribution.hpp).
enum class Cause {
  kNone,
  kEntered,
  kNoRoom,
  kIntoRightful,
  kEnteredLater,
  kCutIn,
  kStopped,
  kRanInto,
  kOncoming,
  kChangedLane,
  kAppeared,
  kUnclear
};
/// The same in words, as seen from the ego: "ran into", "was run into".
[[nodiscard]] const char* cause_words(Fault fault, Cause cause);

/// A touch of boxes, attributed from a table, without asking any planner.
struct Collision {
  double time_s = 0.0;
  int other = 0;
  Fault fault = Fault::kNone;
  Cause cause = Cause::kNone;
};

struct Recording {
  std::string scenario;
  std::uint64_t seed = 0;
  int redrawn = 0;  ///< episodes thrown away for an overlap in the first second
  Ending ending = Ending::kRunning;
  map::Vec2 goal;                                 ///< where it lies
  double goal_distance_m = 0.0;                   ///< Manhattan distance to the goal at the end
  std::vector<Snapshot> snapshots;                ///< every kSnapshotPeriod_s
  std::vector<Collision> collisions;              ///< boxes of the cars' own size
  std::vector<Collision> collisions_competition;  ///< the same with 3.68 x 1.47 m boxes
};

}  // namespace s4tp::traffic
