#include "sim_host/campaign/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace s4tp::campaign {
namespace {

constexpr double kPlainLineEvery_s = 10.0;
constexpr std::size_t kBarWidth = 24;
constexpr std::size_t kWhatWidth = 60;

}  // namespace

std::string rough_time(double seconds) {
  if (seconds < 90.0) return std::to_string(std::lround(seconds)) + " s";
  const long minutes = std::lround(seconds / 60.0);
  if (minutes < 90) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

Progress::Progress(std::ostream& out, bool terminal, std::size_t total, std::size_t already)
    : out_(out), terminal_(terminal), total_(total), already_(already) {}

void Progress::done(double elapsed_s, const std::string& what) {
  ++done_;
  const std::size_t all = already_ + done_;
  const double left_s = elapsed_s / static_cast<double>(done_) * static_cast<double>(total_ - all);
  const std::string counts =
      std::to_string(all) + "/" + std::to_string(total_) + ", " + rough_time(left_s) + " left";
  if (terminal_) {
    const std::size_t full = kBarWidth * all / std::max<std::size_t>(total_, 1);
    out_ << "\r\x1b[K[" << std::string(full, '#') << std::string(kBarWidth - full, '.') << "] " << counts
         << "  " << what.substr(0, kWhatWidth) << std::flush;
  } else if (done_ == 1 || all == total_ || elapsed_s >= last_line_s_ + kPlainLineEvery_s) {
    out_ << counts << "  " << what << std::endl;
    last_line_s_ = elapsed_s;
  }
}

ConsoleProgress::ConsoleProgress(std::size_t total, std::size_t already)
    : progress_(std::cerr, isatty(STDERR_FILENO) != 0, total, already) {}

double ConsoleProgress::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::end() {
  if (terminal_ && done_ > 0) out_ << '\n';
}

}  // namespace s4tp::campaign
