// ECU and world as two processes on a vcan0 on which others send, too: forged commands, a flood, random frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "tests/machine/vcan_drive.hpp"
#include "tests/support/command_check.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the drive is the language of these tests

ecu::CommandCheck check_of(const std::vector<wire::Frame>& frames) {
  ecu::CommandCheck check;
  for (const wire::Frame& frame : frames) check.take(frame);
  check.end();
  return check;
}

// PROC-024, WORLD-002 Forged commands while the car drives. 500/s: those of this very drive again, intact
// (counter and echo are old), the same with full steering under the old CRC, and full braking with a CRC that
// fits and an echo of no tick there is. Now and then one with a 29-bit id, a remote one, a short one. What
// the car does, as its motion frames say, is to the bit what it does without them.
TEST_F(DriveOnVcan, ForgedCommandsNeverReachTheCar) {
  const std::vector<wire::Frame> recorded =
      only(frames_of_log(inside()), [](const wire::Frame& frame) { return frame.id == wire::kCommandId; });
  {
    std::ofstream log("forge.log");
    wire::LoggedFrame logged;
    std::snprintf(logged.interface, sizeof logged.interface, "vcan0");
    const auto write = [&](const wire::Frame& frame) {
      char line[wire::kCandumpLineSize];
      logged.frame = frame;
      logged.time_us += 2000;
      wire::format_candump(logged, line);
      log << line << '\n';
    };
    for (const wire::Frame& frame : recorded) {
      write(frame);
      wire::Command command;
      ASSERT_TRUE(wire::decode(frame, command));
      command.steering_rad = 0.5F;
      wire::Frame wrong_crc;
      ASSERT_TRUE(wire::encode(command, wrong_crc));
      wrong_crc.data[0] = frame.data[0];
      write(wrong_crc);
      command.acceleration_mps2 = -8.0F;
      command.tick = static_cast<std::uint16_t>(2048 + command.tick % 2048);  // the drive has fewer
      wire::Frame spoofed;
      ASSERT_TRUE(wire::encode(command, spoofed));
      spoofed.data[1] = frame.data[1];
      wire::e2e_seal(spoofed);
      write(spoofed);
    }
  }
  Process player("exec canplayer -l i -I forge.log >/dev/null");
  Process sender(
      "while :; do cansend vcan0 00000008#8087F389A066602B; cansend vcan0 008#R; cansend vcan0 008#8087; "
      "done");
  const Drive forged = drive("forged");
  (void)player.end_all(SIGTERM);
  (void)sender.end_all(SIGTERM);
  EXPECT_LE(forged.code, 1) << forged.said;
  const std::vector<wire::Frame> all = frames_of_log(forged.log);
  EXPECT_TRUE(same(only(all, is_of_world), only(frames_of_log(inside()), is_of_world)));
  const auto commands = std::count_if(all.begin(), all.end(),
                                      [](const wire::Frame& frame) { return frame.id == wire::kCommandId; });
  EXPECT_GT(commands, static_cast<long>(recorded.size()) + 500) << "too few were forged to show anything";
  std::cout << commands - static_cast<long>(recorded.size()) << " forged commands reached the world\n";
}

// A flood of other traffic, 1000 frames/s: the drive is the one without it.
TEST_F(DriveOnVcan, FloodOfOtherIdsChangesNothing) {
  const Process flood("exec cangen vcan0 -g 1 -I 555 -L 8 -D r");
  const Drive flooded = drive("flooded");
  EXPECT_LE(flooded.code, 1) << flooded.said;
  EXPECT_EQ(content(flooded.log), content(inside()));
}

// PROC-002, PROC-021, ECU-003 .. ECU-006 Random frames on every id of ours, 200/s each on the most important
// ones, whole and short: every tick is answered, every command is what a second gate would let through, modes
// change by the table, and the processes end in order. (Whether the car gets there is not the question: one
// random frame in 256 has a CRC that fits, and an ECU that misses three motion frames stops the car.) They
// begin with the first TICK frame: a forged sign of life would have the world begin before there is an ECU.
TEST_F(DriveOnVcan, RandomFramesOnOurIdsDegradeAtWorst) {
  char first_tick[40];
  std::snprintf(first_tick, sizeof first_tick, "candump -n 1 vcan0,%03X:7FF; ", wire::kTickId);
  std::string line = first_tick;
  for (const char* id : {"008", "010", "011", "012", "013", "014"})
    line += std::string("cangen vcan0 -g 5 -I ") + id + " -L 8 -D r & ";
  for (const wire::MessageInfo& message : wire::kMessages) {
    char id[4];
    std::snprintf(id, sizeof id, "%03X", message.id);
    line += std::string("cangen vcan0 -g 50 -I ") + id + " -L r -D r & ";
  }
  Listener listener;
  Process fuzz(line + "wait");
  const Drive fuzzed = drive("fuzzed", "", 40);
  (void)fuzz.end_all(SIGTERM);
  EXPECT_TRUE(fuzzed.code == 0 || fuzzed.code == 1 || fuzzed.code == 124) << fuzzed.code << '\n'
                                                                          << fuzzed.said;
  EXPECT_NE(fuzzed.said.find(" 0 unanswered"), std::string::npos) << fuzzed.said;
  EXPECT_NE(("\n" + fuzzed.said).find("\nECU: "), std::string::npos)
      << "the ECU process did not end in order\n"
      << fuzzed.said;
  const ecu::CommandCheck check = check_of(listener.frames());
  EXPECT_EQ(check.findings(), std::vector<std::string>{}) << fuzzed.said;
  EXPECT_GT(check.ticks(), 200);
  EXPECT_GE(check.commands(), check.ticks() - 1);
  std::cout << fuzzed.said;
}

}  // namespace
}  // namespace s4tp
