#ifndef S4TP_H
#define S4TP_H
/// The planner for callers in C: AUTOSAR components, FMI units, firmware that is not C++. Pure C99.
///
/// \code
///   static s4tp_block planner;                     // the caller's memory: no heap, no globals inside
///   static s4tp_lane_map map;  static s4tp_tracks tracks;  static s4tp_plan plan;
///
///   s4tp_init(&planner, NULL, NULL);               // NULL: default parameters
///   s4tp_clear_map(&map);  ... fill map ...        // again when the map changes
///   every 100 ms of vehicle time:
///     s4tp_input input = {now_ms, now_ms + 100, ego, &tracks, &map, &plan, 0};
///     s4tp_status status = s4tp_make_plan(&planner, &input, &plan, NULL);
///     plan holds from plan.start_ms on, for 3 s; s4tp_sample() reads it between its points
/// \endcode
///
/// Frames and units: ISO 8855 (x forward, y left, angles counter-clockwise); SI units, by suffix; positions
/// in one local frame whose origin is the caller's choice: keep it within 2 km, where a float resolves 0.1
/// mm. Angles lie in [-pi, pi]. Times are a 32-bit count of milliseconds that may wrap.
///
/// Contract of every function: bounded work and stack, no heap, no lock, no I/O, no errno. Blocks are
/// independent of each other; one block serves one call at a time. Pointers given are used during the call
/// only; text returned is constant and lives for ever. The caller's interrupts and threads must save the
/// floating-point registers and leave the rounding mode at nearest, denormals kept.
///
/// The caller links with the same floating-point calling convention, whatever its other flags; the identical
/// bits on every processor are made inside the library, and s4tp_init() refuses where they cannot be kept.

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Answers ---------------------------------------------------------------------------------------- */

/// What a call answers. Only S4TP_OK is success; those up to S4TP_STALE_TRACKS are the core's own.
typedef int32_t s4tp_status;
#define S4TP_OK 0
#define S4TP_NOT_INITIALIZED 1    ///< no successful s4tp_init() on this block, or the block was moved since
#define S4TP_INVALID_PARAMETER 2  ///< a parameter is not finite or outside its range
#define S4TP_ARITHMETIC 3         ///< this processor or build rounds, fuses or flushes where it must not
#define S4TP_INVALID_INPUT 4     ///< an input is not finite or outside its range; the plan is a stop, or none
#define S4TP_NO_LANE 5           ///< no lane under or before the car; the plan is minimum-risk
#define S4TP_NO_SAFE_PLAN 6      ///< every candidate was rejected; the plan is minimum-risk
#define S4TP_STALE_TRACKS 7      ///< the list is thrown away for its time; the plan is minimum-risk
#define S4TP_INVALID_ARGUMENT 8  ///< a null or misaligned pointer, an unknown name; nothing was written

/// API-001 The constant's name ("S4TP_OK"), or "unknown status".
const char* s4tp_status_name(s4tp_status status);

/* ---- Versions --------------------------------------------------------------------------------------- */

#define S4TP_API_VERSION 6  ///< of this header; compare with s4tp_get_versions().api once at start

typedef struct s4tp_versions {
  uint8_t api;         ///< of the library linked
  uint8_t wire;        ///< of its CAN messages
  uint8_t parameters;  ///< of the parameter table
  uint8_t weights;     ///< of the network on board; 0: none
} s4tp_versions;

/// API-002 The versions of the library linked.
s4tp_versions s4tp_get_versions(void);

/* ---- Parameters: vehicle, comfort, risk, scoring, RSS, safety, tracking ------------------------------- */

#define S4TP_MAX_PARAMETERS 96  ///< room for rows to come; how many there are: s4tp_parameter_count()

/// One value a row, in the table's order (docs/parameters.md). Fill with s4tp_default_parameters(), then
/// change by name.
typedef struct s4tp_parameters {
  float values[S4TP_MAX_PARAMETERS];
} s4tp_parameters;

