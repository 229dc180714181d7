// A drive whose ECU has its objects and its map over DDS alone: the programs a user starts, world apart.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hal/linux/named_bus.hpp"
#include "sim_host/processes/child_process.hpp"
#include "sim_host/processes/input_link.hpp"
#include "sim_host/processes/world_process.hpp"
#include "sim_host/telemetry/watch.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "tests/dds/input_publisher.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/test_memory.hpp"

namespace s4tp::telemetry {
namespace {

using namespace std::chrono_literals;
using tests::message_of;
using tests::Publisher;
using tests::wait_for;

constexpr int kTicksMax = 10'000;

/// A perception stack as far as the ECU can tell: what the world says on the bus of objects and lanes, over DDS.
class Perception {
 public:
  void hear(const std::vector<wire::Frame>& frames) {
    bool new_list = false;
    for (const wire::Frame& frame : frames) {
      new_list = tracks_.accept(frame) || new_list;
      map_known_ = map_.accept(frame) || map_known_;
    }
    Arena arena;
    if (new_list) publisher_.tell(message_of(tracks_.tracks(), arena));
    if (map_known_ && ++ticks_ % 10 == 0) publisher_.tell(message_of(map_.map(), arena));
  }
  [[nodiscard]] bool heard() const { return publisher_.heard(); }

 private:
  Publisher publisher_;
  wire::TrackListReceiver tracks_;
  wire::MapReceiver map_;
  bool map_known_ = false;
  int ticks_ = 0;
};

struct Driven {
  processes::WorldProcessResult world;
  int plans = 0;  ///< that drive
  int most_vehicles = 0;
  int most_lanes = 0;
};

/// The left turn of seed 3 at the pace of the clock, with s4tp_ecu_process and s4tp-telemetry.
/// \param perception  null: nothing is told over DDS, while all of it is on the bus
Driven drive(Perception* perception, int most_ticks) {
  const std::string memory = tests::test_memory("input_drive");
  const std::string programs = std::string(S4TP_BINARY_DIR) + "/sim_host/";
  const std::string bus_port = test::free_port();
  const std::string link_port = test::free_port();
  hal::linux_host::NamedBus bus;
  hal::linux_host::Reason reason;
  EXPECT_TRUE(bus.open(("slcan:listen:127.0.0.1:" + bus_port).c_str(), {}, reason)) << reason.text;
  processes::ChildProcess ecu({programs + "s4tp_ecu_process", "--bus", "slcan:tcp:127.0.0.1:" + bus_port,
                               "--input", "slcan:listen:127.0.0.1:" + link_port, "--telemetry", memory});
  processes::ChildProcess telemetry({programs + "s4tp-telemetry", "--ecu", memory, "--domain",
                                     std::to_string(tests::free_domain()), "--input",
                                     "slcan:tcp:127.0.0.1:" + link_port});
  EXPECT_TRUE(perception == nullptr || wait_for([&] { return perception->heard(); }));

  Driven driven;
  Watch watch(memory);
  std::atomic<bool> stop = false;
  int ticks = 0;
  auto next = std::chrono::steady_clock::now();
  processes::WorldProcessOptions options;
  options.bus = "slcan:listen:127.0.0.1:" + bus_port;
  options.seed = 3;
  options.wait_for_answers(20);
  options.record = [&](std::uint64_t, const std::vector<wire::Frame>& frames) {
    if (std::none_of(frames.begin(), frames.end(),
                     [](const wire::Frame& frame) { return frame.id == wire::kTickId; }))
      return;  // the ECU's
    if (perception != nullptr) perception->hear(frames);
    if (watch.look().plan && watch.plan().plan.kind == PlanKind::kDrive) ++driven.plans;
    if (watch.cycle() != nullptr) {
      driven.most_vehicles =
          std::max(driven.most_vehicles, static_cast<int>(watch.cycle()->scene.agents.size()));
      const auto lanes =
          std::count_if(std::begin(watch.cycle()->map.lanes), std::end(watch.cycle()->map.lanes),
                        [](const Lane& lane) { return lane.present; });
      driven.most_lanes = std::max(driven.most_lanes, static_cast<int>(lanes));
    }
    stop = ++ticks >= most_ticks;
    std::this_thread::sleep_until(next = std::max(next + 10ms, std::chrono::steady_clock::now()));
  };
  const scenario::Scenario scenario =
      scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios/left_turn");
  driven.world = processes::run_world(scenario, bus.can(), options, std::cout, stop);
  return driven;
}

// TELE-040 PROC-045 Objects and map over DDS, through s4tp-telemetry, into an ECU process: it plans on them
// among the others and turns left to the goal.
TEST(InputDrive, ReachesTheGoalOnWhatIsToldOverDds) {
  Perception perception;
  const Driven driven = drive(&perception, kTicksMax);
  ASSERT_TRUE(driven.world.met_ecu);
  EXPECT_EQ(driven.world.recording.ending, traffic::Ending::kGoal);
  EXPECT_GT(driven.plans, 60);
  EXPECT_GT(driven.most_vehicles, 1);
  EXPECT_GT(driven.most_lanes, 4);
}

// PROC-045 The same with nobody who tells anything over DDS, though all of it is on the bus: no lane, no
// vehicle, no plan that drives.
TEST(InputDrive, WithoutDdsThereIsNoPlan) {
  const Driven driven = drive(nullptr, 500);
  ASSERT_TRUE(driven.world.met_ecu);
  EXPECT_EQ(driven.plans, 0);
  EXPECT_EQ(driven.most_vehicles, 0);
  EXPECT_EQ(driven.most_lanes, 0);
}

}  // namespace
}  // namespace s4tp::telemetry
