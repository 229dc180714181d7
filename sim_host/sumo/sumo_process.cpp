#include "sim_host/sumo/sumo_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <future>
#include <semaphore>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

namespace s4tp::sumo {
namespace {

using namespace std::chrono_literals;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

constexpr int kWordsLines = 6;

}  // namespace

MemoryFile::MemoryFile(const std::string& content) : descriptor_(memfd_create("s4tp", MFD_CLOEXEC)) {
  if (descriptor_ < 0) {
    fail("a file in memory");
  }
  for (std::size_t written = 0; written < content.size();) {
    const ssize_t count = write(descriptor_, content.data() + written, content.size() - written);
    if (count < 0) {
      close(descriptor_);
      fail("a file in memory");
    }
    written += static_cast<std::size_t>(count);
  }
  lseek(descriptor_, 0, SEEK_SET);
}

MemoryFile::~MemoryFile() {
  close(descriptor_);
}

std::string MemoryFile::content() const {
  struct stat about {};
  fstat(descriptor_, &about);
  std::string text(static_cast<std::size_t>(about.st_size), '\0');
  const ssize_t count = pread(descriptor_, text.data(), text.size(), 0);
  text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return text;
}

Process::Process(const std::string& program, const std::vector<std::string>& arguments,
                 const std::string& input)
    : input_(input) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  int failure[2];  // closed by a successful exec, else it carries why not
  if (pipe2(failure, O_CLOEXEC) != 0) {
    fail("a pipe");
  }
  const pid_t our_process = getpid();
  std::promise<pid_t> forked;
  std::future<pid_t> child = forked.get_future();
  parent_ = std::jthread([&, forked = std::move(forked)](const std::stop_token& stop) mutable {
    const pid_t id = fork();
    if (id == 0) {  // only what is safe after a fork among threads
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      setpgid(0, 0);  // an interrupt of ours is ours to handle: we end it in order
      sigset_t none;
      sigemptyset(&none);
      sigprocmask(SIG_SETMASK, &none, nullptr);
      if (getppid() == our_process && dup2(input_.descriptor(), STDIN_FILENO) >= 0 &&
          dup2(output_.descriptor(), STDOUT_FILENO) >= 0 && dup2(output_.descriptor(), STDERR_FILENO) >= 0) {
        execvp(argv[0], argv.data());
      }
      const int why = errno;
      (void)!write(failure[1], &why, sizeof why);
      _exit(127);
    }
    std::binary_semaphore over{0};
    const std::stop_callback when_over(stop, [&] { over.release(); });
    forked.set_value(id < 0 ? -errno : id);  // what was captured by reference is gone from here on
    over.acquire();
  });
  process_ = child.get();
  close(failure[1]);
  int why = 0;
  const bool failed = process_ < 0 || read(failure[0], &why, sizeof why) > 0;
  close(failure[0]);
  if (process_ < 0) {
    errno = -process_;
    fail("starting " + program);
  }
  if (failed) {
    waitpid(process_, nullptr, 0);
    throw std::runtime_error(
        "starting " + program + ": " + std::strerror(why) +
        (why == ENOENT ? "; SUMO's traffic needs Debian's package sumo (apt-get install sumo)" : ""));
  }
}

Process::~Process() {
  if (lives()) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
}

bool Process::lives() {
  ended_ = ended_ || waitpid(process_, nullptr, WNOHANG) != 0;
  return !ended_;
}

void Process::wait_for_end() {
  const auto end = std::chrono::steady_clock::now() + 2s;
  while (lives() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(1ms);
  }
}

std::string Process::last_words() const {
  std::istringstream text(output_.content());
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    if (!line.empty()) {
      lines.push_back(line);
    }
  }
  std::string words;
  for (std::size_t i = lines.size() > kWordsLines ? lines.size() - kWordsLines : 0; i < lines.size(); ++i) {
    words += (words.empty() ? "" : " | ") + lines[i];
  }
  return words.empty() ? "nothing" : words;
}

}  // namespace s4tp::sumo
