#pragma once
/// The page of one or more campaigns: success by scenario and planner, times and gaps, the tables, and every
/// failure with its replay or the command that drives it again.

#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/campaign/records.hpp"
#include "sim_host/view/failure_replays.hpp"

namespace s4tp::view {

struct Report {
  const campaign::Records& records;
  const Replays& replays;               ///< of failures, beside the page
  std::filesystem::path replay_folder;  ///< where, from the page's folder
  std::vector<std::string> notes;       ///< what a reader should know, a line each
};

/// File name of an episode's picture.
[[nodiscard]] std::string picture_name(const std::string& scenario, const std::string& planner,
                                       std::uint64_t seed);

/// Writes folder/index.html. Pictures of episodes are shown that lie beside it under picture_name().
/// \throws std::runtime_error naming the file
void write_report(const Report& report, const std::filesystem::path& folder);

}  // namespace s4tp::view
