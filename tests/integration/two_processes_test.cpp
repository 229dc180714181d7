// World and ECU as two processes of this machine, on buses every machine has. (On a vcan: tests/machine.)
#include "tests/support/two_processes.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/free_port.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the programs are the language of these tests

// PROC-014 All four scenarios: the log of the two processes is the log of the in-process drive, to the last
// byte.
TEST(RunCommand, TcpGivesTheSameFrames) {
  for (const std::string scenario : {"left_turn", "merge", "cruise", "overtake"}) {
    const fs::path log = scratch("tcp.log");
    Process run("s4tp_tool", {"run", "--bus", "slcan:tcp:127.0.0.1:" + test::free_port(), "--scenario",
                              folder_of(scenario), "--seed", "3", "--log", log, "--out", scratch("out"),
                              "--patience", "20"});
    EXPECT_LE(run.wait(), 1) << scenario;
    EXPECT_EQ(content(log), content(in_process(scenario, 3))) << scenario;
  }
}

// TELE-005 A live drive that is told to stop takes its shared memory with it.
TEST(RunCommand, LiveDriveLeavesNoMemoryBehind) {
  const fs::path memory = "/dev/shm/s4tp_live_" + std::to_string(getpid());
  Process run("s4tp_tool", {"run", "--live", "--telemetry", "/" + memory.filename().string(), "--out",
                            scratch("live").string()});
  for (int i = 0; i < 1200 && !fs::exists(memory); ++i) usleep(50'000);
  ASSERT_TRUE(fs::exists(memory));
  EXPECT_EQ(run.end(SIGTERM), 130);
  EXPECT_FALSE(fs::exists(memory));
}

// PROC-014, PROC-010 The two programs on their own, over a cable between two terminals; one is told nothing
// of the other.
TEST(TwoProcesses, TerminalsGiveTheSameFrames) {
  const Cable cable;
  const fs::path log = scratch("pty.log");
  Process ecu("s4tp_ecu_process", {"--bus", "slcan:pty:" + cable.ports[0], "--silence", "5"});
  Process world("s4tp_world_process", {"--bus", "slcan:tty:" + cable.ports[1] + "@2000000", "--scenario",
                                       folder_of("cruise"), "--seed", "3", "--log", log, "--patience", "20"});
  EXPECT_LE(world.wait(), 1);
  EXPECT_EQ(ecu.wait(), 0);
  EXPECT_EQ(frames_of(log), frames_of(in_process("cruise", 3)));
}

// PROC-022 The ECU process is killed in the middle of a drive that has begun: the world says so and ends,
// with code 1.
TEST(TwoProcesses, KilledEcuIsReported) {
  const std::string port = test::free_port();
  const fs::path log = scratch("killed.log");
  Process world("s4tp_world_process", {"--bus", "slcan:listen:127.0.0.1:" + port, "--realtime", "--wait-ecu",
                                       "60", "--log", log, "--out", scratch("out")});
  Process ecu("s4tp_ecu_process", {"--bus", "slcan:tcp:127.0.0.1:" + port, "--realtime"});
  for (int i = 0; i < 1200 && (!fs::exists(log) || fs::file_size(log) < 1000); ++i) usleep(50'000);
  EXPECT_EQ(ecu.end(SIGKILL), 128 + SIGKILL);
  EXPECT_EQ(world.wait(), 1);
  EXPECT_NE(content(scratch("out") / "run.json").find("\"ending\": \"dead ECU\""), std::string::npos);
}

// PROC-015, PROC-023, RT-022 Realtime, told to stop after a while: the exit code says so, and run.json of both sides how late they were.
TEST(RunCommand, RealtimeIsReported) {
  const fs::path log = scratch("realtime.log");
  Process run("s4tp_tool", {"run", "--bus", "slcan:tcp:127.0.0.1:" + test::free_port(), "--realtime", "--log",
                            log, "--out", scratch("realtime")});
  for (int i = 0; i < 1200 && (!fs::exists(log) || fs::file_size(log) < 10'000); ++i) usleep(50'000);
  EXPECT_EQ(run.end(SIGTERM), 130);
  const auto json = nlohmann::json::parse(content(scratch("realtime") / "run.json"));
  for (const char* const side : {"world", "ecu"})
    EXPECT_GT(json.at("realtime").at(side).at("wake_up_latency").at("count"), 10) << side;
}

// PROC-020 No ECU: code 2, and nothing on the bus.
TEST(TwoProcesses, NoEcuIsReported) {
  Process world("s4tp_world_process",
                {"--bus", "slcan:listen:127.0.0.1:" + test::free_port(), "--wait-ecu", "1"});
  EXPECT_EQ(world.wait(), 2);
}

// PROC-011, PROC-012 A bus that cannot be opened is code 2, one on which nothing happens 1, being told to
// stop 0.
TEST(TwoProcesses, EcuExitCodes) {
  EXPECT_EQ(Process("s4tp_ecu_process", {"--bus", "slcan:tty:/dev/ttyS0@115200"}).wait(), 2);
  EXPECT_EQ(Process("s4tp_ecu_process", {"--bus", "slcan:tcp:127.0.0.1:" + test::free_port(), "--wait", "1"})
                .wait(),
            1);
  Process ecu("s4tp_ecu_process", {"--bus", "slcan:tcp:127.0.0.1:" + test::free_port()});
  ecu.until_it_can_be_told();
  EXPECT_EQ(ecu.end(SIGTERM), 0);
}

}  // namespace
}  // namespace s4tp
