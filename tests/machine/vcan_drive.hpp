#pragma once
/// A drive of ECU and world as two processes on vcan0, and what passes there.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "sim_host/campaign/episode.hpp"
#include "tests/support/content.hpp"
#include "tests/support/drive_time.hpp"
#include "tests/support/log_file.hpp"
#include "tests/support/process.hpp"

namespace s4tp::test {

namespace fs = std::filesystem;

struct Drive {
  int code = -1;
  fs::path log;
  std::string said;
};

/// left_turn with seed 3, 4 s of driving after 3 s of rest: emulated it takes ten times as long.
inline constexpr double kDriving_s = 4.0;

/// \param seconds  after which it is asked to stop
inline Drive drive(const std::string& name, const std::string& options = "", int seconds = 200) {
  Drive result;
  result.log = fs::current_path() / (name + ".log");
  const fs::path said = fs::current_path() / (name + ".txt");
  result.code =
      Process("exec timeout -s INT " + std::to_string(seconds) + " " + kPrograms.string() +
              "/s4tp_tool run --bus vcan0 --scenario ./left_turn --seed 3 --out out --patience 20 --log " +
              result.log.string() + " " + options + " >" + said.string() + " 2>&1")
          .wait();
  result.said = content(said);
  return result;
}

/// Waits until somebody listens on vcan0, 60 s at most. \param list  the kernel's: "all", or "sff" by 11-bit
/// id
inline void until_heard(const std::string& list) {
  const fs::path listeners = "/proc/net/can/rcvlist_" + list;
  for (int i = 0; i < 600 && content(listeners).find("vcan0 ") == std::string::npos; ++i) usleep(100'000);
}

/// candump of all that passes, from now until it is asked for.
class Listener {
 public:
  Listener() { until_heard("all"); }
  [[nodiscard]] std::vector<wire::Frame> frames() {
    std::uintmax_t size = 0;
    do {  // it is done with what has come when it writes no more
      size = fs::file_size("seen.log");
      usleep(500'000);
    } while (fs::file_size("seen.log") != size);
    (void)candump_.end_all(SIGTERM);
    return frames_of_log("seen.log");
  }

 private:
  Process candump_{"exec candump -L -r 16000000 vcan0 >seen.log 2>seen.txt"};
};

inline bool equal(const wire::Frame& a, const wire::Frame& b) {
  return a.id == b.id && a.length == b.length && std::equal(a.data, a.data + a.length, b.data);
}

inline bool same(const std::vector<wire::Frame>& a, const std::vector<wire::Frame>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

template <class Condition>
std::vector<wire::Frame> only(std::vector<wire::Frame> frames, Condition wanted) {
  std::erase_if(frames, [&](const wire::Frame& frame) { return !wanted(frame); });
  return frames;
}

inline bool is_of_world(const wire::Frame& frame) {
  for (const wire::MessageInfo& message : wire::kMessages) {
    if (message.id == frame.id) return std::string(message.sender) != "ECU";
  }
  return false;
}

class DriveOnVcan : public testing::Test {
 protected:
  /// What the same drive is inside one process.
  static const fs::path& inside() {
    static const fs::path log = [] {
      campaign::EpisodeOptions options;
      options.seed = 3;
      options.log = fs::current_path() / "inside.log";
      (void)campaign::run_episode(tests::shipped_for("left_turn", kDriving_s), options);
      return *options.log;
    }();
    return log;
  }
  static void SetUpTestSuite() {
    char folder[] = "/tmp/drive.XXXXXX";
    ASSERT_NE(mkdtemp(folder), nullptr);
    fs::current_path(folder);
    (void)tests::shipped_folder_for("left_turn", folder, kDriving_s);
    ASSERT_EQ(
        Process("ip link show vcan0 >/dev/null 2>&1 || ip link add vcan0 type vcan; ip link set vcan0 up")
            .wait(),
        0);
  }
};

}  // namespace s4tp::test
