#pragma once
/// Whether what the senders say agrees with physics, with each other and with what was commanded: the answer
/// to a lie under a valid CRC, which end-to-end protection cannot find. Knows no planner.
///
/// \code
///   Motion --- speed against the sum of acceleration                 Steering --- against what was commanded
///     |  \---- yaw rate against speed x curvature ------------------------'
///     |------- speed and yaw rate, summed up, against Pose ---------- Pose --- against the lanes of the map
///     '------- stamps against the count of ticks
/// \endcode
/// Each check has a residual and one row of limits (plausibility.cpp). Sums are leaky: they forget within the
/// row's memory, so that an honest sensor's bias stays below the limit for ever and a lie does not. What each
/// lie costs until it is seen, and which ones no check of this kind can see: docs/plausibility.md.

#include <cstdint>

#include "algo/core/geometry.hpp"
#include "algo/core/parameters.hpp"
#include "firmware/ecu/modes.hpp"
#include "firmware/ecu/vehicle_clock.hpp"
#include "firmware/gate/command_gate.hpp"
#include "firmware/wire/lane_map.hpp"

namespace s4tp::ecu {

/// What was told in one tick, as it stood on the wire: not brought to any bounds.
struct Measured {
  std::uint32_t passed_ms = 0;  ///< of vehicle time since the tick before
  float speed_mps = 0.0F;
  float acceleration_mps2 = 0.0F;
  float yaw_rate_radps = 0.0F;
  float steering_rad = 0.0F;
  Pose rear_axle;       ///< of this instant
  bool known = false;   ///< motion, steering and a pose have arrived
  bool motion = false;  ///< new in this tick
  bool pose = false;    ///< rear_axle comes from a pose that is new in this tick
};

/// What the actuators were asked for in the tick before.
struct Commanded {
  gate::Command command;
  bool active = false;  ///< it may reach them
};

enum class Check : std::uint8_t {
  kRange,                ///< PLAUS-001 a value no car on a road has
  kSpeedAcceleration,    ///< PLAUS-002 speed against the sum of acceleration
  kPoseAlong,            ///< PLAUS-003 pose against the sum of speed along the heading
  kPoseAcross,           ///< PLAUS-004 the same across it
  kPoseHeading,          ///< PLAUS-005 heading against the sum of yaw rate
  kYawSteering,          ///< PLAUS-006 yaw rate against speed times the steering's curvature
  kSteeringCommand,      ///< PLAUS-007 steering against what was commanded, at once or late
  kAccelerationCommand,  ///< PLAUS-008 acceleration against what was commanded
  kSpeedFrozen,          ///< PLAUS-009 speed stays 0 while drive is commanded
  kOffMap,               ///< PLAUS-010 rear axle outside every lane while driving
  kClock,                ///< PLAUS-011 stamps against the count of ticks
};
inline constexpr int kCheckCount = 11;

/// A check's limits: `ticks` in a row with a residual above base + per_speed v + per_lateral |v yaw rate|.
struct PlausibilityLimit {
  Check check;
  float base;         ///< unit of the residual: m, rad, m/s, rad/s, m/s^2, ms; range: 1 is the bound itself
  float per_speed;    ///< unit per m/s
  float per_lateral;  ///< unit per m/s^2
  std::uint16_t ticks;
  FaultBit fault;
};
/// \pre 0 <= index < kCheckCount; row i is check i
[[nodiscard]] const PlausibilityLimit& plausibility_limit(int index);

class PlausibilityMonitor {
 public:
  /// Once a tick. PLAUS-012 Sums start anew with the first whole tick, and are bounded at ten times their
  /// limit at rest: once a lie has ended, so does its fault, within 5 s, though the car has braked since and
  /// its limits are tighter.
  /// \param map  newest whole one, null: none
  void update(const Measured& measured, const Commanded& commanded, const wire::Map* map,
              const Parameters& parameters);

  [[nodiscard]] Faults faults() const { return faults_; }
  [[nodiscard]] bool failed(Check check) const;
  /// Of the last tick, as a share of its limit.
  [[nodiscard]] float share(Check check) const { return shares_[static_cast<int>(check)]; }

 private:
  void sum_motion(const Measured& measured, float passed_s);
  void sum_pose(const Measured& measured, float passed_s);
  void model_actuators(const Measured& measured, const Commanded& commanded, const Parameters& parameters,
                       float passed_s);
  void judge(Check check, float residual, const Measured& measured);
  void judge_sum(Check check, float& sum, const Measured& measured);

  float speed_sum_mps_ = 0.0F;
  float last_speed_mps_ = 0.0F;
  Pose reckoned_;
  float since_pose_s_ = 0.0F;
  float along_sum_m_ = 0.0F;
  float across_sum_m_ = 0.0F;
  float heading_sum_rad_ = 0.0F;
  float lateral_mps2_ = 0.0F;  ///< |v yaw rate|, falling with the pose sums' memory
  float yaw_error_radps_ = 0.0F;
  float steering_model_rad_ = 0.0F;
  float drive_model_mps2_ = 0.0F;
  float clock_sum_ms_ = 0.0F;
  float off_map_m_ = 0.0F;
  float shares_[kCheckCount] = {};
  std::uint16_t ticks_[kCheckCount] = {};  ///< in a row above the limit
  std::uint16_t tick_ = 0;
  Faults faults_ = 0;
  bool started_ = false;
};

/// How far a point lies outside every lane; 0 on one. Lanes go on straight for 10 m at both ends.
[[nodiscard]] float outside_lanes_m(const wire::Map& map, Point point);

}  // namespace s4tp::ecu
