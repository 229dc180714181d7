// ECU and world as two processes on a real vcan0, beside can-utils. Runs as root in the machine
// (toolchain/vcan_machine.sh).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "firmware/gate/command_gate.hpp"
#include "firmware/wire/codec.hpp"
#include "tests/machine/vcan_drive.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the drive is the language of these tests

// PROC-014 The frames on a vcan are those inside one process; and candump has seen, in this order, what our
// log says. (Before its first command the ECU only says that it is there: not a part of the log.)
TEST_F(DriveOnVcan, CandumpSeesWhatWeLog) {
  Listener listener;
  const Drive vcan = drive("vcan");
  std::vector<wire::Frame> seen = listener.frames();
  EXPECT_LE(vcan.code, 1) << vcan.said;
  EXPECT_EQ(content(vcan.log), content(inside()));
  const auto first_command = std::find_if(
      seen.begin(), seen.end(), [](const wire::Frame& frame) { return frame.id == wire::kCommandId; });
  seen.erase(std::remove_if(seen.begin(), first_command,
                            [](const wire::Frame& frame) { return frame.id == wire::kVersionEcuId; }),
             first_command);
  EXPECT_GT(seen.size(), 4000U);
  EXPECT_TRUE(same(seen, frames_of_log(vcan.log)));
}

// PROC-014 canplayer plays the world's frames of a log at the log's own pace: an ECU beside it sends the same
// commands and plans the same (their digests).
TEST_F(DriveOnVcan, CanplayerGivesTheSamePlans) {
  {
    std::ifstream log(inside());
    std::ofstream world("world.log");
    for (std::string line; std::getline(log, line);) {
      wire::LoggedFrame logged;
      if (wire::parse_candump(line.data(), static_cast<int>(line.size()), logged) ==
              wire::CandumpResult::kFrame &&
          is_of_world(logged.frame)) {
        world << line << '\n';
      }
    }
  }
  Listener listener;
  Process ecu("exec " + kPrograms.string() + "/s4tp_ecu_process --bus vcan0 --silence 10 >ecu.txt 2>&1");
  until_heard("sff");
  EXPECT_EQ(Process("exec timeout 100 canplayer -I world.log >/dev/null").wait(), 0);
  EXPECT_EQ(ecu.wait(), 0) << content("ecu.txt");
  const auto decided = [](const wire::Frame& frame) {
    return frame.id == wire::kCommandId || frame.id == wire::kPlanDigestId;
  };
  const std::vector<wire::Frame> wanted = only(frames_of_log(inside()), decided);
  EXPECT_GT(wanted.size(), 650U);
  EXPECT_TRUE(same(only(listener.frames(), decided), wanted)) << content("ecu.txt");
}

// PROC-023 In real time, on a processor that is emulated: no promise on time, only that it says what became
// of it, and that no command is outside what the gate allows whatever the ECU had seen by then.
TEST_F(DriveOnVcan, RealtimeSaysHowLateItWas) {
  Listener listener;
  const Drive realtime = drive("realtime", "--realtime", 15);
  EXPECT_TRUE(realtime.code == 0 || realtime.code == 1 || realtime.code == 124) << realtime.said;
  EXPECT_NE(realtime.said.find("slips"), std::string::npos) << realtime.said;
  EXPECT_NE(realtime.said.find("for real time"), std::string::npos) << realtime.said;
  constexpr gate::Limits kLimits;
  int commands = 0;
  for (const wire::Frame& frame : listener.frames()) {
    wire::Command command;
    if (!wire::decode(frame, command)) continue;
    ++commands;
    EXPECT_LE(command.acceleration_mps2, kLimits.acceleration_max_mps2);
    EXPECT_GE(command.acceleration_mps2, -kLimits.braking_max_mps2);
    EXPECT_LE(std::abs(command.steering_rad), kLimits.steering_max_rad + 0.0001F);  // half a step of the wire
  }
  EXPECT_GT(commands, 100);
  std::cout << realtime.said;
}

}  // namespace
}  // namespace s4tp
