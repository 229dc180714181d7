#pragma once
/// How long a drive has to be for what a test looks for.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::tests {

/// Under the thread sanitizer, which takes ten times as long, it is races: after 3 s of driving every exchange has
/// been made thirty times at least, most of them hundreds. 0: to its own end.
inline constexpr double kDriven_s =
#ifdef __SANITIZE_THREAD__
    3.0;
#else
    0.0;
#endif

/// A shipped scenario, no longer than `seconds`; 0: as it is.
inline scenario::Scenario shipped_for(const std::string& name, double seconds = kDriven_s) {
  scenario::Scenario scenario =
      scenario::load_scenario(std::filesystem::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name);
  if (seconds > 0.0) scenario.mission.time_limit_s = seconds;
  return scenario;
}

/// The same as a folder in `scratch`, for programs that are told of it.
inline std::filesystem::path shipped_folder_for(const std::string& name, const std::filesystem::path& scratch,
                                                double seconds = kDriven_s) {
  namespace fs = std::filesystem;
  const fs::path shipped = fs::path(S4TP_SOURCE_DIR) / "sim_host" / "scenarios" / name;
  if (seconds <= 0.0) return shipped;
  const fs::path copy = scratch / name;
  fs::create_directories(scratch);
  fs::copy(shipped, copy, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  fs::copy(shipped.parent_path() / "social.toml", scratch / "social.toml",
           fs::copy_options::overwrite_existing);
  std::ostringstream text;
  std::ifstream given(copy / "scenario.toml");
  for (std::string line; std::getline(given, line);) {
    if (line.rfind("time_limit_s", 0) == 0) line = "time_limit_s = " + std::to_string(seconds);
    text << line << '\n';
  }
  given.close();
  std::ofstream(copy / "scenario.toml") << text.str();
  return copy;
}

}  // namespace s4tp::tests
