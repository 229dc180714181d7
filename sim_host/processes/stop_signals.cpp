#include "sim_host/processes/stop_signals.hpp"

#include <csignal>

namespace s4tp::processes {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "written by a signal handler");

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    action.sa_handler = [](int) { stop = true; };
    sigaction(signal, &action, nullptr);
  }
  return stop;
}

}  // namespace s4tp::processes
