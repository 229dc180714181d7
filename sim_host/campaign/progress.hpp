#pragma once
/// How far a campaign is: a bar with the time left on a terminal, now and then a plain line elsewhere.

#include <chrono>
#include <cstddef>
#include <ostream>
#include <string>

namespace s4tp::campaign {

class Progress {
 public:
  /// \param already  of `total`, done before this start
  Progress(std::ostream& out, bool terminal, std::size_t total, std::size_t already);
  /// One more episode is done. \param elapsed_s  since the start  \param what  it was and how it ended
  void done(double elapsed_s, const std::string& what);
  /// Leaves the bar's line.
  void end();

 private:
  std::ostream& out_;
  bool terminal_;
  std::size_t total_;
  std::size_t already_;
  std::size_t done_ = 0;
  double last_line_s_ = 0.0;
};

/// The same of this program, on its error output and by the clock.
class ConsoleProgress {
 public:
  explicit ConsoleProgress(std::size_t total, std::size_t already = 0);
  void done(const std::string& what) { progress_.done(elapsed_s(), what); }
  void end() { progress_.end(); }
  [[nodiscard]] double elapsed_s() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Progress progress_;
};

/// "45 s", "12 min", "3 h 20 min"
[[nodiscard]] std::string rough_time(double seconds);

}  // namespace s4tp::campaign
