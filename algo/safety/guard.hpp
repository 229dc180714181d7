#pragma once
/// The guard (method.md 4.9): a plan passes only when a fail-safe from its first part meets nobody who keeps
/// to the law. Knows tracks, map and plan; never predictions, beliefs or manoeuvres.
/// GUARD-001 A plan passes that can still be stopped before a group of zones and before the road ends;
/// without map or path nothing does. Who stands nearer to the group goes on standing, and comes no nearer;
/// who set off and has not used its licence yet may use up the room before it.
/// GUARD-002 Else it goes through when all others are gone, come later than it leaves, braking behind whoever leads once that is
/// due, or leave it to us. GUARD-003 Nobody stops in a group where it gives way, nor enters one without room beyond it, behind
/// whoever leads or merges ahead.
/// GUARD-004 It can be stopped behind a leader who brakes as hard as can be, as our box is turned, and while our box comes over
/// to the path, behind whoever leads where it still is; behind one that stands in another lane where our box comes; behind a
/// cut-in, and beside one that stands askew, it only must not get worse. A vehicle ahead of its plan is judged from there.
/// GUARD-005 What is safe only by hard braking says so, and what is refused for one that cannot stop while we can. GUARD-006 A
/// licence used holds, for the ground it was given for, until we stand, for a plan that leaves that in time; used it is once we
/// cannot stop before the group any more, before the zone where the first comes. Whoever comes in sight after that and can stop
/// finds the ground taken. GUARD-007 Who cannot stay out of a zone any more leaves it no later than it was to, but brakes for one
/// that passes it where lanes merge. Who has come to a stand in a group may stand on, and where lanes merge sets off beside
/// nobody: only before, or behind, all of whoever is there. GUARD-008 Merging leaves room, in both orders, and should whoever leads
/// brake hard. Before it is begun nobody is asked to brake harder for it than in ordinary driving.
/// GUARD-009 A lane change leaves who is behind, who may gain speed until we are over the line, room to brake,
/// and begins only when who is ahead is ahead of all of us by then, braking as hard as can be.
/// Whoever stands there needs no such room: our box keeps off its. Once our box is in there, one behind it that lacks
/// room however we stop, driving on as we do, has broken the law or come out of nowhere: no plan leaves it less.
/// GUARD-010 Whoever drives only what passes, and else the last fail-safe, touches nobody who keeps to the
/// law. GUARD-011 Who entered a group by right may stand in it, short of one that comes after all and
/// before we were to be gone, where nobody comes who cannot stop for it; before one who has let us go, not for another who
/// has.
/// GUARD-012 Beyond the known ground (scene.hpp) there may be anybody: on each lane that leads in from there
/// somebody comes as fast as we were, and somebody as fast as may be who would have been listed were it nearer; in a lane
/// we change into as well; on our way out of it somebody brakes. Where there are more such lanes than can be followed,
/// somebody is everywhere. Whoever is nearer in that lane and stays out of a zone, leads us, or follows us, is in its way.
/// GUARD-013 Until a change has been made or given up for two seconds, who is behind in that lane keeps its room to brake: a plan
/// that goes back, until it has left that lane; its answer counts from when we came over.
///
/// \code
///   plan    ----+------------------------>
///   stop        '-----|                      the fail-safe brakes to a standstill at a legal place, or
///   clear   ----------[ zones ]------|       the plan itself goes through all zones of a group before
///               ^ the next plan, and one missed boundary                 anybody may be there
/// \endcode

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/occupancy/lane_reach.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/safety/legal_occupancy.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/along_path.hpp"

