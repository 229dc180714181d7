// Nobody who reads changes what the ECU does: not a bit of what it sends, not an instruction of a planning cycle.
#include <elf.h>
#include <gtest/gtest.h>
#include <ros.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "hal/linux/named_bus.hpp"
#include "sim_host/processes/child_process.hpp"
#include "sim_host/processes/world_process.hpp"
#include "sim_host/recording/ticks.hpp"
#include "sim_host/telemetry/records.hpp"
#include "tests/dds/drive.hpp"
#include "tests/dds/ros_reader.hpp"
#include "tests/dds/wait_for.hpp"
#include "tests/support/free_port.hpp"

namespace s4tp {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;
using tests::kTelemetry;
using tests::memory_name;
using tests::wait_for;

constexpr int kSecond = 100;  ///< ticks

/// A drive of 80 s: the road of cruise at a walk.
scenario::Scenario at_a_walk() {
  scenario::Scenario scenario = tests::shipped("cruise");
  for (map::Lane& lane : scenario.network.lanes) lane.speed_limit_mps = 2.0;
  scenario.mission.start_speed_mps = 2.0;
  return scenario;
}

/// Those who look at an ECU: s4tp-telemetry and its subscribers, of another vendor. They stand still, come late,
/// are killed, come again.
class Audience {
 public:
  explicit Audience(int stopped_ticks) : stopped_ticks_(stopped_ticks) { start(); }
  ~Audience() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  Audience(const Audience&) = delete;
  Audience& operator=(const Audience&) = delete;

  /// What happens before the ECU's tick of this number. While the process is stopped a tick takes 10 ms of the
  /// host at least, so it stands still for that long by both clocks.
  void before(int tick) {
    const int go_on = kStop + stopped_ticks_;
    if (tick == kStop) {
      EXPECT_TRUE(wait_for([&] { return first_.count() > 0; }));
      EXPECT_EQ(kill(process_, SIGSTOP), 0);  // wherever it is, in the midst of a record too
      stopped_ = steady_clock::now();
    }
    if (tick > kStop && tick <= go_on) std::this_thread::sleep_until(stopped_ + (tick - kStop) * 10ms);
    if (tick == go_on) {
      EXPECT_EQ(kill(process_, SIGCONT), 0);
      join();
    }
    if (tick == go_on + kSecond) {
      EXPECT_TRUE(wait_for(
          [&] {
            return std::all_of(late_.begin(), late_.end(), [](const auto& one) { return one->count() > 0; });
          },
          60s));
      EXPECT_EQ(kill(process_, SIGKILL), 0);
      waitpid(process_, nullptr, 0);
    }
    if (tick == go_on + 2 * kSecond) {
      const int told = first_.count();
      start();
      EXPECT_TRUE(wait_for([&] { return first_.count() > told; }, 60s))
          << "the one that took its place tells nothing";
      done_ = true;
    }
  }
  /// Whether all of it has happened.
  [[nodiscard]] bool done() const { return done_; }

 private:
  using Reader = tests::RosReader<autoware_planning_msgs::msg::Trajectory>;
  static constexpr int kStop = 3 * kSecond;
  static constexpr int kJoiners = 50;

  void start() {
    std::vector<std::string> words = {kTelemetry, "--ecu", memory_name(), "--domain",
                                      std::to_string(tests::free_domain())};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    execv(argv[0], argv.data());
    _exit(127);
  }
  std::unique_ptr<Reader> reader() {
    return std::make_unique<Reader>(node_, "rt/s4tp/trajectory", "autoware_planning_msgs", "Trajectory",
                                    true);
  }
  void join() {
    hal::linux_host::Reason reason;
    for (int i = 0; i < kJoiners; ++i) {
      memories_.push_back(std::make_unique<hal::linux_host::SharedRecordsReader>());
      EXPECT_TRUE(memories_.back()->open(memory_name().c_str(), telemetry::kLayout, reason)) << reason.text;
      late_.push_back(reader());
    }
  }

