#include "firmware/ecu/plan_digest.hpp"

#include <cstring>

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

class Crc32 {
 public:
  void add(std::uint32_t word) {
    for (unsigned nibble = 0; nibble < 8; ++nibble) {
      crc_ = (crc_ >> 4U) ^ kTable[(crc_ ^ (word >> (4U * nibble))) & 0x0FU];
    }
  }
  [[nodiscard]] std::uint32_t value() const { return ~crc_; }

 private:
  /// Remainders of the 16 nibbles, polynomial 0xEDB88320.
  static constexpr std::uint32_t kTable[16] = {
      0x00000000U, 0x1DB71064U, 0x3B6E20C8U, 0x26D930ACU, 0x76DC4190U, 0x6B6B51F4U, 0x4DB26158U, 0x5005713CU,
      0xEDB88320U, 0xF00F9344U, 0xD6D6A3E8U, 0xCB61B38CU, 0x9B64C2B0U, 0x86D3D2D4U, 0xA00AE278U, 0xBDBDF21CU};
  std::uint32_t crc_ = 0xFFFFFFFFU;
};

}  // namespace

std::uint32_t plan_digest(const Plan& plan) {
  Crc32 crc;
  crc.add(static_cast<std::uint32_t>(plan.kind));
  crc.add(plan.start_ms);
  for (const TrajectoryPoint& point : plan.trajectory.points) {
    float values[kPointFields];
    fields(point, values);
    for (const float value : values) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof(bits));
      crc.add(bits);
    }
  }
  const float fail_safe[] = {plan.fail_safe.branch_s, plan.fail_safe.braking_mps2};
  for (const float value : fail_safe) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    crc.add(bits);
  }
  return crc.value();
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
