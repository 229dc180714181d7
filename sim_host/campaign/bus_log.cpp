#include "sim_host/campaign/bus_log.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "algo/core/versions.hpp"
#include "firmware/wire/candump.hpp"

namespace s4tp::campaign {

std::string ecu_note(const std::string& planner, bool guarded, const Parameters& parameters) {
  return "planner " + planner + (guarded ? "" : " bare") + ", parameters " +
         std::to_string(parameters_crc(parameters));
}

BusLog::BusLog(const std::filesystem::path& file, std::uint64_t seed, const std::string& ecu_note)
    : file_(file) {
  std::error_code error;  // opening says what is wrong
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  stream_.open(file);
  stream_ << "# s4tp log: seed " << seed << ", " << ecu_note << (ecu_note.empty() ? "" : ", ") << "wire "
          << int{kWireVersion} << '\n';
  check();
}

void BusLog::write(std::uint64_t time_us, const std::vector<wire::Frame>& frames) {
  for (const wire::Frame& frame : frames) {
    wire::LoggedFrame logged{time_us, "vcan0", frame};
    char line[wire::kCandumpLineSize];
    wire::format_candump(logged, line);
    stream_ << line << '\n';
  }
  check();
}

void BusLog::check() const {
  if (!stream_) throw std::runtime_error(file_.string() + ": cannot write the log: " + std::strerror(errno));
}

}  // namespace s4tp::campaign
