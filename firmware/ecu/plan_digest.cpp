#include "firmware/ecu/plan_digest.hpp"

#include <cstring>

#include "algo/core/crc32.hpp"
#include "algo/core/math.hpp"

namespace s4tp::ecu {
namespace {

constexpr int kPointFields = 6;

void fields(const TrajectoryPoint& point, float (&values)[kPointFields]) {
  values[0] = point.rear_axle.x_m;
  values[1] = point.rear_axle.y_m;
  values[2] = point.rear_axle.heading_rad;
  values[3] = point.speed_mps;
  values[4] = point.acceleration_mps2;
  values[5] = point.curvature_1pm;
}

std::uint32_t add(std::uint32_t crc, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return crc32_word(crc, bits);
}

}  // namespace

std::uint32_t plan_digest(const Plan& plan) {
  std::uint32_t crc = crc32_word(kCrc32Start, static_cast<std::uint32_t>(plan.kind));
  crc = crc32_word(crc, plan.start_ms);
  for (const TrajectoryPoint& point : plan.trajectory.points) {
    float values[kPointFields];
    fields(point, values);
    for (const float value : values) crc = add(crc, value);
  }
  crc = add(crc, plan.fail_safe.branch_s);
  crc = add(crc, plan.fail_safe.braking_mps2);
  const ManoeuvreState& state = plan.manoeuvre;
  crc = crc32_word(crc, static_cast<std::uint32_t>(state.lane_change) |
                            static_cast<std::uint32_t>(static_cast<std::uint8_t>(state.side)) << 8U |
                            static_cast<std::uint32_t>(state.required_change) << 16U |
                            static_cast<std::uint32_t>(state.zone_claim) << 24U);
  crc = crc32_word(crc, state.lane_change_ms | static_cast<std::uint32_t>(state.required_change_ms) << 16U);
  crc = crc32_word(crc, state.zone_claim_ms |
                            static_cast<std::uint32_t>(static_cast<std::uint16_t>(state.zone_lane)) << 16U);
  return ~crc;
}

bool is_finite(const Plan& plan) {
  for (const TrajectoryPoint& point : plan.trajectory.points) {
    float values[kPointFields];
    fields(point, values);
    for (const float value : values) {
      if (!s4tp::is_finite(value)) return false;
    }
  }
  return true;
}

}  // namespace s4tp::ecu
