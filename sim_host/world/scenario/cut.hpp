#pragma once
/// A drive of our world from one of its ticks on (docs/recording.md): the world is that drive's, and until
/// that tick its vehicle does what was recorded. Every command that drives a scenario drives a cut.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/wire/frame.hpp"

namespace s4tp::scenario {

class TomlTable;

struct Cut {
  std::filesystem::path of;  ///< the scenario that was driven
  std::string flavour;
  std::uint64_t seed = 0;
  std::string traffic = "builtin";   ///< engine_names()
  std::string perception = "ideal";  ///< perception_names()
  std::filesystem::path commands_file;
  int start_tick = 0;                              ///< counted from the pre-roll's first
  std::vector<std::vector<wire::Frame>> commands;  ///< what reached the vehicle in each tick before
};

/// A cut's seed, flavour, traffic and perception go before those a command asks for.
/// \param table  [cut]  \param file  whose it is \throws std::runtime_error as load_scenario()
[[nodiscard]] Cut read_cut(TomlTable table, const std::filesystem::path& file);

/// Writes `folder`/scenario.toml and what it needs beside the scenario `cut.of`, which has to lie below.
/// \param heading  for its first line \throws std::runtime_error naming the file
void write_cut(const Cut& cut, const std::string& heading, const std::filesystem::path& folder);

}  // namespace s4tp::scenario
