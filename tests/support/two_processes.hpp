#pragma once
/// World and ECU as programs that a test starts, a cable between them, and the same drive inside the test's process.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include "sim_host/campaign/episode.hpp"
#include "tests/support/content.hpp"
#include "tests/support/drive_time.hpp"
#include "tests/support/process.hpp"

namespace s4tp::test {

namespace fs = std::filesystem;

/// Without the first line, which says more of the ECU where it is known.
inline std::string frames_of(const fs::path& log) {
  const std::string text = content(log);
  return text.substr(text.find('\n') + 1);
}

/// In a folder that goes with the test program.
inline fs::path scratch(const std::string& name) {
  static const struct Folder {
    fs::path path = fs::temp_directory_path() / ("s4tp_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
  } folder;
  return folder.path / name;
}

/// The scenario of that name, as long as this test needs it.
inline fs::path folder_of(const std::string& scenario) {
  return tests::shipped_folder_for(scenario, scratch("scenarios"));
}

inline fs::path in_process(const std::string& scenario, std::uint64_t seed) {
  const fs::path log = scratch("inside.log");
  campaign::EpisodeOptions options;
  options.seed = seed;
  options.log = log;
  (void)campaign::run_episode(scenario::load_scenario(folder_of(scenario)), options);
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

}  // namespace s4tp::test