/// One row of the table.
typedef struct s4tp_parameter_info {
  const char* name;  ///< "group.field", e.g. "vehicle.wheelbase_m"
  const char* unit;
  const char* meaning;
  float initial;
  float minimum;
  float maximum;
} s4tp_parameter_info;

/// API-003 Every row's default. \return S4TP_OK, S4TP_INVALID_ARGUMENT
s4tp_status s4tp_default_parameters(s4tp_parameters* parameters);

/// API-004 Changes one row; a value outside the row's range, or NaN, changes nothing.
/// \return S4TP_OK, S4TP_INVALID_PARAMETER, S4TP_INVALID_ARGUMENT
s4tp_status s4tp_set_parameter(s4tp_parameters* parameters, const char* name, float value);

/// API-004 Reads one row. \return S4TP_OK, S4TP_INVALID_ARGUMENT
s4tp_status s4tp_get_parameter(const s4tp_parameters* parameters, const char* name, float* value);

/// API-005 How many rows the table has.
int32_t s4tp_parameter_count(void);

/// API-005 Describes row `index`, 0 .. s4tp_parameter_count() - 1. \return S4TP_OK, S4TP_INVALID_ARGUMENT
s4tp_status s4tp_describe_parameter(int32_t index, s4tp_parameter_info* info);

/// API-006 CRC-32 (IEEE 802.3) over table version and the bits of every row: the number in every explanation,
/// log header and status frame. \return 0 for a null pointer
uint32_t s4tp_parameters_crc(const s4tp_parameters* parameters);

/* ---- What the planner is told ------------------------------------------------------------------------ */

#define S4TP_MAX_TRACKS 16
#define S4TP_MAX_LANES 64
#define S4TP_MAX_LANE_POINTS 12
#define S4TP_MAX_SUCCESSORS 3
#define S4TP_MAX_CONFLICTS 128

/// Our own car; the reference point is the middle of the rear axle.
typedef struct s4tp_ego {
  float x_m;  ///< |x|, |y| < 100 000
  float y_m;
  float heading_rad;
  float speed_mps;          ///< 0 .. 60; forward only
  float acceleration_mps2;  ///< -12 .. 12
  float yaw_rate_radps;     ///< -2 .. 2
  float steering_rad;       ///< road-wheel angle, left positive; -0.8 .. 0.8
} s4tp_ego;

/// Another vehicle; the reference point is the centre of its box.
typedef struct s4tp_track {
  uint8_t id;  ///< stays with the vehicle while it is tracked; vehicles that share one have no past
  float x_m;   ///< |x|, |y| < 100 000
  float y_m;
  float heading_rad;
  float speed_mps;          ///< 0 .. 60, along the heading
  float acceleration_mps2;  ///< -12 .. 12
  float yaw_rate_radps;     ///< -1.3 .. 1.3
  float length_m;           ///< 0.5 .. 25
  float width_m;            ///< 0.3 .. 3
} s4tp_track;

/// All vehicles around us at one instant. A vehicle missing from a list is coasted for a second, then dropped.
typedef struct s4tp_tracks {
  uint32_t time_ms;  ///< vehicle time of the list: at most 500 ms from now_ms, not before the last one's
  int32_t count;     ///< 0 .. S4TP_MAX_TRACKS; of more vehicles those of the least distance less 2 s of
                     ///< |their velocity - ours|: who can be near us soonest
  int32_t
      left_out;  ///< how many more there are, 0 or more: API-017 somebody legal may be anywhere where it is,
                 ///< by that, no sooner than any of `items`, and the plan reckons with that
  s4tp_track items[S4TP_MAX_TRACKS];
} s4tp_tracks;

#define S4TP_NO_LANE_INDEX (-1)

#define S4TP_LANE_OURS 0      ///< of our direction of travel
#define S4TP_LANE_OPPOSITE 1  ///< of oncoming traffic
#define S4TP_LANE_SHOULDER 2

