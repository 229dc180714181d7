// The fault campaign itself: random scripts around the whole loop, and planted defects that it must find.

#include "sim_host/faults/fault_campaign.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "firmware/wire/e2e.hpp"
#include "tests/support/content.hpp"

namespace s4tp::faults {
namespace {

const Scenarios& shipped() {
  static const Scenarios scenarios = [] {
    Scenarios all;
    for (const std::string name : {"cruise", "cut_in", "left_turn", "merge", "overtake"}) {
      all.emplace(name, scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" /
                                                "scenarios" / name));
    }
    return all;
  }();
  return scenarios;
}

RunResult run(const FaultScript& script) {
  return run_script(shipped(), script);
}

/// A campaign of two scripts around a planted defect: `seed`, the first of all that fails, cut down, and the one before.
CampaignResult hunt(std::uint64_t seed, const std::function<void(const std::vector<wire::Frame>& taken,
                                                                 std::vector<wire::Frame>& sent)>& defect) {
  CampaignOptions options;
  options.scripts = 2;
  options.first_seed = seed - 1;
  options.isolation.jobs = 2;
  return run_campaign(
      shipped(),
      [&](const FaultScript& script) {
        RunOptions run_options;
        run_options.defect = defect;
        return run_script(shipped(), script, run_options);
      },
      options);
}

/// A command frame with `acceleration` in place of its own.
void falsify(wire::Frame& frame, float acceleration_mps2) {
  wire::Command command;
  ASSERT_TRUE(wire::decode(frame, command));
  const std::uint8_t counter = frame.data[1] & 0x0FU;
  command.acceleration_mps2 = acceleration_mps2;
  ASSERT_TRUE(wire::encode(command, frame));
  frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) | counter);
  wire::e2e_seal(frame);
}

// FAULT-010 .. FAULT-014: 100 random scripts; the ECU is never silent, never outside the limits, always stops
// or recovers.
TEST(FaultCampaign, OneHundredScripts) {
  CampaignOptions options;
  options.scripts = 100;
  options.first_seed = 0;
  options.isolation.jobs = 2;
  const CampaignResult result = run_campaign(shipped(), run, options);
  std::ostringstream table;
  print_table(table, result);
  EXPECT_EQ(result.failed(), 0) << table.str()
                                << (result.minimized ? to_text(*result.minimized) : std::string());
  int drives = 0;
  int stops = 0;
  for (const RunResult& one : result.results) {
    drives += one.verdict.outcome == Outcome::kDrive ? 1 : 0;
    stops += one.verdict.outcome == Outcome::kStopped ? 1 : 0;
  }
  EXPECT_GT(drives, 15);  // neither harmless
  EXPECT_GT(stops, 15);   // nor hopeless
}

// A planted defect: the ECU says nothing in a tick in which a frame was cut short. Only the damage is left of
// the script, on one message, in one tick.
TEST(FaultCampaign, FindsTheSilentEcu) {
  const CampaignResult result =
      hunt(15, [](const std::vector<wire::Frame>& taken, std::vector<wire::Frame>& sent) {
        for (const wire::Frame& frame : taken) {
          if (frame.id < 0x100U && frame.length < 8) sent.clear();
        }
      });
  ASSERT_TRUE(result.minimized.has_value());
  EXPECT_EQ(result.results[*result.first_failed()].verdict.breach, Breach::kSilence);
  ASSERT_EQ(result.minimized->faults.size(), 1U) << to_text(*result.minimized);
  const Fault& fault = result.minimized->faults[0];
  EXPECT_EQ(fault.kind, FaultKind::kCorrupt);
  EXPECT_EQ(fault.ticks, 1);
  EXPECT_EQ(fault.messages & (fault.messages - 1U), 0U) << to_text(fault);  // one bit
}

// A planted defect: 5 m/s^2 after a speed above 60 m/s was told. What told it is left of the script: a sender
// that lies about Motion.
TEST(FaultCampaign, FindsTheCommandOutsideTheLimits) {
  const CampaignResult result =
      hunt(28, [](const std::vector<wire::Frame>& taken, std::vector<wire::Frame>& sent) {
        for (const wire::Frame& frame : taken) {
          wire::Motion motion;
          const bool fast =
              wire::e2e_crc_fits(frame) && wire::decode(frame, motion) && motion.speed_mps > 60.0F;
          if (fast && !sent.empty()) falsify(sent.back(), 5.0F);
        }
      });
  ASSERT_TRUE(result.minimized.has_value());
  EXPECT_EQ(result.results[*result.first_failed()].verdict.breach, Breach::kLimits);
  ASSERT_EQ(result.minimized->faults.size(), 1U) << to_text(*result.minimized);
  EXPECT_TRUE(traits(result.minimized->faults[0].kind).lies);
  EXPECT_TRUE(contains(result.minimized->faults[0].messages, wire::kMotionId));
}

