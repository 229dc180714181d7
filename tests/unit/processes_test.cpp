// The world's process, with a scripted other end.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
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

const scenario::Scenario& left_turn() {
  static const scenario::Scenario scenario = scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) /
                                                                     "sim_host" / "scenarios" / "left_turn");
  return scenario;
}

/// Answers every TICK frame with a command to drive on gently.
struct ScriptedEcu {
  FakeBus& bus;
  wire::E2eSender sender;
  int ticks = 0;
  int answers_until = 1'000'000;
  std::function<void(int tick)> beside;  ///< what else comes, before the answer

  explicit ScriptedEcu(FakeBus& on) : bus(on) {
    bus.incoming.push_back(hello());
    bus.on_send = [this](const hal::CanFrame& frame) {
      if (frame.id != wire::kTickId) return;
      wire::Tick tick;
      EXPECT_TRUE(wire::decode(to_wire(frame), tick));
      ++ticks;
      if (beside) beside(tick.tick);
      if (ticks <= answers_until)
        bus.incoming.push_back(command(ticks == 1 ? 0 : tick.tick, 0.3F, 0.0F, sender));
    };
  }
  static hal::CanFrame command(int echo, float acceleration_mps2, float steering_rad, wire::E2eSender& with) {
    wire::Command message;
    message.tick = static_cast<std::uint16_t>(echo & 0xFFF);
    message.acceleration_mps2 = acceleration_mps2;
    message.steering_rad = steering_rad;
    message.mode = 2;
    return sealed(message, with);
  }
};

struct WorldRun {
  std::atomic<bool> stop{false};
  std::ostringstream out;
  hal::linux_host::FakeKernel kernel;
  WorldProcessOptions options;
  WorldProcessResult result;
  double seconds = 0.0;

  void run(FakeBus& bus) {
    options.bus = "vcan0";
    options.seed = 3;
    options.kernel = &kernel;
    const auto start = steady_clock::now();
    result = run_world(left_turn(), bus, options, out, stop);
    seconds = std::chrono::duration<double>(steady_clock::now() - start).count();
  }
};

bool same_drive(const traffic::Recording& a, const traffic::Recording& b) {
  bool same = a.ending == b.ending && a.snapshots.size() == b.snapshots.size();
  for (std::size_t i = 0; same && i < a.snapshots.size(); ++i) {
    same = a.snapshots[i].ego.centre.x == b.snapshots[i].ego.centre.x &&
           a.snapshots[i].ego.centre.y == b.snapshots[i].ego.centre.y &&
           a.snapshots[i].ego.speed_mps == b.snapshots[i].ego.speed_mps &&
           a.snapshots[i].ego_steering_rad == b.snapshots[i].ego_steering_rad;
  }
  return same;
}

// PROC-020, PROC-021 Each tick is answered, so lock-step runs as fast as it can: 13 s of driving in far less.
TEST(WorldProcess, LockStep) {
  FakeBus bus;
  ScriptedEcu ecu(bus);
  WorldRun run;
  run.run(bus);
  EXPECT_TRUE(run.result.met_ecu);
  EXPECT_EQ(run.result.ticks, ecu.ticks);
  EXPECT_GT(run.result.ticks, 300);
  EXPECT_EQ(run.result.unanswered, 0);
  EXPECT_EQ(run.result.refused_commands, 0);
  EXPECT_NE(run.result.recording.ending, traffic::Ending::kRunning);
  EXPECT_NE(run.result.recording.ending, traffic::Ending::kDeadEcu);
  EXPECT_LT(run.seconds, 5.0);
}

// PROC-020 Nobody there: nothing is driven; told sooner when the ECU's process has ended.
TEST(WorldProcess, NoEcu) {
  FakeBus bus;
  WorldRun run;
  run.options.wait_s = 1;
  run.run(bus);
  EXPECT_FALSE(run.result.met_ecu);
  EXPECT_TRUE(bus.sent.empty());
  EXPECT_GE(run.seconds, 1.0);

  WorldRun ended;
  ended.options.wait_s = 100;
  ended.options.ecu_lives = [] { return false; };
  ended.run(bus);
  EXPECT_FALSE(ended.result.met_ecu);
  EXPECT_LT(ended.seconds, 1.0);
}

// PROC-022, PROC-021 The ECU falls silent after 400 ticks: two ticks of 1 s without an answer, then it is
// dead.
TEST(WorldProcess, DeadEcu) {
  FakeBus bus;
  ScriptedEcu ecu(bus);
  ecu.answers_until = 400;
  steady_clock::time_point silent;
  ecu.beside = [&](int tick) {
    if (tick == 401) silent = steady_clock::now();
  };
  WorldRun run;
  run.run(bus);
  EXPECT_EQ(run.result.recording.ending, traffic::Ending::kDeadEcu);
  EXPECT_EQ(run.result.unanswered, 2);
  EXPECT_EQ(run.result.ticks, 402);
  EXPECT_NEAR(std::chrono::duration<double>(steady_clock::now() - silent).count(), 2.0, 1.0);
  EXPECT_NE(run.out.str().find("dead"), std::string::npos);
}

