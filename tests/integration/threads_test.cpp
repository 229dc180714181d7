// Both contexts on threads of their own, and world and ECU side by side in one process. What matters is what
// the thread sanitizer says of it: ./s4tp test runs this under it.
#include <gtest/gtest.h>

#include <atomic>
#include <sstream>
#include <thread>
#include <vector>

#include "firmware/can/frames.hpp"
#include "hal/sim/bus.hpp"
#include "hal/sim/null_devices.hpp"
#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/processes/ecu_process.hpp"
#include "sim_host/processes/world_process.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/bus_pair.hpp"
#include "tests/support/drive_time.hpp"
#include "tests/support/fake_kernel.hpp"

namespace s4tp {
namespace {

constexpr std::uint64_t kSeed = 3;

traffic::Recording drive_on_one_thread(const scenario::Scenario& scenario) {
  campaign::EpisodeOptions options;
  options.seed = kSeed;
  return campaign::run_episode(scenario, options).recording;
}

void expect_same_drive(const traffic::Recording& a, const traffic::Recording& b) {
  EXPECT_EQ(a.ending, b.ending);
  ASSERT_EQ(a.snapshots.size(), b.snapshots.size());
  for (std::size_t i = 0; i < a.snapshots.size(); ++i) {
    ASSERT_EQ(a.snapshots[i].ego.centre.x, b.snapshots[i].ego.centre.x) << i;
    ASSERT_EQ(a.snapshots[i].ego.centre.y, b.snapshots[i].ego.centre.y) << i;
    ASSERT_EQ(a.snapshots[i].ego_steering_rad, b.snapshots[i].ego_steering_rad) << i;
  }
}

struct ThreadedDrive {
  traffic::Recording recording;
  int ticks = 0;
  std::uint32_t slips = 0;
};

/// Planning in a thread of its own. Control goes on for five ticks beside it and then waits, so that every
/// plan is there at its boundary; only each `late_one`-th is not waited for until the boundary has passed.
ThreadedDrive drive_on_two_threads(const scenario::Scenario& scenario, int late_one) {
  hal::sim::Bus bus;
  hal::sim::Bus::Port* const world_port = bus.attach();
  hal::sim::Bus::Port* const ecu_port = bus.attach();
  hal::sim::NullCycleCounter cycles;
  hal::sim::NullWatchdog watchdog;
  const auto ecu =
      baselines::make_ecu("s4tp", true, Parameters{}, {ecu_port, &cycles, &watchdog, nullptr}, nullptr);
  std::atomic<bool> done{false};
  std::atomic<bool> hold{false};
  std::thread planning([&] {
    while (!done) {
      if (!hold && ecu->planning_due()) ecu->planning_cycle();
      std::this_thread::yield();
    }
  });

  world::WorldOptions options;
  options.seed = kSeed;
  world::World world(scenario, options);
  std::vector<wire::Frame> frames;
  ThreadedDrive result;
  int snapshots = 0;
  int busy_ticks = 0;
  while (!world.finished()) {
    frames.clear();
    world.tick(frames);
    ++result.ticks;
    for (const wire::Frame& frame : frames) (void)world_port->send(to_hal(frame));
    ecu->control_tick();
    for (hal::CanFrame frame; world_port->receive(frame);) world.receive(to_wire(frame));
    if (!ecu->planning_due()) {
      busy_ticks = 0;
      hold = false;  // a cycle that had begun before it was to be held
      continue;
    }
    if (++busy_ticks == 1) ++snapshots;
    const bool late = late_one > 0 && snapshots % late_one == 0;
    hold = late && busy_ticks < 15;
    if (busy_ticks < (late ? 15 : 5)) continue;
    while (ecu->planning_due()) std::this_thread::yield();
    busy_ticks = 0;
  }
  done = true;
  planning.join();
  result.slips = ecu->core().statistics().slips;
  result.recording = world.recording();
  return result;
}

// ECU-075 Two threads drive as one does, to the bit: whatever a plan's computation takes, it takes effect at
// its boundary. Two scenarios.
TEST(Threads, DriveAsOneThreadDoes) {
  for (const std::string name : {"left_turn", "merge"}) {
    const scenario::Scenario scenario = tests::shipped_for(name);
    const ThreadedDrive drive = drive_on_two_threads(scenario, 0);
    EXPECT_EQ(drive.slips, 0U);
    expect_same_drive(drive.recording, drive_on_one_thread(scenario));
    EXPECT_GT(drive.ticks, 500);
  }
}

// ECU-076 Each seventh cycle begins late and is still busy at its boundary: misses are counted, and the car
// drives on to an end of its own.
TEST(Threads, MissedDeadlines) {
  const ThreadedDrive drive =
      drive_on_two_threads(tests::shipped_for("left_turn", 2.5 * tests::kDriven_s), 7);
  EXPECT_GT(drive.slips, 5U);
  EXPECT_NE(drive.recording.ending, traffic::Ending::kDeadEcu);
  EXPECT_GT(drive.ticks, 1000);
}

/// run_world() here, run_ecu() on another thread.
struct SideBySide {
  hal::linux_host::FakeKernel kernel;
  std::ostringstream world_out;
  std::ostringstream ecu_out;
  std::atomic<bool> stop_world{false};
  processes::WorldProcessResult world;
  processes::EcuEnd ecu_end = processes::EcuEnd::kStopped;

  void run(const scenario::Scenario& scenario, bool realtime, int seconds) {
    hal::linux_host::BusPair bus;
    processes::WorldProcessOptions world_options;
    world_options.bus = "memory";
    world_options.seed = kSeed;
    world_options.realtime = realtime;
    world_options.wait_for_answers(20);  // lock-step: this machine may be busy
    world_options.kernel = &kernel;
    processes::EcuProcessOptions ecu_options;
    ecu_options.bus = "memory";
    ecu_options.realtime = realtime;
    ecu_options.kernel = &kernel;
    std::atomic<bool> stop_ecu{false};
    std::thread ecu([&] { ecu_end = processes::run_ecu(bus.ecu, ecu_options, ecu_out, stop_ecu); });
    std::thread watch([&] {
      for (int i = 0; i < seconds * 10 && !stop_ecu; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      stop_world = true;
    });
    world = processes::run_world(scenario, bus.world, world_options, world_out, stop_world);
    stop_ecu = true;
    ecu.join();
    watch.join();
  }
};

// PROC-014, PROC-021 Lock-step: the drive of the in-process episode, to the bit.
TEST(Threads, SideBySideInLockStep) {
  const scenario::Scenario scenario = tests::shipped_for("cruise");
  SideBySide both;
  both.run(scenario, false, 200);
  EXPECT_EQ(both.world.unanswered, 0);
  expect_same_drive(both.world.recording, drive_on_one_thread(scenario));
}

// PROC-015, PROC-023 Realtime, three threads for 5 s: the ECU's own timer answers the world's, and both
// report. How well they were on time is this machine's matter.
TEST(Threads, SideBySideInRealTime) {
  SideBySide both;
  both.run(tests::shipped_for("left_turn"), true, 5);
  EXPECT_TRUE(both.world.met_ecu);
  EXPECT_GT(both.world.ticks - both.world.unanswered, 10);
  ASSERT_TRUE(both.world.timing);
  EXPECT_EQ(both.world.timing->wake_ups.count(), static_cast<std::uint32_t>(both.world.ticks));
  EXPECT_NE(both.ecu_out.str().find("planning:"), std::string::npos) << both.ecu_out.str();
  EXPECT_EQ(both.ecu_end, processes::EcuEnd::kStopped);
}

}  // namespace
}  // namespace s4tp