namespace s4tp::safety {

/// Stands for whoever may be beyond the known ground, where others have the index of an agent.
inline constexpr std::uint8_t kUnseen = 254;

/// Why a plan is refused.
enum class Cause : std::uint8_t {
  kNone = 0,  ///< it is not
  kNoPath,    ///< nothing is known of the way
  kRoadEnd,   ///< cannot stop before the road ends
  kLeader,    ///< cannot stop behind whoever is ahead
  kFollower,  ///< leaves whoever is behind, in a lane it comes into, no room to brake
  kZone,      ///< somebody may be in a conflict zone with us
  kNoRoom,    ///< would stand in a conflict zone
};

struct Verdict {
  Cause cause = Cause::kNone;
  std::uint8_t agent = 255;      ///< who is in the way, or kUnseen; 255: nobody
  float from_s = 0.0F;           ///< kZone: how soon it can be there
  float needed_s = 0.0F;         ///< kZone: until when we are there
  bool stops_short = false;      ///< the fail-safe stands in a group entered by right, short of who comes
  bool clears = false;           ///< the fail-safe is to go through a group of zones; else it stops
  std::uint8_t cleared_end = 0;  ///< those groups' zones are among [0, this) of the path
  bool only_we_can_stop =
      false;                ///< kZone: we before it, braking as hard as can be; who comes cannot any more
  float clear_s = 0.0F;     ///< when it has left the first of them
  FailSafe fail_safe = {};  ///< of a safe plan
  bool hard = false;  ///< safe only because the fail-safe brakes hard before a group nobody leaves to us yet
  [[nodiscard]] bool safe() const { return cause == Cause::kNone; }
};

/// All zones between two places where one can wait.
struct ZoneGroup {
  float entry_s_m = 0.0F;  ///< along the path, of our box centre
  float exit_s_m = 0.0F;
  float stop_s_m = 0.0F;   ///< where our centre stands to wait for it
  std::uint8_t first = 0;  ///< zones [first, end) of the path
  std::uint8_t end = 0;
  bool yields = false;   ///< somebody there goes before us
  float cap_mps = 0.0F;  ///< slowest bend or limit in it
};

class Guard {
 public:
  /// Looks at the scene once a cycle. \param start  where plans begin, `lead_s` after the scene's time.
  /// The scene must outlive the judging. Where looking takes too long nothing passes. \return what it took [WorkMeter's
  /// units]
  int look(const scene::Scene& scene, const TrajectoryPoint& start, float lead_s,
           const Parameters& parameters);

  /// \param path_index  of the ego path the trajectory follows \pre look() was called this cycle
  /// \note bounded work: steps + vehicles at the path's zones
  [[nodiscard]] Verdict judge(int path_index, const Trajectory& trajectory) const;

  /// What judging a plan on `path` takes at most [WorkMeter's units].
  [[nodiscard]] int judge_work(int path) const;

  /// Where plans on `path` begin: of our rear axle, along it.
  [[nodiscard]] float start_s_m(int path) const { return contexts_[path].start_s_m; }

  /// What commit() takes at most [WorkMeter's units].
  [[nodiscard]] int commit_work() const;
  /// Says which plan is in force from now on. While it goes through a group, whoever was to stay out of it
  /// when we entered still is: a licence used is not withdrawn half way.
  void commit(int path, const Verdict& verdict);
  /// Forgets what is in force.
  void reset() {
    latched_.clear();
    goes_through_ = stops_short_ = false;
    change_ = {};
    fail_safe_ = {};
  }

 private:
  static constexpr int kMostThreats = 32;  ///< of one path; more: the zone counts as taken
  static constexpr int kPaths = decltype(scene::Scene::ego_paths)::kCapacity;

