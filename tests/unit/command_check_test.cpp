// The check that tests in the machine judge commands by, itself tested with planted faults.
#include "tests/support/command_check.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "sim_host/campaign/episode.hpp"
#include "tests/support/log_file.hpp"

namespace s4tp::ecu {
namespace {

/// The frames of a real drive of 13 s.
const std::vector<wire::Frame>& recorded_drive() {
  static const std::vector<wire::Frame> drive = [] {
    const std::filesystem::path log =
        std::filesystem::temp_directory_path() / ("check" + std::to_string(getpid()));
    campaign::EpisodeOptions options;
    options.seed = 3;
    options.log = log;
    (void)campaign::run_episode(scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" /
                                                        "scenarios" / "left_turn"),
                                options);
    const std::vector<wire::Frame> frames = test::frames_of_log(log);
    std::filesystem::remove(log);
    return frames;
  }();
  return drive;
}

/// The drive's commands pass through `change`, sealed again.
CommandCheck check_drive(const std::function<void(int tick, wire::Command& command)>& change) {
  CommandCheck check;
  for (wire::Frame frame : recorded_drive()) {
    wire::Command command;
    if (wire::decode(frame, command)) {
      change(check.ticks(), command);
      EXPECT_TRUE(wire::encode(command, frame));
      wire::e2e_seal(frame);
    }
    check.take(frame);
  }
  check.end();
  return check;
}

// GATE-001 .. GATE-007 The commands of a drive are what a second gate would have let through; it saw all.
TEST(CommandCheck, ADriveIsInsideTheLimits) {
  const CommandCheck check = check_drive([](int, wire::Command&) {});
  EXPECT_EQ(check.findings(), std::vector<std::string>{});
  EXPECT_EQ(check.commands(), check.ticks());
  EXPECT_GT(check.commands_in(Mode::kDriving), 900);
}

// One command of tick 600 out of line by a little: 3 m/s^2 more drive than a tick may add, 0.02 rad more
// steering than the wheels turn in a tick, a mode that nothing leads to.
TEST(CommandCheck, FindsPlantedFaults) {
  using Change = std::function<void(wire::Command&)>;
  for (const auto& [what, change] : {
           std::pair<std::string, Change>{"acceleration",
                                          [](wire::Command& c) { c.acceleration_mps2 += 3.0F; }},
           {"steering", [](wire::Command& c) { c.steering_rad += 0.02F; }},
           {"mode", [](wire::Command& c) { c.mode = static_cast<std::uint8_t>(Mode::kFault); }},
       }) {
    const CommandCheck check = check_drive([&change = change](int tick, wire::Command& command) {
      if (tick == 600) change(command);
    });
    ASSERT_FALSE(check.findings().empty()) << what;
    EXPECT_EQ(check.findings().front().rfind("tick 600: " + what, 0), 0U) << check.findings().front();
  }
}

// A command that echoes no tick of the last ten is not the ECU's and is left out. Here the ECU's own of that
// tick is lost with it; it is one near the goal, where the wheels turn 0.001 rad in two ticks, inside the
// 0.007 rad of one.
TEST(CommandCheck, LeavesOutWhatAnswersNoTick) {
  const CommandCheck check = check_drive([](int tick, wire::Command& command) {
    if (tick == 1280) command = {.acceleration_mps2 = 9.0F, .steering_rad = 0.8F, .mode = 2, .tick = 1180};
  });
  EXPECT_EQ(check.findings(), std::vector<std::string>{});
  EXPECT_EQ(check.commands(), check.ticks() - 1);
}

// Full braking with an echo of no tick there is, right after the first TICK frame, before the ECU has said
// anything.
TEST(CommandCheck, LeavesOutAForgedFirstCommand) {
  CommandCheck check;
  bool forged = false;
  for (const wire::Frame& frame : recorded_drive()) {
    check.take(frame);
    if (forged || check.ticks() == 0) continue;
    wire::Frame other;
    ASSERT_TRUE(wire::encode(wire::Command{.acceleration_mps2 = -8.0F, .mode = 3, .tick = 2000}, other));
    wire::e2e_seal(other);
    check.take(other);
    forged = true;
  }
  check.end();
  EXPECT_EQ(check.findings(), std::vector<std::string>{});
  EXPECT_EQ(check.commands(), check.ticks());
}

// Before or after the command of every tenth tick comes a forged one: a CRC that fits, the ECU's own echo,
// full braking; its counter is anything but the next one, 5 or 11 further than the ECU's.
TEST(CommandCheck, LeavesOutWhatStandsBetweenTwoInSequence) {
  for (const bool before : {true, false}) {
    CommandCheck check;
    int forged = 0;
    for (const wire::Frame& frame : recorded_drive()) {
      wire::Command command;
      const bool forge = wire::decode(frame, command) && check.ticks() % 10 == 9;
      if (!forge || !before) check.take(frame);
      if (!forge) continue;
      command.acceleration_mps2 = -8.0F;
      wire::Frame other;
      ASSERT_TRUE(wire::encode(command, other));
      const int counter = (frame.data[1] & 0x0F) + (++forged % 2 == 0 ? 5 : 11);
      other.data[1] = static_cast<std::uint8_t>((other.data[1] & 0xF0) | counter % 15);
      wire::e2e_seal(other);
      check.take(other);
      if (before) check.take(frame);
    }
    check.end();
    EXPECT_GT(forged, 100);
    EXPECT_EQ(check.findings(), std::vector<std::string>{});
    EXPECT_EQ(check.commands(), check.ticks());
  }
}

}  // namespace
}  // namespace s4tp::ecu