/// One lane: its centre line, from start to end, and what the map says of it. Lane indices are slots of
/// s4tp_lane_map.lanes, S4TP_NO_LANE_INDEX or the slot of a present lane.
typedef struct s4tp_lane {
  uint8_t present;        ///< 0: the slot is free and the rest is not read
  uint8_t kind;           ///< S4TP_LANE_...
  uint8_t in_junction;    ///< connects lanes across a junction
  uint8_t on_route;       ///< leads to the goal, if need be after `changes_needed`
  int8_t changes_needed;  ///< lane changes to the route's lane: > 0 to the left
  int8_t left;            ///< neighbour of the same direction that may be changed to
  int8_t right;
  int8_t successors[S4TP_MAX_SUCCESSORS];  ///< lanes that continue this one
  uint8_t point_count;                     ///< 2 .. S4TP_MAX_LANE_POINTS; longer lanes are split
  float width_m;                           ///< above 0.5, below 20
  float speed_limit_mps;                   ///< 0 .. below 100
  float route_remaining_m;                 ///< from the start: how far the route goes on without a change
  float goal_distance_m;                   ///< from the start along the route to the goal
  float stop_line_m;                       ///< arc length to stop at; < 0: none
  float x_m[S4TP_MAX_LANE_POINTS];         ///< |x|, |y| < 100 000; at least 0.1 m of line
  float y_m[S4TP_MAX_LANE_POINTS];
} s4tp_lane;

#define S4TP_FIRST_YIELDS 0
#define S4TP_FIRST_HAS_PRIORITY 1
#define S4TP_FIRST_COME 2

/// Two lanes share ground: between entry and exit (arc lengths of a car's centre on each lane, entry <= exit,
/// within +-10 000) a car on the one may touch a car on the other.
typedef struct s4tp_conflict {
  int8_t first;  ///< lane index, present
  int8_t second;
  uint8_t priority;  ///< S4TP_FIRST_...
  float first_entry_m;
  float first_exit_m;
  float second_entry_m;
  float second_exit_m;
} s4tp_conflict;

/// The lanes within about 150 m. A lane keeps its slot while it stays in the map.
typedef struct s4tp_lane_map {
  s4tp_lane lanes[S4TP_MAX_LANES];
  int32_t lanes_left_out;  ///< how many more there are, 0 or more: who is on no lane may be on one of those
  int32_t conflict_count;  ///< 0 .. S4TP_MAX_CONFLICTS
  s4tp_conflict conflicts[S4TP_MAX_CONFLICTS];
} s4tp_lane_map;

/// API-007 Every slot free, with what a lane usually has: no links, no stop line, 3.2 m, 13.89 m/s. Start
/// from here: zeroed memory would link every lane to slot 0. \return S4TP_OK, S4TP_INVALID_ARGUMENT
s4tp_status s4tp_clear_map(s4tp_lane_map* map);

/* ---- What the planner answers ------------------------------------------------------------------------ */

#define S4TP_PLAN_POINTS 31
#define S4TP_PLAN_STEP_MS 100

#define S4TP_PLAN_NONE 0
#define S4TP_PLAN_DRIVE 1
#define S4TP_PLAN_MINIMUM_RISK 2  ///< comes to rest without leaving the lane where it can

#define S4TP_LANE_CHANGE_KEEP 0
#define S4TP_LANE_CHANGE_PREPARE 1   ///< the plan leads over, the car is still in its lane
#define S4TP_LANE_CHANGE_CROSSING 2  ///< the car is over the line, and may still go back
#define S4TP_LANE_CHANGE_FINISH 3    ///< more than half of it is over
#define S4TP_LANE_CHANGE_SETTLE 4    ///< made or given up; others get used to it

#define S4TP_REQUIRED_CHANGE_NONE 0
#define S4TP_REQUIRED_CHANGE_APPROACHING 1  ///< the route asks for a lane change
#define S4TP_REQUIRED_CHANGE_WAITING 2      ///< at rest at the last place for it