  enum class ThreatKind : std::uint8_t {
    kTold,      ///< in the list
    kLicensed,  ///< the same, latched: only a plan that is out of the group in time counts on it
    kComes,     ///< unseen, as fast as may be
    kAlike,     ///< unseen, as fast as we are
  };
  /// A vehicle that may be in a zone of the path.
  struct Threat {
    std::uint8_t zone = 0;
    std::uint8_t agent = 0;  ///< or kUnseen: the one that comes first
    LaneIndex lane = kNoLaneIndex;
    ThreatKind kind = ThreatKind::kTold;
    ZoneOccupancy when;
  };
  /// Somebody in the lane of the path, ahead or behind.
  struct InLane {
    std::uint8_t agent = 255;
    std::int16_t lacks_cm = 0;  ///< behind us: of room to brake, however we stop
    float bumper_s_m = 0.0F;    ///< its rear bumper ahead of us, its front bumper behind us, at plan start
    float speed_mps = 0.0F;
  };
  using InLaneList = BoundedVector<InLane, 4>;
  /// Whoever is ahead, or beside us with its middle further on.
  struct Passing {
    std::uint8_t agent = 255;
    float stop_s_m = 0.0F;  ///< of its rear bumper after braking as hard as can be
    float speed_mps = 0.0F;
    float braking_mps2 = 1.0F;
    /// Rear bumper, at least, `time_s` after plan start.
    [[nodiscard]] float least_s_m(float time_s) const;
  };
  /// While our box is in a lane where others are not used to it, from plan start on [s].
  struct Between {
    float from_s = 0.0F;  ///< before 0: since then
    float until_s = occupancy::kNeverS;
  };
  /// What one path offers to all plans on it.
  struct PathContext {
    float start_s_m = 0.0F;        ///< of our rear axle at plan start
    float stop_s_m = 0.0F;         ///< where our centre stands if the fail-safe begins as soon as it can
    float front_m = 0.0F;          ///< from our centre, as our box is turned to the path at plan start
    float end_s_m = 0.0F;          ///< of the road
    float leader_stop_s_m = 0.0F;  ///< foremost place for our front bumper if who is ahead brakes hard
    std::uint8_t leader = 255;
    float leader_mps = 0.0F;
    Passing beside;              ///< our front stays behind it until a change is over the line
    bool changes = false;        ///< our box is, or comes, from another lane
    bool half_over = false;      ///< most of us is in the lane already
    bool settles = false;        ///< our lane, and a change is in force or made or given up just now
    float swing_right_m = 0.0F;  ///< beside the path's lane, left positive
    float swing_left_m = 0.0F;
    float fastest_mps = 0.0F;  ///< that anybody may drive in our lane
    InLaneList behind;         ///< only where `changes` or `settles`: those for whom we are new
    InLaneList on_way_over;    ///< ahead, where our box may be before it has come over to the path's strip
    BoundedVector<ZoneGroup, kMaxPathZones> groups;
    BoundedVector<Threat, kMostThreats> threats;
    std::uint16_t staying_out[kMaxPathZones] = {};  ///< of each zone; bit i: agent i leaves it to us
    bool too_many = false;
  };
  /// The lane change in force, until a while after it is made or given up: who is behind us then was not there to
  /// follow us (D4).
  struct Change {
    float side = 0.0F;           ///< 1: to the left, -1: to the right, 0: none
    bool over = false;           ///< we are in the lane it leads to
    std::uint32_t since_ms = 0;  ///< when it was in force last, or, once over, when it came over
  };
  /// A track that stays out of the ground we share with a lane, while we pass it.
  struct Latch {
    std::uint8_t track = 0;
    LaneIndex lane = kNoLaneIndex;
  };
  struct Own;

