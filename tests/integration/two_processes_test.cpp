// World and ECU as two processes of this machine, on buses every machine has. (On a vcan: tests/machine.)
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "sim_host/campaign/episode.hpp"
#include "tests/support/drive_time.hpp"
#include "tests/support/free_port.hpp"

namespace s4tp {
namespace {

namespace fs = std::filesystem;

const fs::path kPrograms = fs::path(S4TP_BINARY_DIR) / "sim_host";

class Process {
 public:
  Process(const std::string& program, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), (kPrograms / program).string());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&process_, argv[0], nullptr, nullptr, argv.data(), environ), 0) << argv[0];
  }
  ~Process() {
    if (process_ > 0) (void)end(SIGKILL);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  /// \return its exit code
  int wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  int end(int signal) {
    kill(process_, signal);
    return wait();
  }
  /// Waits until it has said what it does when it is told to stop, 60 s at most.
  void until_it_can_be_told() const {
    const std::string file = "/proc/" + std::to_string(process_) + "/status";
    for (int i = 0; i < 1200; ++i) {
      std::ifstream status(file);
      for (std::string line; std::getline(status, line);) {
        if (line.rfind("SigCgt:", 0) == 0 &&
            (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1U) != 0U)
          return;
      }
      usleep(50'000);
    }
  }

 private:
  pid_t process_ = -1;
};

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Without the first line, which says more of the ECU where it is known.
std::string frames_of(const fs::path& log) {
  const std::string text = content(log);
  return text.substr(text.find('\n') + 1);
}

/// In a folder that goes with the test program.
fs::path scratch(const std::string& name) {
  static const struct Folder {
    fs::path path = fs::temp_directory_path() / ("s4tp_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
  } folder;
  return folder.path / name;
}

/// The scenario of that name, as long as this test needs it.
fs::path folder_of(const std::string& scenario) {
  return tests::shipped_folder_for(scenario, scratch("scenarios"));
}

fs::path in_process(const std::string& scenario, std::uint64_t seed) {
  const fs::path log = scratch("inside.log");
  campaign::EpisodeOptions options;
  options.seed = seed;
  options.log = log;
  (void)campaign::run_episode(world::load_scenario(folder_of(scenario)), options);
  return log;
}

/// Two pseudo terminals, back to back, as a cable between two serial ports.
class Cable {
 public:
  /// \param meddle  may change what comes from an end, 0 or 1; whole lines and pieces of lines
  explicit Cable(std::function<void(int end, std::string& bytes)> meddle = nullptr)
      : meddle_(std::move(meddle)) {
    for (int i = 0; i < 2; ++i) {
      ends_[i] = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
      EXPECT_EQ(grantpt(ends_[i]), 0);
      EXPECT_EQ(unlockpt(ends_[i]), 0);
      if (const char* name = ptsname(ends_[i]); name != nullptr)
        ports[i] = name;  // without devpts there is none
      // Held open, so that a port does not hang up before its process is there.
      holders_[i] = open(ports[i].c_str(), O_RDWR | O_NOCTTY);
      termios line{};  // no echo before the process has set its line
      EXPECT_EQ(tcgetattr(holders_[i], &line), 0);
      cfmakeraw(&line);
      EXPECT_EQ(tcsetattr(holders_[i], TCSANOW, &line), 0);
    }
    carrier_ = std::thread([this] {
      while (!done_) carry();
    });
  }
  ~Cable() {
    done_ = true;
    carrier_.join();
    for (int i = 0; i < 2; ++i) {
      close(holders_[i]);
      close(ends_[i]);
    }
  }
  std::string ports[2];

 private:
  void carry() {
    pollfd wanted[2] = {{ends_[0], POLLIN, 0}, {ends_[1], POLLIN, 0}};
    poll(wanted, 2, 50);
    for (int i = 0; i < 2; ++i) {
      char bytes[1024];
      const ssize_t size = read(ends_[i], bytes, sizeof bytes);
      if (size <= 0) continue;
      std::string carried(bytes, static_cast<std::size_t>(size));
      if (meddle_) meddle_(i, carried);
      for (std::size_t sent = 0; sent < carried.size() && !done_;) {
        const ssize_t taken = write(ends_[1 - i], carried.data() + sent, carried.size() - sent);
        if (taken > 0) sent += static_cast<std::size_t>(taken);
        if (taken <= 0) usleep(100);
      }
    }
  }
  std::function<void(int end, std::string& bytes)> meddle_;
  int ends_[2];
  int holders_[2];
  std::atomic<bool> done_{false};
  std::thread carrier_;
};

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