  int stopped_ticks_;
  pid_t process_ = 0;
  tests::RosNode node_{tests::free_domain()};
  Reader first_{node_, "rt/s4tp/trajectory", "autoware_planning_msgs", "Trajectory", true};
  std::vector<std::unique_ptr<hal::linux_host::SharedRecordsReader>> memories_;
  std::vector<std::unique_ptr<Reader>> late_;
  steady_clock::time_point stopped_;
  bool done_ = false;
};

// TELE-002 SHM-002 A telemetry process that stands still for 5 s, 50 late joiners, one that is killed and one that
// takes its place: the frames the ECU sends are those of a drive nobody watches, to the bit.
TEST(Isolation, WhoReadsChangesNoBit) {
  tests::Drive alone(nullptr);
  while (alone.tick()) {
  }
  const auto tap = std::make_unique<telemetry::EcuTap>();
  hal::linux_host::Reason reason;
  ASSERT_TRUE(tap->open(memory_name(), "s4tp", "in process", Parameters{}, reason)) << reason.text;
  tests::Drive watched(tap.get());
  Audience audience(5 * kSecond);
  do audience.before(watched.ticks_driven() + 1);
  while (watched.tick());
  EXPECT_TRUE(audience.done());
  EXPECT_EQ(watched.ticks_driven(), alone.ticks_driven());
  EXPECT_EQ(watched.digest(), alone.digest());
}

/// Where in a program's code a function begins, for the counting plugin. \throws std::runtime_error
std::string code_offset(const std::string& program, const std::string& function) {
  std::ifstream file(program, std::ios::binary);
  Elf64_Ehdr head{};
  file.read(reinterpret_cast<char*>(&head), sizeof head);
  std::uint64_t first_code = ~0ULL;
  for (int i = 0; i < head.e_phnum; ++i) {
    Elf64_Phdr part{};
    file.seekg(static_cast<std::streamoff>(head.e_phoff) + i * head.e_phentsize);
    file.read(reinterpret_cast<char*>(&part), sizeof part);
    if (part.p_type == PT_LOAD && (part.p_flags & PF_X) != 0) first_code = std::min(first_code, part.p_vaddr);
  }
  FILE* const names = popen(("nm --demangle " + program).c_str(), "r");
  char line[4096];
  std::uint64_t address = 0;
  while (names != nullptr && fgets(line, sizeof line, names) != nullptr) {
    if (std::string(line).substr(17).rfind("T " + function + "(", 0) == 0)
      address = std::stoull(line, nullptr, 16);
  }
  if (names != nullptr) pclose(names);
  if (address == 0) throw std::runtime_error(program + " has no function " + function + " to count from");
  return std::to_string(address - first_code);
}

/// What an ECU did in a drive, as a process of its own in QEMU.
struct Counted {
  std::vector<std::uint64_t> instructions;  ///< of each planning cycle, from its begin to the end of its tick
  std::uint64_t frames = 0;                 ///< digest of all it sent
  int ticks = 0;
};

/// \param telemetry  whether it tells what it does; when not, the name is as long, as arguments move the stack
/// \param audience   null: nobody looks  \param most_ticks  of the drive
Counted count(const scenario::Scenario& scenario, const std::string& port, bool telemetry, Audience* audience,
              int most_ticks) {
  const std::string program = std::string(S4TP_BINARY_DIR) + "/sim_host/s4tp_ecu_process";
  const std::string counts = "counts" + memory_name().substr(1) + ".txt";
  processes::WorldProcessOptions options;
  options.bus = "slcan:listen:127.0.0.1:" + port;
  options.seed = 3;
  options.wait_for_answers(120);
  Counted counted;
  tests::FrameDigest digest;
  std::atomic<bool> stop = false;
  options.record = [&](std::uint64_t, const std::vector<wire::Frame>& frames) {
    if (recording::sent_by_ecu(frames.front())) {
      for (const wire::Frame& frame : frames) digest.add(frame);
      return;
    }
    // The tick's frames are sent: the ECU is at work while others come and go.
    if (audience != nullptr) audience->before(counted.ticks);
    stop = ++counted.ticks >= most_ticks;
  };
  hal::linux_host::NamedBus bus;
  hal::linux_host::Reason reason;
  EXPECT_TRUE(bus.open(options.bus.c_str(), {}, reason)) << reason.text;
  {
    processes::ChildProcess ecu({S4TP_QEMU, "-plugin",
                                 std::string(S4TP_COUNT_PLUGIN) + ",out=" + counts +
                                     ",begin=" + code_offset(program, "s4tp::ecu::EcuCore::begin_cycle") +
                                     ",end=" + code_offset(program, "s4tp::telemetry::EcuTap::note_status"),
                                 program, "--bus", "slcan:tcp:127.0.0.1:" + port, "--silence", "300",
                                 "--telemetry",
                                 telemetry ? memory_name() : std::string(memory_name().size(), '/')});
    const processes::WorldProcessResult result =
        processes::run_world(scenario, bus.can(), options, std::cout, stop);
    EXPECT_TRUE(result.met_ecu);
    EXPECT_EQ(result.unanswered, 0);
  }
  counted.frames = digest.value();
  std::ifstream file(counts);
  for (std::uint64_t number = 0; file >> number;) counted.instructions.push_back(number);
  std::filesystem::remove(counts);
  return counted;
}

/// \param stopped_ticks  for how long the telemetry process stands still
void expect_no_instruction_more(const scenario::Scenario& scenario, int stopped_ticks) {
  const std::string port = test::free_port();
  constexpr int kWhole = 100'000;
  const Counted alone = count(scenario, port, true, nullptr, kWhole);
  Counted watched;
  {
    Audience audience(stopped_ticks);
    watched = count(scenario, port, true, &audience, kWhole);
    EXPECT_TRUE(audience.done());
  }
  ASSERT_GT(alone.ticks, stopped_ticks);
  ASSERT_GE(alone.instructions.size(), static_cast<std::size_t>(alone.ticks / 10 - 1));
  EXPECT_EQ(watched.ticks, alone.ticks);
  EXPECT_EQ(watched.frames, alone.frames);
  ASSERT_EQ(watched.instructions.size(), alone.instructions.size());
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < alone.instructions.size(); ++i) {
    EXPECT_EQ(watched.instructions[i], alone.instructions[i]) << "planning cycle " << i;
    sum += alone.instructions[i];
  }
  std::cout << alone.instructions.size() << " planning cycles of " << sum / alone.instructions.size()
            << " instructions in the mean, the same with and without readers\n";

  // That it can be seen: an ECU that writes no records needs fewer.
  const Counted silent = count(scenario, port, false, nullptr, 5 * kSecond);
  ASSERT_GT(silent.instructions.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i)
    EXPECT_LT(silent.instructions[i], alone.instructions[i]) << "planning cycle " << i;
  std::cout << "in cycle 40 " << alone.instructions[39] - silent.instructions[39] << " of "
            << alone.instructions[39] << " instructions write records\n";
}

// TELE-007 The same of an ECU that is a process of its own, with the instructions of each of its planning cycles
// counted by QEMU: equal, one by one.
TEST(Isolation, WhoReadsCostsNoInstruction) {
  expect_no_instruction_more(tests::shipped("left_turn"), 5 * kSecond);
}

// TELE-002 TELE-007 The same with a telemetry process that stands still for 60 s.
TEST(IsolationLong, WhoReadsCostsNoInstructionInAMinute) {
  expect_no_instruction_more(at_a_walk(), 60 * kSecond);
}

}  // namespace
}  // namespace s4tp
