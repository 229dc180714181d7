#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {
namespace {

wire::Frame any_frame() {
  wire::Frame frame;
  frame.id = *rc::gen::inRange<std::uint32_t>(0x08, 0x34);
  frame.length = *rc::gen::inRange(0, 10) == 0 ? *rc::gen::inRange<std::uint8_t>(0, 9) : std::uint8_t{8};
  for (std::uint8_t& byte : frame.data) byte = *rc::gen::arbitrary<std::uint8_t>();
  if (*rc::gen::inRange(0, 4) != 0) wire::e2e_seal(frame);  // sealed nonsense gets further
  return frame;
}

bool inside_the_ranges(const planner::PlannerInput& input) {
  const auto within = [](float value, float low, float high) { return value >= low && value <= high; };
  bool good = within(input.ego.speed_mps, 0.0F, 60.0F) &&
              within(input.ego.acceleration_mps2, -12.0F, 12.0F) &&
              within(input.ego.yaw_rate_radps, -2.0F, 2.0F) && within(input.ego.steering_rad, -0.8F, 0.8F) &&
              std::isfinite(input.ego.rear_axle.x_m) && std::isfinite(input.ego.rear_axle.y_m) &&
              within(input.ego.rear_axle.heading_rad, -3.1416F, 3.1416F);
  for (const Track& track : input.tracks) {
    good = good && within(track.speed_mps, 0.0F, 60.0F) && within(track.acceleration_mps2, -12.0F, 12.0F) &&
           within(track.yaw_rate_radps, -1.3F, 1.3F) && within(track.length_m, 0.5F, 25.0F) &&
           within(track.width_m, 0.3F, 3.0F) && std::isfinite(track.centre.x_m) &&
           std::isfinite(track.centre.y_m);
  }
  return good && input.now_ms <= input.start_ms && input.start_ms <= input.now_ms + 100;
}

// ECU-062 ECU-063 ECU-010: sound traffic, in which anything at all is mixed in, left out, damaged or
// repeated: the ECU sends one sound command a tick inside the limits of the wire, and the planner never sees
// a value outside its ranges.
TEST(EcuFrames, AnythingMayBeOnTheBus) {
  EXPECT_TRUE(rc::check([] {
    Rig rig;
    RC_ASSERT(rig.start() == Status::kOk);
    rig.plant.speed_mps = 5.0;
    bool good = true;
    rig.ecu.planner().make = [&good](const planner::PlannerInput& input, Plan& plan) {
      good = good && inside_the_ranges(input);
      for (TrajectoryPoint& point : plan.trajectory.points) point.rear_axle = input.ego.rear_axle;
    };
    rig.engage = *rc::gen::inRange(0, 2) == 0;
    const int calm = *rc::gen::inRange(0, 130);
    rig.ticks(calm);
    rig.engage = true;
    const int stir = *rc::gen::inRange(1, 60);
    for (int i = 0; i < stir; ++i) {
      rig.motion = *rc::gen::inRange(0, 8) != 0;
      rig.steering = *rc::gen::inRange(0, 8) != 0;
      rig.pose = *rc::gen::inRange(0, 8) != 0;
      rig.tracks = *rc::gen::inRange(0, 3) != 0;
      rig.map = *rc::gen::inRange(0, 3) != 0;
      rig.driver_override = *rc::gen::inRange(0, 60) == 0;
      rig.interval_ms =
          *rc::gen::inRange(0, 20) == 0 ? *rc::gen::arbitrary<std::uint16_t>() : std::uint16_t{10};
      if (*rc::gen::inRange(0, 25) == 0) rig.ecu.inject_deadline_miss();
      const int extra = *rc::gen::inRange(0, 12);
      for (int k = 0; k < extra; ++k) rig.send(any_frame());
      const std::uint32_t before_ms = rig.ecu.core().now_ms();
      rig.tick();
      RC_ASSERT(rig.ecu.core().now_ms() >= before_ms);
      int commands = 0;
      for (const wire::Frame& frame : rig.from_ecu) {
        commands += frame.id == wire::kCommandId && wire::e2e_crc_fits(frame) ? 1 : 0;
      }
      RC_ASSERT(commands == 1);
      RC_ASSERT(rig.command.acceleration_mps2 <= 3.5F && rig.command.acceleration_mps2 >= -9.0F);
      RC_ASSERT(std::abs(rig.command.steering_rad) <= 0.551F);
    }
    RC_ASSERT(good);
  }));
}

// A burst of more frames than a tick takes (256) is worked off in the ticks that follow; none is lost.
TEST(EcuFrames, BurstIsWorkedOff) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  wire::Frame foreign;
  foreign.id = 0x7FF;
  foreign.length = 8;
  for (int i = 0; i < 400; ++i) rig.send(foreign);
  rig.tick();
  EXPECT_EQ(rig.ecu.core().inputs().accepted_frames(), 256U);
  rig.ticks(3);
  EXPECT_EQ(rig.ecu_port->counters().dropped, 0U);
  EXPECT_EQ(rig.ecu_port->counters().received, rig.ecu.core().inputs().accepted_frames());
}

}  // namespace
}  // namespace s4tp::ecu
