#pragma once
/// Roads by number.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace s4tp::roads {

struct WrittenRoad {
  std::string family;
  std::filesystem::path folder;
  std::map<std::string, int> refused;  ///< why drawn again, and how often
};

/// ROAD-001 Draws road `number` and writes it as the scenario folder OUT/FAMILY_NUMBER: network,
/// scenario.toml in both flavours, the mix of drivers of `social`. The same number gives the same bytes, with
/// the same netconvert and the same mix, whatever else is drawn; a folder of that name is replaced, whole or
/// not at all. ROAD-002 What netconvert or the reader of scenarios refuses, and a mission that no car can
/// drive (mission_check.hpp), is drawn again from the number's own stream. \param mix  the shipped
/// social.toml, copied  \throws std::runtime_error when it cannot be written, or netconvert is missing, or a
/// hundred draws were refused
WrittenRoad write_road(std::uint64_t number, const std::filesystem::path& mix,
                       const std::filesystem::path& out);

/// ROAD-004 The family of a scenario: its name without the number after the last underscore; a name that has
/// none is a family of its own.
[[nodiscard]] std::string family_of(const std::string& scenario);

}  // namespace s4tp::roads
