#pragma once
/// The world as the planner sees it: who is there, where they may go, and where ways cross.
/// Written by SceneBuilder once a cycle, read by every later stage.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/world_state.hpp"
#include "algo/scene/lane_path.hpp"
#include "algo/scene/reference_line.hpp"

namespace s4tp::scene {

/// The past of one vehicle on the dt grid, oldest first; `valid` is the mask (never x == 0).
struct History {
  struct Sample {
    Pose pose;  ///< rear axle for us, box centre for others
    float speed_mps = 0.0F;
  };
  Sample samples[kHistorySamples];
  std::uint16_t valid = 0;  ///< bit i: samples[i] was seen
};

/// Not in a list for longer, a vehicle is not "seen" any more.
inline constexpr std::int32_t kFreshMs = 250;

/// A vehicle as of the scene's time (tracks are brought forward from the list's time).
struct Agent {
  Track track;
  std::uint16_t age_ms = 0;    ///< since it was last in a list; coasted meanwhile
  std::uint16_t stood_ms = 0;  ///< CORE-034 how long it has stood, and ...
  std::uint16_t known_ms = 0;  ///< ... how long it has been in sight; at most a minute
  float coasted_m = 0.0F;      ///< of its way, since it was seen, and ...
  float coasted_mps = 0.0F;    ///< ... the speed it was taken to gain
  LaneIndex lane = kNoLaneIndex;
  BoundedVector<LanePath, kPathsPerAgent> paths;  ///< ways it may go; the first is the likeliest
  float path_probability[kPathsPerAgent] = {};    ///< of each path; they add up to 1
  Frenet frenet[kPathsPerAgent];                  ///< of its centre along each path
  History history;
};

inline constexpr float kUsualHalfLengthM = 2.5F;  ///< of the boxes the map node takes for its zones

/// Where our path and another lane share ground.
struct ConflictZone {
  float entry_s_m = 0.0F;  ///< on our path, of our box centre
  float exit_s_m = 0.0F;
  float stop_s_m = 0.0F;  ///< where our front bumper stands to wait for it, short of a stop line
  LaneIndex other_lane = kNoLaneIndex;
  float other_entry_m = 0.0F;  ///< on the other lane
  float other_exit_m = 0.0F;
  Priority priority = Priority::kFirstCome;  ///< seen from us: kFirstYields = we yield
  bool merging = false;  ///< both ways go on in one lane: the other comes after us, not across
  bool beside = false;   ///< in a lane beside our way: nobody there expects us
};

inline constexpr int kMaxChanges = 4;  ///< more that are needed are known when the first ones are made

/// How the ego may use a lane beside or under it.
enum class Manoeuvre : std::uint8_t { kKeep = 0, kLeft = 1, kRight = 2 };

inline constexpr float kBesideShare = 0.25F;  ///< of a lane's width from its centre we are on one side of it
/// Way of a slow lane change: a quintic over 3.2 m, bent as gently as roll_out.cpp bends it, takes 14.3 m.
inline constexpr float kChangeWayM = 15.0F;

/// One way we may go: along our lane or a neighbour, then along the route.
struct EgoPath {
  Manoeuvre manoeuvre = Manoeuvre::kKeep;
  std::int8_t changes_needed = 0;  ///< on the last lane along it that leads on, to the route's
  LanePath path;
  Frenet frenet;                          ///< of our rear axle
  const ReferenceLine* driven = nullptr;  ///< line it is driven on, once that is built
  float lateral_offset_m = 0.0F;          ///< left of that it is driven, past who stand
  float route_end_s_m = 0.0F;  ///< where a lane change must be finished: beyond the path's end, too
  /// By when each of the `changes_needed` is to be made, in their order; the first one by route_end_s_m.
  BoundedVector<float, kMaxChanges> change_by_s_m;
  float change_from_s_m = 0.0F;  ///< where a lane to change to begins
  float goal_s_m = 0.0F;         ///< where the goal lies along it
  BoundedVector<ConflictZone, kMaxPathZones> zones;
};

/// The ground on which nobody is missing. CORE-036 It reaches as far as the last vehicle of a list that left some
/// out, by list_distance_m, and no further than those the scene has no room for: the first of all by that, missing ones
/// among them, are kept. Sensors that see less far than the map, or past whom they cannot see, do not bound it.
///
/// \code
///        . - ~ - .      centre: our box, at the list's time
///      '   [1] [2] '    radius: to the last of the list, if it drives as we do
///     | [us]        [16]      [?]->  left out: beyond by as much as the two come nearer in 2 s, or more
///      .    [3]    .
///        ' - _ - '
/// \endcode
struct KnownGround {
  static constexpr float kEverywhereM = 1e4F;
  Point centre;
  float radius_m = kEverywhereM;  ///< of nobody is it known that it is not missing: 0
  std::uint16_t age_ms = 0;       ///< of the list
  std::uint8_t left_out = 0;      ///< how many are known to be beyond it
  Point velocity;                 ///< ours, at the list's time [m/s]
};

/// Everything one planning cycle knows of the world.
struct Scene {
  std::uint32_t time_ms = 0;  ///< the instant all poses are given for
  EgoState ego;
  History ego_history;
  BoundedVector<EgoPath, 3> ego_paths;      ///< keep first; none when no lane is under us
  BoundedVector<Agent, kMaxTracks> agents;  ///< the first `watched` are the relevant ones
  int watched = 0;                          ///< <= kMaxAgents, predicted with interaction
  const LaneMap* map = nullptr;             ///< valid during the cycle only
  KnownGround known;
  float waited_s = 0.0F;        ///< how long we have stood at the junction we are at or in (CORE-033)
  std::uint8_t id_clashes = 0;  ///< CORE-035 vehicles of the last list whose ids were not their own
  bool list_refused = false;    ///< CORE-008 the list lies over 500 ms from the scene, or before the last one
  int work = 0;                 ///< what building it took [WorkMeter's units]
};

/// Which vehicles SATP watches (method.md 4.1).
enum class Relevance : std::uint8_t { kInteraction = 0, kNearest = 1 };

}  // namespace s4tp::scene