// PROC-021 One answer lost costs a second of host time, not the drive.
TEST(WorldProcess, OneAnswerLost) {
  FakeBus bus;
  ScriptedEcu ecu(bus);
  bool lost = false;
  ecu.beside = [&](int tick) {
    ecu.answers_until = tick == 400 ? 0 : 1'000'000;
    lost = lost || tick == 400;
  };
  WorldRun run;
  run.run(bus);
  EXPECT_TRUE(lost);
  EXPECT_EQ(run.result.unanswered, 1);
  EXPECT_NE(run.result.recording.ending, traffic::Ending::kDeadEcu);
}

// PROC-024 Beside every answer come commands to steer hard left: with a wrong CRC; with a right one, as
// recorded 30 ticks ago; the last one once more. The car drives as without them, to the bit.
TEST(WorldProcess, ForgedCommandsNeverReachTheCar) {
  WorldRun clean;
  {
    FakeBus bus;
    ScriptedEcu ecu(bus);
    clean.run(bus);
  }
  FakeBus bus;
  ScriptedEcu ecu(bus);
  wire::E2eSender forger;
  int forged = 0;
  ecu.beside = [&](int tick) {
    hal::CanFrame wrong_crc = ScriptedEcu::command(tick, -3.0F, 0.5F, forger);
    wrong_crc.data[0] ^= 0x55;
    bus.incoming.push_back(wrong_crc);
    if (tick <= 30) return;
    bus.incoming.push_back(ScriptedEcu::command(tick - 30, -3.0F, 0.5F, forger));
    bus.incoming.push_back(ScriptedEcu::command(tick - 1, -3.0F, 0.5F, forger));
    forged += 3;
  };
  WorldRun run;
  run.run(bus);
  EXPECT_GT(forged, 900);
  EXPECT_GE(run.result.refused_commands, forged);
  EXPECT_TRUE(same_drive(run.result.recording, clean.result.recording));
}

// PROC-022 The link is down for half a second: no time passes for the car, and the ECU is not called dead.
TEST(WorldProcess, LinkDownStopsTime) {
  FakeBus bus;
  ScriptedEcu ecu(bus);
  std::optional<steady_clock::time_point> down;
  ecu.beside = [&](int tick) {
    if (tick != 400) return;
    down = steady_clock::now();
    bus.link = hal::CanState::kDown;
    bus.news.post(hal::linux_host::LinkNews::kDown);
    ecu.answers_until = 0;
  };
  bus.on_wait = [&] {
    if (!down || steady_clock::now() < *down + std::chrono::milliseconds(500)) return;
    bus.link = hal::CanState::kActive;
    ecu.answers_until = 1'000'000;
  };
  WorldRun run;
  run.run(bus);
  EXPECT_EQ(run.result.unanswered, 1);
  EXPECT_NE(run.result.recording.ending, traffic::Ending::kDeadEcu);
  EXPECT_NE(run.out.str().find("vcan0: down"), std::string::npos);  // PROC-003
}

// PROC-022 The link goes down and stays so: an ECU whose link never comes back is dead, like one that is silent.
TEST(WorldProcess, LinkThatStaysDownIsADeadEcu) {
  FakeBus bus;
  ScriptedEcu ecu(bus);
  WorldRun run;
  run.options.link_back_within_ms = 100;
  run.options.dead_after_ms = 300;
  std::optional<steady_clock::time_point> down;
  ecu.beside = [&](int tick) {
    if (tick != 400) return;
    down = steady_clock::now();
    bus.link = hal::CanState::kDown;
    ecu.answers_until = 0;
  };
  bus.on_wait = [&] { run.stop = down && steady_clock::now() > *down + std::chrono::seconds(5); };
  run.run(bus);
  EXPECT_EQ(run.result.recording.ending, traffic::Ending::kDeadEcu);
  EXPECT_FALSE(run.stop);
}

// PROC-023 Sixty ticks take 0.59 s and no less, though the ECU never answers. It asked for priority, was
// refused, and says so.
TEST(WorldProcess, RealtimeKeepsItsPace) {
  FakeBus bus;
  ScriptedEcu ecu(bus);
  ecu.answers_until = 0;
  WorldRun run;
  run.options.realtime = true;
  ecu.beside = [&](int tick) { run.stop = tick >= 60; };
  run.run(bus);
  EXPECT_EQ(run.result.ticks, 60);
  EXPECT_GE(run.seconds, 0.59);
  ASSERT_TRUE(run.result.timing);
  EXPECT_EQ(run.result.timing->wake_ups.count(), 60U);
  EXPECT_EQ(run.kernel.asked_priorities, std::vector<int>{60});
  std::ostringstream told;
  print_link(told, run.options, run.result, bus);
  EXPECT_NE(told.str().find("NOT FIT"), std::string::npos);
}

// PROC-024 Realtime: an answer up to 10 ticks late counts, one that is later does not.
TEST(WorldProcess, RealtimeRefusesOldCommands) {
  for (const int delay : {9, 12}) {
    FakeBus bus;
    ScriptedEcu ecu(bus);
    ecu.answers_until = 1;  // the first one, then late ones
    WorldRun run;
    run.options.realtime = true;
    int late = 0;
    ecu.beside = [&](int tick) {
      run.stop = tick >= 40;
      if (tick <= delay + 1) return;
      bus.incoming.push_back(ScriptedEcu::command(tick - delay, 0.3F, 0.0F, ecu.sender));
      ++late;
    };
    run.run(bus);
    EXPECT_GT(late, 20);
    // The last one comes after the last look.
    EXPECT_EQ(run.result.refused_commands, delay == 9 ? 0 : late - 1) << delay;
  }
}

}  // namespace
}  // namespace s4tp::processes