  void follow_change();
  /// For how long it has been in force, or we over [s], by plan start.
  [[nodiscard]] float changing_s() const;
  void look_at_path(int path_index);
  /// Whether a vehicle not in the path's strip is where our box is, or may be before it has come over to that. \param seen
  /// receives where
  [[nodiscard]] bool is_on_way_over(const scene::EgoPath& path, const PathContext& context, int agent,
                                    trajectory::OnPath& seen);
  /// From the line that the path is driven on to where our front or rear is: in a tight bend the front swings out of it.
  void find_swing(const scene::EgoPath& path, PathContext& context);
  /// Of many in a lane the nearest ones matter.
  static void keep_nearest(InLaneList& list, const InLane& other, float own_s_m);
  void find_groups(const scene::EgoPath& path, PathContext& context) const;
  void find_threats(const scene::EgoPath& path, const occupancy::LaneReach (&reach)[kMaxTracks],
                    PathContext& context);
  // guard_unseen.cpp
  void look_beyond(const occupancy::LaneReach (&reach)[kMaxTracks]);
  void expect_from(LaneIndex lane, float edge_s_m, const occupancy::LaneReach (&reach)[kMaxTracks]);
  void expect(scene::Agent& somebody, ThreatKind kind, const occupancy::LaneReach& anyhow,
              const occupancy::LaneReach& straight_on, const occupancy::LaneReach (&reach)[kMaxTracks]);
  [[nodiscard]] float unseen_mps(LaneIndex lane, ThreatKind kind) const;
  /// Of those unseen ones that may come into a zone the first, with what none of them can; where lanes merge a fast
  /// one and a slow one.
  static void add_unseen(const Threat& threat, bool merging, PathContext& context);
  void expect_everywhere();                        ///< in every zone, and beside us
  void expect_beside(PathContext& context) const;  ///< in the lane we change into, and nobody else there
  void expect_ahead(const scene::EgoPath& path, PathContext& context);
  [[nodiscard]] bool held_back(const PathContext& context, int zone, const scene::ConflictZone& ground,
                               const occupancy::LaneReach& straight_on,
                               const occupancy::LaneReach (&reach)[kMaxTracks], ZoneOccupancy& when) const;
  [[nodiscard]] bool is_behind(const ZoneOccupancy (&when)[kMaxTracks], int index) const;
  /// Whether the next group on it cannot be stopped before any more.
  [[nodiscard]] bool is_bound(int path) const;
  [[nodiscard]] bool is_latched(std::uint8_t track, LaneIndex lane) const;
  /// Whether it came in sight when we could not stay out of the group any more.
  [[nodiscard]] bool has_come_since(const scene::Agent& agent) const;
  [[nodiscard]] bool passes_group(const scene::EgoPath& path, const PathContext& context,
                                  const ZoneGroup& group, const Own& own, Verdict& verdict) const;
  [[nodiscard]] float half_length_m(const Threat& threat) const;
  /// From the centre of one that merges to where the zone ends, along the common lane.
  [[nodiscard]] float to_common_end_m(const Threat& threat) const;
  /// The same, from where it was seen last.
  [[nodiscard]] float seen_to_common_end_m(const Threat& threat) const;
  /// Whether it is in the merging zone, nearer to its end than we are.
  [[nodiscard]] bool is_ahead(const scene::ConflictZone& zone, const Threat& threat, const Own& own) const;
  /// Where our centre stands behind whoever merges before us, after it has braked as hard as can be.
  [[nodiscard]] float behind_s_m(const scene::ConflictZone& zone, const Threat& threat) const;
  [[nodiscard]] bool passes_threat(const scene::EgoPath& path, const PathContext& context,
                                   const Threat& threat, const Own& own, Verdict& verdict) const;
  /// Whether the fail-safe stands where nobody comes who cannot stop for it; unless `before_any`, nobody who has let us go.
  [[nodiscard]] bool stops_short(const scene::EgoPath& path, const PathContext& context,
                                 const ZoneGroup& group, const Own& own, bool before_any) const;
  /// Until the plan in force is to be out of its group, from plan start on.
  [[nodiscard]] float time_left_s() const;
  /// Whether a plan that cannot stay out of the group any more is out of it at most `late_s` later than it was to be.
  [[nodiscard]] bool leaves_in_time(const ZoneGroup& group, const Own& own, float late_s) const;
  /// Where our centre is before a plan brings our box to where the vehicle stands after braking as hard as can be.
  [[nodiscard]] float way_over_ends_s_m(std::uint8_t agent_index, const Trajectory& trajectory,
                                        const Own& own) const;
  /// What is left of the fail-safe in force.
  [[nodiscard]] FailSafe in_force() const;
  /// What is left between us and whoever is behind when it was least, or lacking if below 0.
  [[nodiscard]] float room_behind_m(const PathContext& context, const InLane& behind, const Own& own,
                                    const FailSafe& stop, const Between& between) const;
  static constexpr int kStopCount = 5;
  /// A fail-safe after a lane change. \pre 0 <= index < kStopCount; the last one is the one in force
  [[nodiscard]] FailSafe stop_after_change(int index) const;
  /// Sets what room whoever is behind lacks, whatever the fail-safe of a plan that drives on as we do. \param reaches_in_m  our box, into its lane
  void find_lacking(float reaches_in_m, PathContext& context) const;
  [[nodiscard]] bool followers_can_brake(const PathContext& context, const Trajectory& trajectory,
                                         const Own& own, const FailSafe& stop, const Between& between,
                                         Verdict& verdict) const;
  /// What a plan does beside a path.
  enum class Sideways : std::uint8_t {
    kReachesIn,  ///< our box comes into its lane
    kIsBack,     ///< all of it is in there
  };
  /// When it does; the horizon's end: not before.
  [[nodiscard]] float when_s(Sideways what, const scene::EgoPath& path, const Trajectory& trajectory,
                             const Own& own) const;

  const scene::Scene* scene_ = nullptr;
  const Parameters* parameters_ = nullptr;
  bool looked_ = false;
  int work_ = 0;  ///< of the look
  TrajectoryPoint start_;
  float lead_s_ = 0.0F;
  float ahead_m_ = 0.0F;   ///< of plan start, where we will be then as we drive now
  float centre_m_ = 0.0F;  ///< from our rear axle
  float front_m_ = 0.0F;
  PathContext contexts_[kPaths];
  BoundedVector<Latch, 2 * kMaxTracks> latched_;
  bool goes_through_ = false;      ///< the plan in force, a group of zones
  bool stops_short_ = false;       ///< ... but stops in it, short of somebody
  std::uint32_t free_ms_ = 0;      ///< when we could stay out of it last, or stood
  std::uint32_t clear_by_ms_ = 0;  ///< when it was to have left it, as we were bound to go on
  FailSafe fail_safe_;             ///< of the plan in force, from ...
  std::uint32_t start_ms_ = 0;     ///< ... its start
  Change change_;
};

}  // namespace s4tp::safety
