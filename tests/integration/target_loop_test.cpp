// The ECU's image on an emulated board, in the loop of the world: the commands of the host's ECU, to the last
// bit. In the plain suite one scenario on m7 and a short piece of one on m55; the names with Long in them run
// with --long.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/campaign/bus_log.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/processes/board_console.hpp"
#include "sim_host/processes/child_process.hpp"
#include "sim_host/processes/drive_on_target.hpp"
#include "sim_host/processes/emulated_board.hpp"
#include "tests/support/random_network.hpp"

namespace s4tp::processes {
namespace {

namespace fs = std::filesystem;

fs::path scratch(const std::string& name) {
  static const struct Folder {
    fs::path path = fs::temp_directory_path() / ("s4tp_loop_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
  } folder;
  return folder.path / name;
}

scenario::Scenario load(const std::string& name) {
  return scenario::load_scenario(fs::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name);
}

/// All frames of the bus but one: what a cycle cost is the target's own.
std::string frames_of(const fs::path& log) {
  char cost[8];
  std::snprintf(cost, sizeof cost, " %03X#", static_cast<unsigned>(wire::kCycleStatisticsId));
  std::ifstream text(log);
  std::string frames;
  for (std::string line; std::getline(text, line);) {
    if (line.find(cost) == std::string::npos) frames += line + '\n';
  }
  return frames;
}

fs::path on_host(const scenario::Scenario& scenario, std::uint64_t seed) {
  const fs::path log = scratch("host.log");
  campaign::EpisodeOptions options;
  options.seed = seed;
  options.log = log;
  (void)campaign::run_episode(scenario, options);
  return log;
}

BoardConsole console_of(const std::string& target) {
  std::ifstream text(scratch("console_" + target + ".txt"));
  return read_console(text, find_board(target).counts_per_instruction);
}

TargetOptions options_for(const std::string& target, std::uint64_t seed) {
  TargetOptions options;
  options.target = target;
  options.out = scratch("");
  options.world.seed = seed;
  options.world.log = scratch(target + ".log");
  options.world.ecu_note = campaign::ecu_note("s4tp", true, Parameters{});
  return options;
}

void expect_the_hosts_commands(const std::string& target, const scenario::Scenario& scenario,
                               std::uint64_t seed) {
  const std::string wanted = frames_of(on_host(scenario, seed));
  ASSERT_GT(wanted.size(), 10'000U);
  std::ostringstream out;
  (void)drive_on_target(scenario, options_for(target, seed), out);
  EXPECT_TRUE(frames_of(scratch(target + ".log")) == wanted) << target << ' ' << scenario.name << '\n'
                                                             << out.str();
}

// TARGET-010, TARGET-011, PROC-044 A whole left turn on the Cortex-M7. Each of its cycles with a plan is
// interrupted by the control ticks between two boundaries, 9 of them; the first may come before planning has
// begun.
TEST(TargetLoop, LeftTurnOnM7) {
  expect_the_hosts_commands("m7", load("left_turn"), 3);
  const BoardConsole console = console_of("m7");
  EXPECT_EQ(console.others.size(), 1U) << "it says that it starts, and nothing else";
  std::size_t cycles = 0;
  std::size_t preempted = 0;
  for (const CycleCost& cycle : console.cycles) {
    if (cycle.at("check") <= 0.0) continue;
    ++cycles;
    if (cycle.at("preemptions") >= 8.0) ++preempted;
  }
  EXPECT_GT(cycles, 80U);
  EXPECT_GE(10 * preempted, 9 * cycles);
  EXPECT_GT(console.stack_bytes, 1000);
  EXPECT_LT(console.stack_bytes, 8192);
  std::ifstream json(scratch("cost_m7.json"));
  EXPECT_TRUE(json.good());
}

// TARGET-010 The same on the Cortex-M55, another scenario, ended by its time limit after 3 s.
TEST(TargetLoop, ShortCruiseOnM55) {
  scenario::Scenario scenario = load("cruise");
  scenario.mission.time_limit_s = 3.0;
  expect_the_hosts_commands("m55", scenario, 4);
}

// ECU-102 ECU-103 An image in the board's flash bank that is damaged: the bus says why it is refused, in words of the
// launcher, and the board's commands are those of the host's ECU with the same bank.
TEST(TargetLoop, RefusesDamagedWeightsAsTheHostDoes) {
  std::vector<std::int32_t> words(satp::kImageBytes / 4);
  test::make_random_image(8, words.data());
  words[4000] ^= 1;
  const fs::path file = scratch("damaged.satp");
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(words.data()), satp::kImageBytes);
  scenario::Scenario scenario = load("cut_in");
  scenario.mission.time_limit_s = 2.0;
  const auto bank = campaign::bank_with(file);
  campaign::EpisodeOptions host;
  host.seed = 4;
  host.weights = bank.get();
  host.log = scratch("host.log");
  EXPECT_EQ(campaign::run_episode(scenario, host).weights, satp::WeightStatus::kChecksum);
  for (const std::string target : {"m7", "m55"}) {
    TargetOptions options = options_for(target, 4);
    options.weights = file;
    std::ostringstream out;
    (void)drive_on_target(scenario, options, out);
    EXPECT_NE(out.str().find("refuses its weights (checksum)"), std::string::npos) << out.str();
    EXPECT_TRUE(frames_of(scratch(target + ".log")) == frames_of(scratch("host.log"))) << out.str();
  }
}

// TARGET-010 All four scenarios on both.
TEST(TargetLoopLong, AllScenariosOnBoth) {
  for (const std::string target : {"m7", "m55"}) {
    for (const std::string name : {"left_turn", "merge", "cruise", "overtake"}) {
      expect_the_hosts_commands(target, load(name), 5);
    }
  }
}

// PROC-044 No image: the reason names the file and the way to it.
TEST(TargetLoop, MissingImageIsNamed) {
  TargetOptions options = options_for("m7", 0);
  options.image = scratch("nothing");
  std::ostringstream out;
  try {
    (void)drive_on_target(load("left_turn"), options, out);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("ecu_lockstep"), std::string::npos) << error.what();
  }
}

/// The image with its control interrupt leading to the fault handler: entries 14 and 3 of the vector table,
/// which the first loaded segment begins with.
fs::path broken_image() {
  std::ifstream in(fs::path(S4TP_SOURCE_DIR) / "build" / "m7" / "firmware" / "targets" / "ecu_lockstep",
                   std::ios::binary);
  std::string image{std::istreambuf_iterator<char>(in), {}};
  const auto word = [&image](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, image.data() + at, sizeof value);
    return value;
  };
  constexpr std::size_t kProgramHeaders =
      0x1C;  // ELF-32: where they begin; each has its segment's offset second
  const std::size_t vectors = word(word(kProgramHeaders) + 4);
  image.replace(vectors + 14 * 4, 4, image.substr(vectors + 3 * 4, 4));
  std::ofstream(scratch("broken"), std::ios::binary) << image;
  return scratch("broken");
}

// PROC-044 A board that breaks down: the watchdog ends it, and its last words are on the host.
TEST(TargetLoop, LastWordsArrive) {
  TargetOptions options = options_for("m7", 0);
  options.image = broken_image();
  options.world.wait_s = 60;
  std::ostringstream out;
  EXPECT_EQ(drive_on_target(load("left_turn"), options, out), 2);
  EXPECT_NE(out.str().find("m7: fault of the core"), std::string::npos) << out.str();
}

// PROC-040 What cannot be started is named; what was started is gone after us.
TEST(ChildProcess, StartsAndEnds) {
  EXPECT_THROW(ChildProcess({"no-such-program-of-anybody"}), std::runtime_error);
  ChildProcess ended({"true"});
  for (int i = 0; i < 1000 && ended.lives(); ++i) usleep(10'000);
  EXPECT_FALSE(ended.lives());
  const fs::path file = scratch("child");
  {
    ChildProcess sleeps({"sh", "-c", "echo $$ >" + file.string() + "; exec sleep 1000"});
    for (int i = 0; i < 1000 && (!fs::exists(file) || fs::file_size(file) == 0); ++i) usleep(10'000);
    EXPECT_TRUE(sleeps.lives());
  }
  int pid = 0;
  std::ifstream(file) >> pid;
  ASSERT_GT(pid, 0);
  EXPECT_NE(kill(pid, 0), 0);
}

// PROC-041, PROC-042, PROC-043 Two whole cycles of 1.6 counts an instruction, one cut off, and last words.
TEST(BoardConsole, ReadsCyclesAndWords) {
  std::istringstream text(
      "s4tp ecu: kOk, lock-step\n"
      "cycle scene 1600000 check 0 preemptions 9 control 16000\n"
      "tick 100 mode 2 faults 0000 stack 5000 CAN errors 0 dropped 0\n"
      "cycle scene 3200000 check 800000 preemptions 8 control 32000\r\n"
      "x > 0 failed in algo/a.cpp\n"
      "cycle scene 16");
  const BoardConsole console = read_console(text, 1.6);
  ASSERT_EQ(console.cycles.size(), 2U);
  EXPECT_DOUBLE_EQ(console.cycles[1].at("all"), 2.5);
  EXPECT_DOUBLE_EQ(console.cycles[0].at("control"), 0.01);
  EXPECT_EQ(console.stack_bytes, 5000);
  ASSERT_EQ(console.others.size(), 3U);  // the start, the words, the half line
  EXPECT_EQ(console.others[1], "x > 0 failed in algo/a.cpp");
  std::ostringstream table;
  print_costs(table, console, {{"scene", 1.5}, {"check", 0.5}});
  EXPECT_NE(table.str().find("scene                2     1.500     2.000       1.5  OVER"), std::string::npos)
      << table.str();
  EXPECT_NE(table.str().find("check                1     0.500     0.500       0.5\n"), std::string::npos)
      << table.str();
  EXPECT_NE(table.str().find("interrupted planning 17 times in 2 cycles"), std::string::npos) << table.str();
  write_costs(scratch("cost.json"), "m7", console, {{"scene", 1.5}});
  std::ostringstream json;
  json << std::ifstream(scratch("cost.json")).rdbuf();
  EXPECT_NE(json.str().find("\"median\": 1.5"), std::string::npos) << json.str();
}

}  // namespace
}  // namespace s4tp::processes
