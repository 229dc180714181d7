#include <unistd.h>

#include <iostream>
#include <map>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/processes/stop_signals.hpp"
#include "sim_host/roads/generator.hpp"

namespace s4tp::commands {
namespace {

struct RoadsOptions {
  CommonOptions common;
  int count = 10;
};

int write_roads(const RoadsOptions& options) {
  const std::atomic<bool>& stop = processes::stop_on_signals();
  std::map<std::string, int> families;
  std::map<std::string, int> refused;
  int draws = 0;
  for (int i = 0; i < options.count && !stop; ++i) {
    const roads::WrittenRoad road =
        roads::write_road(options.common.seed + static_cast<std::uint64_t>(i),
                          options.common.scenario_root / "social.toml", options.common.out);
    ++families[road.family];
    std::cout << road.folder.string();
    for (const auto& [reason, times] : road.refused) {
      refused[reason] += times;
      draws += times;
      std::cout << "  (" << times << " x " << reason << ')';
    }
    std::cout << std::endl;
  }
  if (stop) return kInterrupted;
  std::cout << '\n' << options.count << " roads, " << draws << " draws thrown away\n";
  for (const auto& [reason, times] : refused) std::cout << "  " << times << "  " << reason << '\n';
  for (const auto& [family, times] : families) std::cout << times << " of " << family << '\n';
  return kDone;
}

}  // namespace

Command add_roads(CLI::App& tool) {
  CLI::App* roads =
      tool.add_subcommand("roads", "draws roads: scenario folders, each a function of its number");
  const auto options = std::make_shared<RoadsOptions>();
  options->common.out = std::filesystem::path("out") / "roads";
  roads->add_option("--seed", options->common.seed,
                    "number of the first road; the others follow (default 0)");
  roads->add_option("--count", options->count, "how many (default 10)")->check(CLI::PositiveNumber);
  roads->add_option("--out", options->common.out,
                    "a folder FAMILY_NUMBER for each comes here (default out/roads)");
  roads->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  return {roads, [options] { return write_roads(*options); }};
}

}  // namespace s4tp::commands
