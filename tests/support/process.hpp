#pragma once
/// A program that a test starts, and what it wrote.

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace s4tp::test {

inline const std::filesystem::path kPrograms = std::filesystem::path(S4TP_BINARY_DIR) / "sim_host";

/// It and all that it starts are a process group.
class Process {
 public:
  /// \param program  path, or name of one of ours
  Process(const std::string& program, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), (kPrograms / program).string());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    EXPECT_EQ(posix_spawn(&process_, argv[0], nullptr, &attributes, argv.data(), environ), 0) << argv[0];
    posix_spawnattr_destroy(&attributes);
  }
  /// A line of shell.
  explicit Process(const std::string& line) : Process("/bin/bash", {"-c", line}) {}
  ~Process() {
    if (process_ > 0) (void)end_all(SIGKILL);
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
  int end_all(int signal) {
    kill(-process_, signal);
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

}  // namespace s4tp::test
