#pragma once
/// What a recording's frames do not say, in a folder beside them, FILE.drive:
///
///   drive.json       which drive of our world it is: seed, traffic, who drove, versions, where it ended
///   parameters.toml  the planner's, as --parameters takes them
///   scenario/        all files of the scenario, as they were
///
/// Not in the frames' file, as candump's format has no comments: python-can takes a line that is no frame for
/// an error.

#include <cstdint>
#include <filesystem>
#include <string>

#include "algo/core/parameters.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::recording {

/// How the frames of world and ECU met.
enum class Meeting { kInProcess, kLockStep, kRealTime };

struct DriveNote {
  std::string scenario;  ///< its name
  std::string flavour;
  std::uint64_t seed = 0;
  std::string traffic = "builtin";
  std::string perception = "ideal";
  std::string planner = "s4tp";  ///< empty: an ECU that was there already
  bool guarded = true;
  Parameters parameters;
  Meeting meeting = Meeting::kInProcess;
  int take_over_tick = 0;   ///< the last of the pre-roll, counted from 1; after it the ECU drives
  std::string versions;     ///< of what recorded it
  std::uint64_t ticks = 0;  ///< 0: it never came to its end
};

/// FILE.drive
[[nodiscard]] std::filesystem::path note_folder(const std::filesystem::path& file);

/// Of this program: API, wire, parameters, weights.
[[nodiscard]] std::string versions_here();

/// With the scenario's files. \throws std::runtime_error naming the file
void write_note(const DriveNote& note, const scenario::Scenario& scenario, const std::filesystem::path& file);
/// The drive has come to its end.
void end_note(const DriveNote& note, const std::filesystem::path& file);

[[nodiscard]] bool has_note(const std::filesystem::path& file);
/// \throws std::runtime_error naming file, key, and what is accepted
[[nodiscard]] DriveNote read_note(const std::filesystem::path& file);

/// The recording's copy. REC-010 Files that are not as they were are refused.
/// \throws std::runtime_error as scenario::load_scenario()
[[nodiscard]] scenario::Scenario scenario_of(const std::filesystem::path& file);
/// FILE.drive/scenario
[[nodiscard]] std::filesystem::path scenario_folder(const std::filesystem::path& file);

/// As --parameters takes them; only what is not as by default.
void write_parameters(const Parameters& parameters, const std::filesystem::path& file);

}  // namespace s4tp::recording
