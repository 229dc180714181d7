#include "sim_host/faults/isolation.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace s4tp::faults {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

std::string to_line(const RunResult& result) {
  return json{{"outcome", result.verdict.outcome},
              {"breach", result.verdict.breach},
              {"tick", result.verdict.tick},
              {"what", result.verdict.what},
              {"ending", result.ending},
              {"own_fault", result.own_fault},
              {"modes", result.modes}}
      .dump();
}

RunResult from_line(const std::string& line) {
  const json data = json::parse(line);
  RunResult result;
  data.at("outcome").get_to(result.verdict.outcome);
  data.at("breach").get_to(result.verdict.breach);
  data.at("tick").get_to(result.verdict.tick);
  data.at("what").get_to(result.verdict.what);
  data.at("ending").get_to(result.ending);
  data.at("own_fault").get_to(result.own_fault);
  data.at("modes").get_to(result.modes);
  return result;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  if (end == std::string::npos) return "";
  const std::size_t begin = text.find_last_of('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? -1 : begin));
}

[[noreturn]] void serve(const FaultScript& script, const Runner& runner, int out) {
  dup2(out, STDERR_FILENO);
  int code = 0;
  std::string answer;
  try {
    answer = to_line(runner(script));
  } catch (const std::exception& error) {
    answer = error.what();
    code = 1;
  }
  answer = "\n" + answer + "\n";
  for (std::size_t written = 0; written < answer.size();) {
    const ssize_t n = write(out, answer.data() + written, answer.size() - written);
    if (n <= 0) _exit(2);
    written += static_cast<std::size_t>(n);
  }
  _exit(code);
}

class Child {
 public:
  Child(std::size_t script_index, const FaultScript& script, const Runner& runner, double limit_s)
      : index(script_index),
        deadline_(Clock::now() +
                  std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit_s))) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
    process_ = fork();
    if (process_ < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
    if (process_ == 0) serve(script, runner, ends[1]);
    close(ends[1]);
    out_ = ends[0];
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    close(out_);
  }

  [[nodiscard]] int out() const { return out_; }
  [[nodiscard]] bool overdue() const { return Clock::now() >= deadline_; }

  /// \return whether it has said all it will
  bool read_some() {
    char buffer[4096];
    const ssize_t n = read(out_, buffer, sizeof buffer);
    if (n > 0) text_.append(buffer, static_cast<std::size_t>(n));
    return n == 0 || (n < 0 && errno != EINTR);
  }

  /// \pre read_some() answered true, or it is overdue
  RunResult result() {
    RunResult result;
    if (overdue()) kill(process_, SIGKILL);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    const std::string last = last_line(text_);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return from_line(last);
    if (overdue()) {
      result.verdict.breach = Breach::kHang;
      result.verdict.what = "no end in sight";
    } else {
      result.verdict.breach = Breach::kCrash;
      result.verdict.what =
          (WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status)) : std::string("exception")) +
          ": " + last;
    }
    return result;
  }

  const std::size_t index;

 private:
  Clock::time_point deadline_;
  int process_ = -1;
  int out_ = -1;
  std::string text_;
};

}  // namespace

void run_isolated(const std::vector<FaultScript>& scripts, const Runner& runner,
                  const IsolationOptions& options,
                  const std::function<bool(std::size_t index, const RunResult& result)>& on_done) {
  constexpr int kLook_ms = 200;
  std::vector<std::unique_ptr<Child>> children;
  std::size_t next = 0;
  bool more = true;
  while ((more && next < scripts.size()) || !children.empty()) {
    while (more && next < scripts.size() && static_cast<int>(children.size()) < std::max(options.jobs, 1)) {
      children.push_back(std::make_unique<Child>(next, scripts[next], runner, options.limit_s));
      ++next;
    }
    std::vector<pollfd> waits;
    for (const auto& child : children) waits.push_back({child->out(), POLLIN, 0});
    poll(waits.data(), waits.size(), kLook_ms);
    std::vector<std::unique_ptr<Child>> running;
    for (std::size_t i = 0; i < children.size(); ++i) {
      const bool ended = (waits[i].revents != 0 && children[i]->read_some()) || children[i]->overdue();
      if (!ended) {
        running.push_back(std::move(children[i]));
      } else if (!on_done(children[i]->index, children[i]->result())) {
        more = false;
      }
    }
    children = std::move(running);
  }
}

}  // namespace s4tp::faults