// FAULT-014 FAULT-015: a planted crash on a flood; the process that dies takes no other with it, its last
// words are kept, and a burst is what is left of the script.
TEST(FaultCampaign, FindsTheCrash) {
  const CampaignResult result =
      hunt(32, [](const std::vector<wire::Frame>& taken, std::vector<wire::Frame>&) {
        const auto foreign = std::count_if(taken.begin(), taken.end(),
                                           [](const wire::Frame& frame) { return frame.id >= 0x100U; });
        if (foreign <= 200) return;
        std::fputs("a planted crash\n", stderr);
        std::abort();
      });
  ASSERT_TRUE(result.minimized.has_value());
  const Verdict& verdict = result.results[*result.first_failed()].verdict;
  EXPECT_EQ(verdict.breach, Breach::kCrash);
  EXPECT_EQ(verdict.what, "signal 6: a planted crash");
  EXPECT_EQ(result.failed(), 1);
  ASSERT_EQ(result.minimized->faults.size(), 1U) << to_text(*result.minimized);
  EXPECT_EQ(result.minimized->faults[0].kind, FaultKind::kBurst);
}

// FAULT-015: a script without an end counts as hanging; an exception is a crash that says what it was.
TEST(FaultIsolation, HangAndException) {
  IsolationOptions options;
  options.limit_s = 3.0;
  std::vector<FaultScript> scripts(3);
  scripts[1].seed = 1;
  scripts[2].seed = 2;
  std::vector<RunResult> results(3);
  run_isolated(
      scripts,
      [](const FaultScript& script) -> RunResult {
        if (script.seed == 1) std::this_thread::sleep_for(std::chrono::hours(1));
        if (script.seed == 2) throw std::runtime_error("no such thing");
        return {};
      },
      options,
      [&](std::size_t index, const RunResult& result) {
        results[index] = result;
        return true;
      });
  EXPECT_EQ(results[0].verdict.breach, Breach::kNone);
  EXPECT_EQ(results[1].verdict.breach, Breach::kHang);
  EXPECT_EQ(results[2].verdict.breach, Breach::kCrash);
  EXPECT_EQ(results[2].verdict.what, "exception: no such thing");
}

// FAULT-017: one job or three, the same numbers to the byte.
TEST(FaultCampaign, DoesNotDependOnJobs) {
  const auto numbers = [](int jobs) {
    CampaignOptions options;
    options.scripts = 12;
    options.first_seed = 500;
    options.isolation.jobs = jobs;
    const auto file =
        std::filesystem::temp_directory_path() / ("s4tp_faults_" + std::to_string(jobs) + ".json");
    write_json(file, run_campaign(shipped(), run, options));
    return test::content(file);
  };
  EXPECT_EQ(numbers(1), numbers(3));
}

FaultScript single(const std::string& fault) {
  return parse_script("seed 3\nscenario cruise\n" + fault + "\n", "test");
}

// What is no loss of information is no reason to slow down: every frame twice, an error-passive controller,
// or a flood of 200 foreign frames a tick, from before the start to the end.
TEST(FaultRun, DrivesThroughWhatDoesNoHarm) {
  FaultScript twice = single("fault duplicate from -300 for 2000 messages Command intensity 100 dice 1");
  twice.faults[0].messages = traits(FaultKind::kDuplicate).messages;
  for (const FaultScript& script :
       {twice, single("fault bus_off from -300 for 2000 messages - intensity 2 dice 1"),
        single("fault burst from -300 for 2000 messages - intensity 200 dice 2")}) {
    const RunResult result = run(script);
    EXPECT_EQ(result.verdict.breach, Breach::kNone) << result.verdict.what;
    EXPECT_EQ(result.verdict.outcome, Outcome::kDrive);
    EXPECT_EQ(result.modes, 0b111U) << to_text(script);  // standby, ready, driving: nothing else
  }
}

// Three seconds off the bus: the car stops, and the ECU, back on the bus, says that it did. The story has modes and
// faults by their names; without a fault it has none.
TEST(FaultRun, ComesBackAfterBusOff) {
  std::ostringstream story;
  RunOptions options;
  options.story = &story;
  const RunResult result =
      run_script(shipped(), single("fault bus_off from 100 for 300 messages - intensity 0 dice 1"), options);
  EXPECT_EQ(result.verdict.breach, Breach::kNone) << result.verdict.what;
  EXPECT_EQ(result.verdict.outcome, Outcome::kStopped);
  EXPECT_NE(story.str().find(": ready -> driving (ECU-034)\n"), std::string::npos) << story.str();
  EXPECT_NE(story.str().find("tick   100: driving -> minimum risk (ECU-036), faults 0x1000: bus off\n"),
            std::string::npos)
      << story.str();
}

}  // namespace
}  // namespace s4tp::faults
