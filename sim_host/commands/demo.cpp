#include <algorithm>
#include <iostream>

#include "sim_host/campaign/results.hpp"
#include "sim_host/commands/drive.hpp"

namespace s4tp::commands {
namespace {

/// The promises of the demo. Fewer than 20 episodes a cell are too few for its rates: then only that nobody
/// was hit through our fault, and that the ECU was never silent.
int judge_demo(const std::vector<campaign::EpisodeRow>& rows) {
  constexpr int kEnough = 20;
  bool good = true;
  int own_fault = 0;
  int episodes = 0;
  const auto demand = [&](bool holds, const std::string& what) {
    if (!holds) std::cout << "FALLS SHORT: " << what << '\n';
    good = good && holds;
  };
  for (const campaign::ResultCell& cell : campaign::summarize(rows)) {
    const metrics::Summary& s = cell.summary;
    const int lost = s.episodes - s.goals;
    demand(s.dead_ecu == 0, "the ECU fell silent in " + cell.scenario);
    if (cell.planner == "s4tp") {
      own_fault += s.with_own_fault;
      episodes += s.episodes;
    }
    if (s.episodes < kEnough) continue;
    if (cell.planner == "s4tp") {
      demand(20 * s.goals >= 16 * s.episodes, "s4tp reaches fewer than 16 of 20 goals in " + cell.scenario);
    } else if (cell.scenario == "left_turn") {
      demand(20 * lost >= 6 * s.episodes,
             cell.planner + " loses fewer than 6 of 20 left turns: traffic is too tame");
    } else if (cell.scenario == "merge") {
      demand(20 * lost >= 4 * s.episodes,
             cell.planner + " loses fewer than 4 of 20 merges: traffic is too tame");
    }
  }
  demand(80 * own_fault <= std::max(episodes, 80), "s4tp causes more than one collision in 80 episodes");
  return good ? 0 : kNotGoodEnough;
}

}  // namespace

Command add_demo(CLI::App& tool) {
  CLI::App* demo = tool.add_subcommand("demo", "the four scenarios, s4tp beside two careless drivers");
  const auto options = std::make_shared<DriveOptions>();
  options->common.out = std::filesystem::path("out") / "demo";
  options->planners = {"s4tp", "constant_speed", "blind"};
  options->common.add_to(*demo);
  demo->add_option("--episodes", options->episodes, "per scenario and planner (default 20)")
      ->check(CLI::PositiveNumber);
  return {demo, [options] { return judge_demo(drive(*options)); }};
}

}  // namespace s4tp::commands
