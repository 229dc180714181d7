#pragma once
/// What demo and eval have in common: a campaign with progress, table, JSON, a picture of every episode, and
/// the page that shows them.

#include <string>
#include <vector>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/commands/command.hpp"

namespace s4tp::commands {

struct DriveOptions {
  CommonOptions common;
  std::vector<std::string> scenarios{"left_turn", "merge", "cruise", "overtake"};
  std::vector<std::string> planners{"s4tp"};
  int episodes = 20;  ///< per scenario and planner
};

[[nodiscard]] std::vector<campaign::EpisodeRow> drive(const DriveOptions& options);

}  // namespace s4tp::commands
