#include "sim_host/processes/log_follower.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "firmware/wire/candump.hpp"
#include "firmware/wire/codec.hpp"
#include "sim_host/recording/ticks.hpp"

namespace s4tp::processes {

LogFollower::~LogFollower() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool LogFollower::look(const std::function<void(const std::vector<wire::Frame>&)>& told) {
  if (descriptor_ < 0) descriptor_ = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
  char chunk[4096];
  const ssize_t got = descriptor_ < 0 ? 0 : read(descriptor_, chunk, sizeof chunk);
  if (got <= 0) return false;
  rest_.append(chunk, static_cast<std::size_t>(got));
  std::size_t begin = 0;
  for (std::size_t end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n', begin)) {
    take(rest_.substr(begin, end - begin), told);
    begin = end + 1;
  }
  rest_.erase(0, begin);
  return true;
}

void LogFollower::take(const std::string& line,
                       const std::function<void(const std::vector<wire::Frame>&)>& told) {
  wire::LoggedFrame logged;
  if (wire::parse_candump(line.data(), static_cast<int>(line.size()), logged) != wire::CandumpResult::kFrame)
    return;
  if (recording::sent_by_ecu(logged.frame)) {
    told({logged.frame});
    return;
  }
  frames_.push_back(logged.frame);
  if (logged.frame.id != wire::kTickId) return;
  told(frames_);
  frames_.clear();
}

}  // namespace s4tp::processes
