#include "sim_host/processes/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace s4tp::processes {
namespace {

constexpr int kPatience_ms = 10'000;

/// In the child: only what is allowed after fork().
[[noreturn]] void become(char* const* argv, int report) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  execvp(argv[0], argv);
  const int error = errno;
  (void)!write(report, &error, sizeof error);
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  int pipe_ends[2];  // closed by a successful exec; else it carries the reason
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) throw std::runtime_error(command[0] + ": " + std::strerror(errno));
  process_ = fork();
  if (process_ == 0) become(argv.data(), pipe_ends[1]);
  int error = process_ < 0 ? errno : 0;
  close(pipe_ends[1]);
  if (read(pipe_ends[0], &error, sizeof error) == sizeof error) {
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }
  close(pipe_ends[0]);
  if (error != 0) throw std::runtime_error(command[0] + ": " + std::strerror(error));
}

ChildProcess::~ChildProcess() {
  if (!lives()) return;
  kill(process_, SIGTERM);
  for (int waited_ms = 0; lives(); waited_ms += 10) {
    if (waited_ms == kPatience_ms) kill(process_, SIGKILL);
    usleep(10'000);
  }
}

bool ChildProcess::lives() {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
  return process_ > 0;
}

}  // namespace s4tp::processes
