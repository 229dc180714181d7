// What is shown of an ECU that has no shared memory of ours: its twin, for as long as both send the same.
#include "sim_host/processes/board_twin.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "sim_host/campaign/driver.hpp"
#include "sim_host/campaign/trace.hpp"
#include "sim_host/telemetry/watch.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/test_memory.hpp"

namespace s4tp::processes {
namespace {

constexpr int kTicks = 500;  // 3 s of pre-roll and 2 s of driving

/// The left turn with an ECU that nobody looks into; the twin hears the bus.
struct Bus {
  scenario::Scenario scenario =
      scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host/scenarios/left_turn");
  world::World world{scenario, {}};
  campaign::Trace inside;  ///< what the board thinks, and tells nobody
  std::unique_ptr<campaign::Driver> board =
      campaign::make_driver("s4tp", true, Parameters{}, &inside, &inside);
  std::string memory = tests::test_memory("twin");
  std::ostringstream out;
  BoardTwin twin{memory, {"m7"}, out};

  /// \param lie  one bit of each frame of the board's last tick is another one
  void drive(int ticks, bool lie = false) {
    for (int i = 0; i < ticks; ++i) {
      std::vector<wire::Frame> told;
      std::vector<wire::Frame> answers;
      world.tick(told);
      twin.hear(told);
      board->tick(told, answers);
      for (wire::Frame frame : answers) {
        world.receive(frame);
        if (lie && i + 1 == ticks) frame.data[3] ^= 1U;
        twin.hear({frame});
      }
    }
  }
};

// TELE-006 Plan, prediction and mode in the twin's memory are those inside the board, which told nobody.
TEST(BoardTwin, TellsWhatTheBoardThinks) {
  Bus bus;
  bus.drive(kTicks);
  telemetry::Watch watch(bus.memory);
  (void)watch.look();
  ASSERT_TRUE(watch.present()) << watch.absence();
  ASSERT_TRUE(bus.twin.tells()) << bus.out.str();
  ASSERT_FALSE(bus.inside.cycles.empty());
  EXPECT_EQ(watch.plan().digest, bus.inside.cycles.back().record.digest);
  EXPECT_EQ(watch.plan().plan.start_ms, bus.inside.cycles.back().record.plan.start_ms);
  EXPECT_EQ(watch.control().mode, bus.board->core().mode());
  ASSERT_NE(watch.cycle(), nullptr);
  EXPECT_EQ(watch.cycle()->scene.agents.size(), static_cast<int>(bus.inside.cycles.back().tracks.size()));
  EXPECT_NE(std::string(watch.identity().bus).find("m7"), std::string::npos);
}

// TELE-006 One tick whose frames differ by a bit: whoever looks is told that the ECU has ended, the terminal which
// frames differ.
TEST(BoardTwin, ABoardThatDoesOtherwiseIsNotShown) {
  Bus bus;
  bus.drive(kTicks, true);
  EXPECT_TRUE(bus.twin.tells());  // known when the next tick begins
  bus.drive(1);
  EXPECT_FALSE(bus.twin.tells());
  telemetry::Watch watch(bus.memory);
  (void)watch.look();
  EXPECT_FALSE(watch.present());
  EXPECT_NE(bus.out.str().find("the board sent "), std::string::npos) << bus.out.str();
}

}  // namespace
}  // namespace s4tp::processes
