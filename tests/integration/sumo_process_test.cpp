// These need Debian's sumo and fail without it.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/sumo/sumo_traffic.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/sumo_scenarios.hpp"

namespace s4tp::sumo {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// A folder with a program called sumo, first along PATH while this lives.
class FakeSumo {
 public:
  explicit FakeSumo(const std::string& script) : before_(std::getenv("PATH")) {
    fs::create_directories(folder_);
    const fs::path program = folder_ / "sumo";
    std::ofstream(program) << "#!/bin/sh\n" << script << '\n';
    fs::permissions(program, fs::perms::owner_all);
    setenv("PATH", (folder_.string() + ":" + before_).c_str(), 1);
  }
  ~FakeSumo() {
    setenv("PATH", before_.c_str(), 1);
    fs::remove_all(folder_);
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / ("s4tp_fake_sumo_" + std::to_string(getpid()));
  std::string before_;
};

/// Running or a zombie whose parent has not looked yet: only the first counts.
bool runs(pid_t process) {
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string id;
  std::string name;
  std::string state;
  return stat >> id >> name >> state && state != "Z" && state != "X";
}

bool ends_soon(pid_t process) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (runs(process) && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(5ms);
  return !runs(process);
}

// SUMO dies in the middle of an episode: the next step says so at once.
TEST(SumoTraffic, SaysThatSumoHasDied) {
  const scenario::Scenario scenario = shipped("cruise");
  Traffic traffic(scenario, without_ego(5));
  advance(traffic, 1.0);
  kill(traffic.process(), SIGKILL);
  const std::string what = what_of([&] { advance(traffic, 2.0); });
  EXPECT_NE(what.find("closed the connection"), std::string::npos) << what;
  EXPECT_NE(what.find("it has ended"), std::string::npos) << what;
}

// SUMO-003 A SUMO that cannot load its network, cannot have its port, or is not there, is an error in its
// words.
TEST(SumoTraffic, SaysWhySumoDoesNotComeUp) {
  scenario::Scenario scenario = shipped("cruise");
  scenario.network_file = "/nowhere.net.xml";
  const std::string no_network = what_of([&] { Traffic traffic(scenario, without_ego(5)); });
  EXPECT_NE(no_network.find("nowhere.net.xml"), std::string::npos) << no_network;
  {
    const FakeSumo refused("echo 'Error: Address already in use' >&2; exit 1");
    const std::string what = what_of([&] { Traffic traffic(scenario, without_ego(5)); });
    EXPECT_NE(what.find("Address already in use"), std::string::npos) << what;
  }
  const std::string missing = what_of([] { Process("no-such-sumo", {}, ""); });
  EXPECT_NE(missing.find("apt-get install sumo"), std::string::npos) << missing;
}

// SUMO-001 The child ends with its object, and when whoever started it is killed.
TEST(SumoProcess, NeverOutlivesUs) {
  pid_t child = 0;
  {
    const Process process("sleep", {"1000"}, "");
    child = process.id();
    EXPECT_TRUE(runs(child));
  }
  EXPECT_FALSE(runs(child));

  int ids[2];
  ASSERT_EQ(pipe(ids), 0);
  const pid_t starter = fork();
  if (starter == 0) {
    const Process process("sleep", {"1000"}, "");
    const pid_t id = process.id();
    (void)!write(ids[1], &id, sizeof id);
    pause();
  }
  ASSERT_EQ(read(ids[0], &child, sizeof child), static_cast<ssize_t>(sizeof child));
  EXPECT_TRUE(runs(child));
  kill(starter, SIGKILL);
  waitpid(starter, nullptr, 0);
  EXPECT_TRUE(ends_soon(child));
}

// SUMO-001 It outlives the thread that made it: the kernel's signal of a parent's death follows the thread
// that forked.
TEST(SumoProcess, OutlivesTheThreadThatMadeIt) {
  std::unique_ptr<Process> process;
  std::thread([&] {
    process = std::make_unique<Process>("sleep", std::vector<std::string>{"1000"}, "");
  }).join();
  std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(process->lives());
  const pid_t child = process->id();
  process.reset();
  EXPECT_FALSE(runs(child));
}

/// The programs called sumo whose parent is `process`.
std::set<pid_t> sumos_of(pid_t process) {
  std::set<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream stat(entry.path() / "stat");
    pid_t id = 0;
    std::string name;
    std::string state;
    pid_t parent = 0;
    if (stat >> id >> name >> state >> parent && parent == process && name == "(sumo)") found.insert(id);
  }
  return found;
}

// SUMO-001 A campaign of two episodes at a time is interrupted, ended or killed while SUMOs run: none is
// left.
TEST(SumoProcess, NoneIsLeftOfAnInterruptedCampaign) {
  const fs::path folder = fs::temp_directory_path() / ("s4tp_sumo_eval_" + std::to_string(getpid()));
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    const pid_t campaign = fork();
    if (campaign == 0) {
      const std::string tool = fs::path(S4TP_BINARY_DIR) / "sim_host" / "s4tp_tool";
      const std::string out = folder / "out";
      (void)!freopen((folder / "said").c_str(), "w", stdout);
      (void)!freopen((folder / "said").c_str(), "w", stderr);
      execl(tool.c_str(), tool.c_str(), "eval", "--planner", "constant_speed", "--scenarios", "cruise",
            "--traffic", "sumo", "--episodes", "1000", "--jobs", "2", "--out", out.c_str(), nullptr);
      _exit(127);
    }
    std::set<pid_t> sumos;
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (sumos.size() < 2 && runs(campaign) && std::chrono::steady_clock::now() < end) {
      sumos = sumos_of(campaign);
    }
    EXPECT_EQ(sumos.size(), 2U);
    kill(campaign, signal);
    int status = 0;
    waitpid(campaign, &status, 0);
    if (signal == SIGKILL) {
      EXPECT_TRUE(WIFSIGNALED(status));
    } else {
      EXPECT_EQ(WEXITSTATUS(status), 130);
    }
    for (const pid_t sumo : sumos) EXPECT_TRUE(ends_soon(sumo)) << "signal " << signal;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace s4tp::sumo
