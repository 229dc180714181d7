#pragma once
/// The frames of a drive in candump's format; time is vehicle time. firmware/targets/replay.hpp reads it.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "firmware/wire/frame.hpp"

namespace s4tp::campaign {

/// What its first line says of the ECU; without it the log can only be judged by who knows.
[[nodiscard]] std::string ecu_note(const std::string& planner, bool guarded, const Parameters& parameters);

class BusLog {
 public:
  /// \param ecu_note  may be empty  \throws std::runtime_error naming the file, here and later
  BusLog(const std::filesystem::path& file, std::uint64_t seed, const std::string& ecu_note);

  void write(std::uint64_t time_us, const std::vector<wire::Frame>& frames);
  /// For whoever reads the file meanwhile.
  void flush() { stream_.flush(); }
  /// The planning cycle that started last comes too late.
  void write_deadline_miss() { stream_ << "# miss\n"; }

 private:
  void check() const;

  std::ofstream stream_;
  std::filesystem::path file_;
};

}  // namespace s4tp::campaign