#define S4TP_ZONE_CLAIM_CONSIDERED 0  ///< the plan stays out of the next crossing
#define S4TP_ZONE_CLAIM_CLAIMED 1     ///< it leads in, its fail-safe stops before
#define S4TP_ZONE_CLAIM_COMMITTED 2   ///< its fail-safe passes
#define S4TP_ZONE_CLAIM_CLEARED 3     ///< it is passed
#define S4TP_ZONE_CLAIM_WITHDRAWN 4   ///< claimed, and given up

/// One instant of the plan; the reference point is the middle of the rear axle.
typedef struct s4tp_plan_point {
  float x_m;  ///< |x|, |y| <= 110 000
  float y_m;
  float heading_rad;        ///< -pi .. pi
  float speed_mps;          ///< 0 .. 100
  float acceleration_mps2;  ///< -13 .. 13
  float curvature_1pm;      ///< -2 .. 2, left positive; road-wheel angle = atan(wheelbase * curvature)
} s4tp_plan_point;

/// points[i] holds at start_ms + i * S4TP_PLAN_STEP_MS; every number in the range of its own comment. A
/// zeroed plan is S4TP_PLAN_NONE. There is no padding: the bytes of two plans are equal exactly when their
/// bits are.
typedef struct s4tp_plan {
  uint32_t kind;  ///< S4TP_PLAN_...
  uint32_t start_ms;
  float fail_safe_branch_s;  ///< 0 .. 3: with no new plan in force this long after the start, brake along the
                             ///< plan's path: the guard has shown that this is safe
  float fail_safe_braking_mps2;  ///< 0 .. 13
  uint8_t lane_change;           ///< S4TP_LANE_CHANGE_...; what was decided goes back with the running plan
  int8_t lane_change_side;       ///< 1: to the left, -1: to the right, 0: none
  uint8_t required_change;       ///< S4TP_REQUIRED_CHANGE_...
  uint8_t zone_claim;            ///< S4TP_ZONE_CLAIM_...
  uint16_t lane_change_ms;       ///< for how long that has been so; at most 60 000
  uint16_t required_change_ms;   ///< the same
  uint16_t zone_claim_ms;        ///< the same
  int16_t zone_lane;             ///< index of the lane crossed last in the group of zones claimed
  s4tp_plan_point points[S4TP_PLAN_POINTS];
} s4tp_plan;

#define S4TP_STAGE_COUNT 8
#define S4TP_REJECTION_COUNT 5
#define S4TP_NOBODY 255

#define S4TP_INTENT_ACCELERATE 0  ///< one of the fixed accelerations
#define S4TP_INTENT_STOP 1        ///< before a line, a zone or a standing vehicle
#define S4TP_INTENT_FOLLOW 2      ///< settle behind the leader
#define S4TP_INTENT_PREVIOUS 3    ///< go on with the running plan

/// A candidate that was considered: lower cost is better; a reward is negative.
typedef struct s4tp_choice {
  uint8_t path;    ///< 0: the lane we are in; others: neighbours
  uint8_t intent;  ///< S4TP_INTENT_...
  float acceleration_mps2;
  float cost_total;
  float cost_progress;
  float cost_speed;
  float cost_jerk;
  float cost_lateral;
  float cost_lane;
  float cost_risk;
} s4tp_choice;

