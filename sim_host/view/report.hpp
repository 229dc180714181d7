#pragma once
/// The page of a campaign: its table and a picture of every episode that has one.

#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/campaign/results.hpp"

namespace s4tp::view {

/// File name of an episode's picture.
[[nodiscard]] std::string picture_name(const std::string& scenario, const std::string& planner,
                                       std::uint64_t seed);

/// Writes folder/index.html; pictures are looked for beside it under picture_name().
/// \throws std::runtime_error naming the file
void write_report(const std::filesystem::path& folder, const std::vector<campaign::EpisodeRow>& rows);

}  // namespace s4tp::view
