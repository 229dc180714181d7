#pragma once
/// A log of the bus that is still being written, by a system whose memory we do not share.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "firmware/wire/frame.hpp"

namespace s4tp::processes {

/// Reads what is there of a log in candump's format, and later what has come.
class LogFollower {
 public:
  explicit LogFollower(std::filesystem::path file) : file_(std::move(file)) {}
  ~LogFollower();
  LogFollower(const LogFollower&) = delete;
  LogFollower& operator=(const LogFollower&) = delete;

  /// TELE-008 Tells the frames of whole lines as WorldProcessOptions::record does: those of the world tick by
  /// tick, those of the ECU one by one. What is no frame is passed over.
  /// \return false: there is nothing new, or no file yet
  bool look(const std::function<void(const std::vector<wire::Frame>&)>& told);

 private:
  void take(const std::string& line, const std::function<void(const std::vector<wire::Frame>&)>& told);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string rest_;                 ///< of a line that has no end yet
  std::vector<wire::Frame> frames_;  ///< of the world's tick so far
};

}  // namespace s4tp::processes
