#include "firmware/ecu/plausibility.hpp"

#include "algo/core/check.hpp"
#include "algo/core/math.hpp"

namespace s4tp::ecu {
namespace {

constexpr float kMotionMemoryS = 1.0F;  // of the sum of acceleration
constexpr float kPoseMemoryS = 2.0F;    // of the sums of speed and yaw rate
constexpr float kClockMemoryS = 2.0F;
constexpr float kYawFilterS = 0.2F;
constexpr float kShortestMapReachM = 10.0F;
constexpr std::uint16_t kMapEveryTicks = 10;
constexpr std::uint32_t kLongestTickMs = 100;  // longer ones are a gap: nothing is known of it
constexpr float kClockStepMs = 5.0F;           // a single late tick is the platform's, not a clock's rate
constexpr float kSumMaxBases = 10.0F;          // PLAUS-012: forgotten in 2 s * ln 10, whatever the limit was
constexpr float kMovingMps = 0.3F;
constexpr float kFrozenMps = 0.05F;
constexpr float kDriveMps2 = 0.4F;  // a car asked for so much moves
// What a car on a road can do at most; beyond it a value is not measured but made up.
constexpr float kSpeedMaxMps = 70.0F;
constexpr float kAccelerationMaxMps2 = 12.0F;
constexpr float kSteeringSlackRad = 0.05F;

// Residuals of honest sensors: a speed 2 % off, a yaw rate 0.01 rad/s off, a steering 0.01 rad off, an
// accelerometer on a slope of 10 %, and what tyres add in a bend.
constexpr PlausibilityLimit kLimits[kCheckCount] = {
    {Check::kRange, 1.0F, 0.0F, 0.0F, 2, FaultBit::kMotionImplausible},
    {Check::kSpeedAcceleration, 1.2F, 0.01F, 0.0F, 2, FaultBit::kMotionImplausible},
    {Check::kPoseAlong, 0.5F, 0.04F, 0.0F, 4, FaultBit::kPoseImplausible},
    {Check::kPoseAcross, 0.3F, 0.03F, 0.25F, 4, FaultBit::kPoseImplausible},
    {Check::kPoseHeading, 0.04F, 0.0F, 0.005F, 4, FaultBit::kPoseImplausible},
    {Check::kYawSteering, 0.08F, 0.006F, 0.03F, 15, FaultBit::kMotionImplausible},
    {Check::kSteeringCommand, 0.06F, 0.0F, 0.0F, 15, FaultBit::kSteeringImplausible},
    {Check::kAccelerationCommand, 2.0F, 0.0F, 0.1F, 50, FaultBit::kMotionImplausible},
    {Check::kSpeedFrozen, 0.5F, 0.0F, 0.0F, 40, FaultBit::kMotionImplausible},
    {Check::kOffMap, 1.0F, 0.0F, 0.0F, 20, FaultBit::kPoseImplausible},
    {Check::kClock, 100.0F, 0.0F, 0.0F, 2, FaultBit::kClockImplausible},
};

float kept(float passed_s, float memory_s) {
  return max(0.0F, 1.0F - passed_s / memory_s);
}

/// A first-order lag.
void follow(float& model, float target, float passed_s, float lag_s) {
  model = lag_s > passed_s ? model + passed_s / lag_s * (target - model) : target;
}

/// Squared distance from a segment, which goes on at its ends where the lane ends.
float distance2_m2(Point from, Point to, bool first, bool last, Point point) {
  const Point along = to - from;
  const float length2 = dot(along, along);
  if (length2 <= 0.0F) return dot(point - from, point - from);
  const float reach = kShortestMapReachM / sqrt(length2);
  const float t =
      clamp(dot(point - from, along) / length2, first ? -reach : 0.0F, last ? 1.0F + reach : 1.0F);
  const Point off{point.x_m - from.x_m - t * along.x_m, point.y_m - from.y_m - t * along.y_m};
  return dot(off, off);
}

}  // namespace

const PlausibilityLimit& plausibility_limit(int index) {
  S4TP_ASSERT(index >= 0 && index < kCheckCount);
  return kLimits[index];
}

float outside_lanes_m(const wire::Map& map, Point point) {
  constexpr float kFarM = 1.0e4F;
  float least_m = kFarM;
  for (const wire::Lane& lane : map.lanes) {
    if (!lane.present) continue;
    for (int i = 0; i + 1 < lane.point_count; ++i) {
      const Point from{lane.x_m[i], lane.y_m[i]};
      const Point to{lane.x_m[i + 1], lane.y_m[i + 1]};
      const float distance_m = sqrt(distance2_m2(from, to, i == 0, i + 2 == lane.point_count, point));
      least_m = min(least_m, distance_m - 0.5F * lane.width_m);
    }
  }
  return max(0.0F, least_m);
}

void PlausibilityMonitor::judge(Check check, float residual, const Measured& measured) {
  const int index = static_cast<int>(check);
  const PlausibilityLimit& row = kLimits[index];
  const float limit = row.base + row.per_speed * measured.speed_mps + row.per_lateral * lateral_mps2_;
  shares_[index] = residual / limit;
  if (shares_[index] <= 1.0F) {
    ticks_[index] = 0;
  } else if (ticks_[index] < row.ticks) {
    ++ticks_[index];
  }
  if (failed(check)) faults_ |= bit(row.fault);
}

bool PlausibilityMonitor::failed(Check check) const {
  const int index = static_cast<int>(check);
  return ticks_[index] >= kLimits[index].ticks;
}

void PlausibilityMonitor::judge_sum(Check check, float& sum, const Measured& measured) {
  const float most = kSumMaxBases * kLimits[static_cast<int>(check)].base;
  sum = clamp(sum, -most, most);
  judge(check, abs(sum), measured);
}

void PlausibilityMonitor::sum_motion(const Measured& measured, float passed_s) {
  if (measured.motion) {
    speed_sum_mps_ = kept(passed_s, kMotionMemoryS) * speed_sum_mps_ + measured.speed_mps - last_speed_mps_ -
                     measured.acceleration_mps2 * passed_s;
    last_speed_mps_ = measured.speed_mps;
    const float late_ms = 1000.0F * passed_s - static_cast<float>(kTickMs);
    clock_sum_ms_ =
        kept(passed_s, kClockMemoryS) * clock_sum_ms_ + clamp(late_ms, -kClockStepMs, kClockStepMs);
  }
  judge_sum(Check::kSpeedAcceleration, speed_sum_mps_, measured);
  judge_sum(Check::kClock, clock_sum_ms_, measured);
}

void PlausibilityMonitor::sum_pose(const Measured& measured, float passed_s) {
  const float turned_rad = measured.yaw_rate_radps * passed_s;
  const float middle_rad = reckoned_.heading_rad + 0.5F * turned_rad;
  const float way_m = max(0.0F, measured.speed_mps - 0.5F * measured.acceleration_mps2 * passed_s) * passed_s;
  reckoned_.x_m += way_m * cos(middle_rad);
  reckoned_.y_m += way_m * sin(middle_rad);
  reckoned_.heading_rad = wrap_angle(reckoned_.heading_rad + turned_rad);
  since_pose_s_ += passed_s;
  if (measured.pose) {
    const float share = kept(since_pose_s_, kPoseMemoryS);
    const Point off{measured.rear_axle.x_m - reckoned_.x_m, measured.rear_axle.y_m - reckoned_.y_m};
    const Point ahead{cos(reckoned_.heading_rad), sin(reckoned_.heading_rad)};
    along_sum_m_ = share * along_sum_m_ + off.x_m * ahead.x_m + off.y_m * ahead.y_m;
    across_sum_m_ = share * across_sum_m_ + off.y_m * ahead.x_m - off.x_m * ahead.y_m;
    heading_sum_rad_ =
        share * heading_sum_rad_ + wrap_angle(measured.rear_axle.heading_rad - reckoned_.heading_rad);
    reckoned_ = measured.rear_axle;
    since_pose_s_ = 0.0F;
  }
  judge_sum(Check::kPoseAlong, along_sum_m_, measured);
  judge_sum(Check::kPoseAcross, across_sum_m_, measured);
  judge_sum(Check::kPoseHeading, heading_sum_rad_, measured);
}

void PlausibilityMonitor::model_actuators(const Measured& measured, const Commanded& commanded,
                                          const Parameters& parameters, float passed_s) {
  if (!commanded.active) {
    steering_model_rad_ = measured.steering_rad;
    drive_model_mps2_ = measured.acceleration_mps2;
  } else {
    follow(steering_model_rad_, commanded.command.steering_rad, passed_s,
           parameters.tracking.steering_delay_s);
    follow(drive_model_mps2_, commanded.command.acceleration_mps2, passed_s,
           parameters.tracking.drive_delay_s);
  }
  // The wheels lag by less than the delay, which has the tyres' share in it: they are between both.
  const float asked_rad = commanded.active ? commanded.command.steering_rad : measured.steering_rad;
  const float low_rad = min(steering_model_rad_, asked_rad);
  const float high_rad = max(steering_model_rad_, asked_rad);
  judge(Check::kSteeringCommand, abs(measured.steering_rad - clamp(measured.steering_rad, low_rad, high_rad)),
        measured);
  const bool moves = measured.speed_mps > kMovingMps;
  judge(Check::kAccelerationCommand, moves ? abs(measured.acceleration_mps2 - drive_model_mps2_) : 0.0F,
        measured);
  const bool frozen = commanded.active && measured.speed_mps < kFrozenMps && drive_model_mps2_ > kDriveMps2;
  judge(Check::kSpeedFrozen, frozen ? 1.0F : 0.0F, measured);
}

void PlausibilityMonitor::update(const Measured& measured, const Commanded& commanded, const wire::Map* map,
                                 const Parameters& parameters) {
  if (!measured.known) return;
  if (!started_ || measured.passed_ms > kLongestTickMs) {
    started_ = true;
    last_speed_mps_ = measured.speed_mps;
    reckoned_ = measured.rear_axle;
    steering_model_rad_ = measured.steering_rad;
    drive_model_mps2_ = measured.acceleration_mps2;
    return;
  }
  faults_ = 0;
  const float passed_s = 0.001F * static_cast<float>(measured.passed_ms);
  const float lateral_mps2 = abs(measured.speed_mps * measured.yaw_rate_radps);
  lateral_mps2_ = max(min(lateral_mps2, kAccelerationMaxMps2), kept(passed_s, kPoseMemoryS) * lateral_mps2_);

  const float steering_max_rad = parameters.vehicle.steering_max_rad + kSteeringSlackRad;
  float range = max(measured.speed_mps / kSpeedMaxMps, abs(measured.steering_rad) / steering_max_rad);
  range = max(range, max(abs(measured.acceleration_mps2), lateral_mps2) / kAccelerationMaxMps2);
  judge(Check::kRange, range, measured);
  sum_motion(measured, passed_s);
  sum_pose(measured, passed_s);

  const float turned_radps = measured.speed_mps *
                             tan(clamp(measured.steering_rad, -steering_max_rad, steering_max_rad)) /
                             parameters.vehicle.wheelbase_m;
  follow(yaw_error_radps_, measured.yaw_rate_radps - turned_radps, passed_s, kYawFilterS);
  judge(Check::kYawSteering, abs(yaw_error_radps_), measured);
  model_actuators(measured, commanded, parameters, passed_s);

  if (!commanded.active || map == nullptr) {
    off_map_m_ = 0.0F;
  } else if (tick_ % kMapEveryTicks == 0) {
    off_map_m_ = outside_lanes_m(*map, position(measured.rear_axle));
  }
  judge(Check::kOffMap, off_map_m_, measured);
  tick_ = static_cast<std::uint16_t>((tick_ + 1U) % kMapEveryTicks);
}

}  // namespace s4tp::ecu