/// Why the plan is what it is.
typedef struct s4tp_explanation {
  s4tp_status status;
  uint32_t parameters_crc;
  s4tp_choice chosen;                      ///< zeros for a minimum-risk plan
  s4tp_choice runner_up;                   ///< zeros when there was none
  uint8_t candidates;                      ///< how many were ranked
  uint8_t left_out;                        ///< how many more there was no allowance for
  uint8_t decisions;                       ///< how many were predicted with our plan in mind
  uint8_t rejected[S4TP_REJECTION_COUNT];  ///< how many for which reason: [0] unused, [1] infeasible,
                                           ///< [2] collision, [3] unsafe end, [4] left out
  uint8_t dominating_track;                ///< id of the vehicle whose risk is largest, or S4TP_NOBODY
  uint8_t dominating_step;                 ///< and the plan's point where it is
  uint8_t id_clashes;                      ///< vehicles whose ids were not their own: kept, under other ids
  uint8_t tracks_left_out;                 ///< vehicles beyond what list and planner have room for
  uint8_t lanes_left_out;                  ///< of the map
  uint8_t unseen;                          ///< 1: somebody we are not told of keeps us from going further
  uint16_t work[S4TP_STAGE_COUNT];         ///< work units used: scene, candidates, predict, rank, exact risk,
                                           ///< optimize, check, explain
} s4tp_explanation;

/* ---- The planner -------------------------------------------------------------------------------------- */

#define S4TP_BLOCK_BYTES 79872

/// The planner's whole memory, owned by the caller and opaque. Zeroed (as static memory is) or initialised
/// before any other call; not moved or copied afterwards; simply given up at the end.
typedef union s4tp_block {
  uint64_t alignment;
  unsigned char bytes[S4TP_BLOCK_BYTES];
} s4tp_block;

/// API-010 Checks arithmetic and parameters and forgets all history; may be called again at standstill.
/// \param parameters  null: the defaults
/// \param first_bad   null, or receives the first bad parameter's name on S4TP_INVALID_PARAMETER, else null
/// \return S4TP_OK, S4TP_ARITHMETIC, S4TP_INVALID_PARAMETER, S4TP_INVALID_ARGUMENT; without success the block
/// answers S4TP_NOT_INITIALIZED
s4tp_status s4tp_init(s4tp_block* block, const s4tp_parameters* parameters, const char** first_bad);

/// A snapshot of the world.
typedef struct s4tp_input {
  uint32_t now_ms;    ///< vehicle time of `ego`
  uint32_t start_ms;  ///< when the plan takes effect: now_ms .. now_ms + 200, usually the next boundary
  s4tp_ego ego;
  const s4tp_tracks* tracks;  ///< null: nobody seen
  const s4tp_lane_map* map;   ///< null: no map known
  const s4tp_plan* running;   ///< the plan in force as it was written, or null; may be the one to be written;
                              ///< one no planner with these parameters would write is invalid input
  uint8_t degraded;           ///< not 0: a source is doubtful; lower speed, no lane change
} s4tp_input;

/// One planning cycle.
/// \param explanation  null, or receives why
/// \return S4TP_OK                API-011 the same bits as the C++ planner's, on every processor
///         S4TP_NO_LANE, S4TP_NO_SAFE_PLAN, S4TP_STALE_TRACKS
///                                API-012 the plan is a minimum-risk manoeuvre that can be driven
///         S4TP_INVALID_INPUT     API-012 the same, and a map, list or running plan that is not as
///                                documented counts as none. API-016 It begins at the ego's own state; where
///                                that is not as documented, at the running plan's, else at the last valid
///                                one; where none ever was, the plan is S4TP_PLAN_NONE, all zeros
///         S4TP_NOT_INITIALIZED, S4TP_INVALID_ARGUMENT
///                                API-013 nothing is written
s4tp_status s4tp_make_plan(s4tp_block* block, const s4tp_input* input, s4tp_plan* plan,
                           s4tp_explanation* explanation);

/// API-014 The plan at `time_ms`, interpolated; before its start the first point, after its end the last one.
/// \return S4TP_OK, S4TP_INVALID_ARGUMENT
s4tp_status s4tp_sample(const s4tp_plan* plan, uint32_t time_ms, s4tp_plan_point* point);

/* ---- What the caller provides ------------------------------------------------------------------------- */

/// API-015 DEFINED BY THE CALLER. An invariant of the library itself is broken: stop or reset, do not return.
/// Bad input never leads here.
void s4tp_on_assertion(const char* expression, const char* file, int line);

#ifdef __cplusplus
}
#endif

#endif /* S4TP_H */
