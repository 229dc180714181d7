#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstring>

#include "firmware/gate/command_gate.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::gate {
namespace {

/// Any bit pattern: NaN, infinities and denormals among them; or something near the limits.
float any_float() {
  if (*rc::gen::inRange(0, 3) == 0) {
    const auto bits = *rc::gen::arbitrary<std::uint32_t>();
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  return static_cast<float>(*rc::gen::inRange(-1200, 1200)) * 0.01F;
}

/// A motion frame: sound, damaged, or any bytes at all.
wire::Frame any_frame(wire::E2eSender& sender) {
  wire::Frame frame;
  const int kind = *rc::gen::inRange(0, 10);
  if (kind == 0) {
    frame.id = *rc::gen::inRange<std::uint32_t>(0, 0x40);
    frame.length = *rc::gen::inRange<std::uint8_t>(0, 9);
    for (std::uint8_t& byte : frame.data) byte = *rc::gen::arbitrary<std::uint8_t>();
    return frame;
  }
  wire::Motion motion;
  motion.speed_mps = static_cast<float>(*rc::gen::inRange(0, 8000)) * 0.01F;
  motion.acceleration_mps2 = static_cast<float>(*rc::gen::inRange(-2000, 2000)) * 0.01F;
  RC_ASSERT(wire::encode(motion, frame));
  sender.protect(frame);
  if (kind == 1) frame.data[*rc::gen::inRange(0, 8)] ^= 0x10U;
  return frame;
}

// GATE-001 to GATE-010: whatever is heard and asked for, what comes out is finite, inside every limit, and no
// further from the last output than a tick allows; at too much lateral acceleration it goes back at full
// rate.
TEST(GateProperty, OutputIsAlwaysInsideTheLimits) {
  EXPECT_TRUE(rc::check([] {
    const Limits limits;
    CommandGate gate(limits);
    wire::E2eSender sender;
    Command last;
    const int steps = *rc::gen::inRange(1, 300);
    for (int i = 0; i < steps; ++i) {
      double speed_mps = -1.0;
      if (*rc::gen::inRange(0, 4) != 0) {
        const wire::Frame frame = any_frame(sender);
        gate.observe(frame);
        wire::Motion motion;
        if (frame.id == wire::kMotionId && wire::e2e_crc_fits(frame) && wire::decode(frame, motion)) {
          speed_mps = double{motion.speed_mps};
        }
      }
      if (*rc::gen::inRange(0, 30) == 0) {
        const float steering_rad = any_float();
        gate.reset(steering_rad);
        last.steering_rad = std::isfinite(steering_rad) && std::abs(steering_rad) <= 1e6F
                                ? std::clamp(steering_rad, -0.55F, 0.55F)
                                : 0.0F;
        last.acceleration_mps2 = 100.0F;  // the gate's own reading: not judged here
      }
      Command command{any_float(), any_float()};
      const bool permitted = *rc::gen::inRange(0, 3) != 0;
      const Violations violations = gate.apply(permitted, command);
      RC_ASSERT(std::isfinite(command.acceleration_mps2) && std::isfinite(command.steering_rad));
      RC_ASSERT(command.acceleration_mps2 <= limits.acceleration_max_mps2);
      RC_ASSERT(command.acceleration_mps2 >= -limits.braking_max_mps2);
      RC_ASSERT(command.acceleration_mps2 <= last.acceleration_mps2 + 0.2F + 1e-5F);
      RC_ASSERT(std::abs(command.steering_rad) <= limits.steering_max_rad);
      const double turned_rad = std::abs(double{command.steering_rad} - double{last.steering_rad});
      RC_ASSERT(turned_rad <= 0.007 + 1e-6);
      if (speed_mps > double{limits.speed_max_mps}) RC_ASSERT(command.acceleration_mps2 <= 0.0F);
      const double lateral_mps2 =
          speed_mps * speed_mps * std::tan(std::abs(double{command.steering_rad})) / 2.9;
      if (speed_mps > 0.0 && lateral_mps2 > 6.0 + 1e-3) RC_ASSERT(turned_rad >= 0.007 - 1e-6);
      if (!permitted) RC_ASSERT((violations & kDenied) != 0);
      if ((violations & (kDenied | kMotionStale)) != 0)
        RC_ASSERT(command.acceleration_mps2 <= last.acceleration_mps2 + 0.2F + 1e-5F);
      last = command;
    }
  }));
}

}  // namespace
}  // namespace s4tp::gate
