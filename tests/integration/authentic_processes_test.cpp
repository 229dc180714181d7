// World and ECU as two processes that authenticate.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/two_processes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the programs are the language of these tests

/// A key of this run, in a file that nobody else may read.
std::string new_key(const std::string& name) {
  const fs::path file = scratch(name);
  std::ifstream random("/dev/urandom", std::ios::binary);
  std::ofstream text(file);
  for (int i = 0; i < 16; ++i) {
    constexpr char kDigits[] = "0123456789abcdef";
    const int byte = random.get();
    text << kDigits[byte / 16] << kDigits[byte % 16];
  }
  text.close();
  EXPECT_EQ(chmod(file.c_str(), 0600), 0);
  return file;
}

/// The lines of a log with the plans that took effect: when, and the CRC-32 over their bits.
std::vector<std::string> plans_of(const fs::path& log) {
  std::vector<std::string> plans;
  std::ifstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" 032#") != std::string::npos) plans.push_back(line);
  }
  return plans;
}

// AUTH-040, AUTH-033, AUTH-034 Two processes that authenticate plan, to the bit and in the same ticks, what
// is planned without; the key comes from a file or from the environment.
TEST(RunCommand, AuthenticDriveHasTheSamePlans) {
  const std::string file = new_key("key");
  ASSERT_EQ(setenv("S4TP_TEST_KEY", content(file).c_str(), 1), 0);
  const std::vector<std::string> expected = plans_of(in_process("left_turn", 3));
  for (const std::string& key : {file, std::string("env:S4TP_TEST_KEY")}) {
    const fs::path log = scratch("authentic.log");
    Process run("s4tp_tool", {"run", "--bus", "slcan:tcp:127.0.0.1:" + test::free_port(), "--scenario",
                              folder_of("left_turn"), "--seed", "3", "--log", log, "--out", scratch("out"),
                              "--patience", "20", "--authentic", key});
    EXPECT_LE(run.wait(), 1);
    EXPECT_GT(plans_of(log).size(), 50U);
    EXPECT_EQ(plans_of(log), expected);
  }
  EXPECT_EQ(unsetenv("S4TP_TEST_KEY"), 0);
}

// AUTH-041 A forger on the line between the two: behind each line of the ECU's it says a command with CRC,
// counter and echo as they ought to be, and one recorded earlier with its companion. The plans are those of a
// drive without it.
TEST(TwoProcesses, AForgerOnTheLineChangesNothing) {
  wire::E2eSender counter;
  unsigned tick = 0;
  bool whole = true;
  std::vector<std::string> recorded;
  std::atomic<int> said{0};
  const auto line_of = [](const wire::Frame& frame) {
    char text[32];
    int size = std::snprintf(text, sizeof text, "t%03X8", frame.id);
    for (const std::uint8_t byte : frame.data)
      size += std::snprintf(text + size, sizeof text - static_cast<std::size_t>(size), "%02X", byte);
    return std::string(text) + "\r";
  };
  const auto meddle = [&](int end, std::string& bytes) {
    if (end != 0) return;
    // Only between whole commands: what comes between a command and its companion keeps both from the world.
    const bool fresh = std::exchange(whole, bytes.back() == '\r');
    const std::size_t from = bytes.rfind("t0088");
    const std::size_t companion = bytes.rfind("t0098");
    if (!fresh || !whole || from == std::string::npos || companion == std::string::npos || companion < from ||
        bytes.starts_with("t0098"))
      return;
    wire::Command command;
    command.acceleration_mps2 = 2.5F;
    command.mode = 2;
    command.tick = static_cast<std::uint16_t>(++tick % 4096U);
    wire::Frame frame;
    if (!wire::encode(command, frame)) return;
    counter.protect(frame);
    recorded.push_back(bytes.substr(from));
    const std::string replayed = recorded[recorded.size() / 2];
    bytes = line_of(frame) + bytes + replayed;
    ++said;
  };
  const std::string key = new_key("key");
  const Cable cable(meddle);
  const fs::path log = scratch("forged.log");
  Process ecu("s4tp_ecu_process",
              {"--bus", "slcan:pty:" + cable.ports[0], "--silence", "5", "--authentic", key});
  Process world("s4tp_world_process",
                {"--bus", "slcan:tty:" + cable.ports[1] + "@2000000", "--scenario", folder_of("cruise"),
                 "--seed", "3", "--log", log, "--patience", "20", "--authentic", key});
  EXPECT_LE(world.wait(), 1);
  EXPECT_EQ(ecu.wait(), 0);
  EXPECT_GT(said, 100);  // as many as the pace of the two leaves whole lines
  EXPECT_GT(plans_of(log).size(), 50U);
  EXPECT_EQ(plans_of(log), plans_of(in_process("cruise", 3)));
}

// AUTH-031, AUTH-033 Without a key that may be used nothing begins (2); with an ECU that has none, the world
// says so (2); with an ECU that has another one no command is taken, and the ECU counts as dead (1).
TEST(TwoProcesses, WrongKeysAreReported) {
  const std::string key = new_key("key");
  const std::string open_key = new_key("open_key");
  EXPECT_EQ(chmod(open_key.c_str(), 0644), 0);
  for (const std::string& bad : {open_key, scratch("none").string(), std::string("env:S4TP_NO_SUCH_KEY")}) {
    EXPECT_EQ(Process("s4tp_ecu_process", {"--bus", "slcan:tcp:127.0.0.1:1", "--authentic", bad}).wait(), 2);
    EXPECT_EQ(Process("s4tp_world_process", {"--bus", "slcan:listen:127.0.0.1:1", "--authentic", bad}).wait(),
              2);
  }
  {
    const std::string port = test::free_port();
    Process world("s4tp_world_process",
                  {"--bus", "slcan:listen:127.0.0.1:" + port, "--wait-ecu", "3", "--authentic", key});
    Process ecu("s4tp_ecu_process", {"--bus", "slcan:tcp:127.0.0.1:" + port, "--wait", "30"});
    EXPECT_EQ(world.wait(), 2);
    ecu.end(SIGKILL);
  }
  {
    const std::string port = test::free_port();
    Process world("s4tp_world_process", {"--bus", "slcan:listen:127.0.0.1:" + port, "--wait-ecu", "60",
                                         "--out", scratch("out"), "--authentic", key});
    Process ecu("s4tp_ecu_process", {"--bus", "slcan:tcp:127.0.0.1:" + port, "--silence", "1", "--authentic",
                                     new_key("other_key")});
    EXPECT_EQ(world.wait(), 1);
    (void)ecu.wait();
    EXPECT_NE(content(scratch("out") / "run.json").find("\"ending\": \"dead ECU\""), std::string::npos);
  }
}

}  // namespace
}  // namespace s4tp
