// The ECU's process, with a scripted other end.

#include "sim_host/processes/ecu_process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "sim_host/processes/world_process.hpp"
#include "tests/support/fake_bus.hpp"
#include "tests/support/fake_kernel.hpp"
#include "tests/support/sealed_frames.hpp"

namespace s4tp::processes {
namespace {

using hal::linux_host::FakeBus;
using std::chrono::steady_clock;

struct EcuRun {
  std::atomic<bool> stop{false};
  std::ostringstream out;
  hal::linux_host::FakeKernel kernel;
  EcuProcessOptions options;
  EcuEnd end = EcuEnd::kStopped;
  void run(FakeBus& bus) {
    options.bus = "vcan0";
    options.kernel = &kernel;
    end = run_ecu(bus, options, out, stop);
  }
};

// PROC-012, PROC-013 A second without a tick: about ten times "I am there", nothing else, and it gives up.
TEST(EcuProcess, SaysThatItIsThere) {
  FakeBus bus;
  EcuRun run;
  run.options.wait_s = 1;
  run.run(bus);
  EXPECT_EQ(run.end, EcuEnd::kNothingHeard);
  EXPECT_GE(bus.sent.size(), 3U);  // fewer than ten on a busy machine
  EXPECT_LE(bus.sent.size(), 11U);
  for (const hal::CanFrame& frame : bus.sent) EXPECT_EQ(frame.id, wire::kVersionEcuId);
}

// PROC-010 One command a tick; after the last one the silence ends the drive.
TEST(EcuProcess, SilenceEndsTheDrive) {
  FakeBus bus;
  EcuRun run;
  run.options.silence_s = 1;
  wire::E2eSender sender;
  for (int i = 1; i <= 50; ++i) bus.incoming.push_back(tick_frame(i, sender));
  run.run(bus);
  EXPECT_EQ(run.end, EcuEnd::kSilence);
  int commands = 0;
  for (const hal::CanFrame& frame : bus.sent) commands += frame.id == wire::kCommandId ? 1 : 0;
  EXPECT_EQ(commands, 50);
}

// PROC-002, PROC-010 A tick that 300 random frames on our ids come before, then two of 700, as when planning
// took long: each is answered by a command that echoes its own number. (An ECU that takes 256 frames a tick
// and is handed more answers an earlier tick, and never catches up: to the world it is dead.)
TEST(EcuProcess, FloodDoesNotDelayTheAnswer) {
  FakeBus bus;
  EcuRun run;
  run.options.silence_s = 1;
  wire::E2eSender sender;
  unsigned random = 1;
  for (int i = 1; i <= 20; ++i) {
    const int flood = i == 10 ? 300 : i == 11 || i == 12 ? 700 : 0;
    for (int k = 0; k < flood; ++k) {
      hal::CanFrame frame;
      frame.id = wire::kMotionId;
      frame.length = 8;
      for (int byte = 0; byte < 8; ++byte)
        frame.data[byte] = static_cast<std::uint8_t>((random = random * 1664525U + 1013904223U) >> 24U);
      bus.incoming.push_back(frame);
    }
    bus.incoming.push_back(tick_frame(i, sender));
  }
  run.run(bus);
  std::vector<int> echoes;
  for (const hal::CanFrame& frame : bus.sent) {
    wire::Command command;
    if (frame.id == wire::kCommandId && wire::decode(to_wire(frame), command)) echoes.push_back(command.tick);
  }
  ASSERT_EQ(echoes.size(), 20U);
  EXPECT_EQ(echoes.front(), 0);  // the first TICK frame is not trusted yet
  for (int i = 2; i <= 20; ++i) EXPECT_EQ(echoes[static_cast<std::size_t>(i - 1)], i);
}

// PROC-011 Asked to stop, it stops within a tenth of a second, and says what it did.
TEST(EcuProcess, StopsWhenAsked) {
  FakeBus bus;
  EcuRun run;
  run.stop = true;
  run.run(bus);
  EXPECT_EQ(run.end, EcuEnd::kStopped);
  EXPECT_NE(run.out.str().find("ECU: 0 ticks"), std::string::npos);
}

int commands_in(const FakeBus& bus) {
  int commands = 0;
  for (const hal::CanFrame& frame : bus.sent) commands += frame.id == wire::kCommandId ? 1 : 0;
  return commands;
}

// PROC-015, PROC-010 Realtime: one TICK frame starts the ECU's timer; commands go on in the silence after it,
// until that ends the drive. Control asked for more than planning. The report says that neither was given.
TEST(EcuProcess, RealtimeTicksByItself) {
  FakeBus bus;
  EcuRun run;
  run.options.realtime = true;
  run.options.silence_s = 1;
  run.options.report = std::filesystem::path(testing::TempDir()) / "s4tp_ecu_realtime.json";
  wire::E2eSender sender;
  bus.incoming.push_back(tick_frame(1, sender));
  run.run(bus);
  EXPECT_EQ(run.end, EcuEnd::kSilence);
  EXPECT_GE(commands_in(bus), 2);
  EXPECT_LE(commands_in(bus), 101);
  std::sort(run.kernel.asked_priorities.begin(), run.kernel.asked_priorities.end());
  EXPECT_EQ(run.kernel.asked_priorities, (std::vector<int>{70, 80}));
  EXPECT_NE(run.out.str().find("SCHED_FIFO 80 for control: refused"), std::string::npos);
  EXPECT_NE(run.out.str().find("NOT FIT"), std::string::npos);
  const auto report = nlohmann::json::parse(std::ifstream(run.options.report));
  std::filesystem::remove(run.options.report);
  EXPECT_FALSE(report.at("fit"));
  EXPECT_EQ(report.at("wake_up_latency").at("count"), commands_in(bus));
  EXPECT_EQ(report.at("requests").size(), 3U);
}

// PROC-012, PROC-011 Realtime: no world and no stop sign wait for a tick.
TEST(EcuProcess, RealtimeWithoutAWorld) {
  FakeBus bus;
  EcuRun run;
  run.options.realtime = true;
  run.options.wait_s = 1;
  run.run(bus);
  EXPECT_EQ(run.end, EcuEnd::kNothingHeard);
  EXPECT_EQ(commands_in(bus), 0);
  EXPECT_GE(bus.sent.size(), 3U);
  EXPECT_LE(bus.sent.size(), 11U);

  EcuRun stopped;
  stopped.options.realtime = true;
  stopped.stop = true;
  stopped.run(bus);
  EXPECT_EQ(stopped.end, EcuEnd::kStopped);
}

}  // namespace
}  // namespace s4tp::processes
