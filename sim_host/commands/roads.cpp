#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <stdexcept>

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
  std::cout << '\n'
            << options.count << " roads in " << std::filesystem::absolute(options.common.out).string() << ", "
            << draws << " draws thrown away\n";
  for (const auto& [reason, times] : refused) std::cout << "  " << times << "  " << reason << '\n';
  for (const auto& [family, times] : families) std::cout << times << " of " << family << '\n';
  return kDone;
}

/// "N:K"
bool is_range(const std::string& text, std::uint64_t& first, int& count) {
  unsigned long long number = 0;
  char end = 0;
  if (std::sscanf(text.c_str(), "%llu:%d%c", &number, &count, &end) != 2) return false;
  first = number;
  return text.front() >= '0' && text.front() <= '9' && count > 0;
}

}  // namespace

std::vector<std::string> road_folders(const std::string& text, const std::filesystem::path& scenario_root,
                                      const std::filesystem::path& out) {
  namespace fs = std::filesystem;
  std::vector<std::string> folders;
  std::uint64_t first = 0;
  int count = 0;
  if (fs::is_directory(text)) {
    for (const auto& entry : fs::directory_iterator(text)) {
      const bool hidden = entry.path().filename().string().front() == '.';  // one that is being written
      if (!hidden && fs::is_regular_file(entry.path() / "scenario.toml")) folders.push_back(entry.path());
    }
  } else if (is_range(text, first, count)) {
    campaign::ConsoleProgress progress(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const auto number = first + static_cast<std::uint64_t>(i);
      folders.push_back(roads::write_road(number, scenario_root / "social.toml", out).folder);
      progress.done("road " + std::to_string(number) + " drawn");
    }
    progress.end();
  }
  if (folders.empty()) {
    throw std::invalid_argument(
        "--roads " + text + ": accepted is a folder of scenario folders, or N:K, K roads from number N on");
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

Command add_roads(CLI::App& tool) {
  CLI::App* roads =
      tool.add_subcommand("roads", "draws roads: scenario folders, each a function of its number");
  const auto options = std::make_shared<RoadsOptions>();
  options->common.out = std::filesystem::path("out") / "roads";
  roads->add_option("--seed", options->common.seed, "number of the first road; the others follow (default 0)")
      ->check(kSeed);
  roads->add_option("--count", options->count, "how many (default 10)")->check(CLI::PositiveNumber);
  roads->add_option("--out", options->common.out,
                    "a folder FAMILY_NUMBER for each comes here (default out/roads)");
  roads->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  return {roads, [options] { return write_roads(*options); }};
}

}  // namespace s4tp::commands
