#include <algorithm>
#include <array>
#include <iostream>
#include <stdexcept>
#include <string_view>

#include "sim_host/campaign/parameters_file.hpp"
#include "sim_host/campaign/record_limits.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::commands {
namespace {

/// Digits, and no number above the limit.
CLI::Validator whole(std::uint64_t low, std::uint64_t high) {
  const std::string accepted = std::to_string(low) + " to " + std::to_string(high);
  return {[=](const std::string& text) {
            const bool digits = !text.empty() && text.size() < 20 &&
                                text.find_first_not_of("0123456789") == std::string::npos;
            const bool good = digits && std::stoull(text) >= low && std::stoull(text) <= high;
            return good ? std::string() : text + ": accepted is a whole number, " + accepted;
          },
          accepted};
}

}  // namespace

const CLI::Validator kSeed = whole(0, campaign::kSeedMax - campaign::kEpisodesMax);
const CLI::Validator kEpisodes = whole(1, campaign::kEpisodesMax);

std::vector<std::string> with_lists_joined(const std::vector<std::string>& arguments) {
  constexpr std::array<std::string_view, 2> kLists{"--scenario", "--scenarios"};
  std::vector<std::string> joined;
  bool in_list = false;  // after a list's option
  bool has_one = false;  // and after its first name
  for (const std::string& word : arguments) {
    if (!word.empty() && word.front() == '-') {
      const std::string_view name = std::string_view(word).substr(0, word.find('='));
      in_list = std::find(kLists.begin(), kLists.end(), name) != kLists.end();
      has_one = in_list && name.size() < word.size();
      joined.push_back(word);
    } else if (in_list && has_one) {
      joined.back() += "," + word;
    } else {
      has_one = in_list;
      joined.push_back(word);
    }
  }
  return joined;
}

OwnFolder CommonOptions::choose_out() {
  return processes::choose_folder(out, out_named != nullptr && out_named->count() > 0);
}

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--seed,--first-seed", seed, "first seed (default " + std::to_string(seed) + ")")
      ->check(kSeed);
  command.add_option("--parameters", parameters_file, "TOML file of planner parameters (docs/parameters.md)");
  out_named = command.add_option("--out", out, "folder for pictures, JSON and report");
  command.add_option("--flavour", flavour,
                     "of the scenario: smarts (default: as written), social, or another it has");
  command.add_option("--scenarios-folder", scenario_root, "where shipped scenarios lie");
}

void CommonOptions::add_traffic_to(CLI::App& command) {
  command
      .add_option("--traffic", traffic,
                  "who simulates it: builtin (default), sumo (Debian's sumo), or adversary: the worst that "
                  "the law allows")
      ->check(CLI::IsMember(scenario::engine_names()));
}

Parameters CommonOptions::parameters() const {
  return parameters_file.empty() ? Parameters{} : campaign::load_parameters(parameters_file);
}

scenario::Scenario CommonOptions::find_scenario(const std::string& name) const {
  scenario::Scenario scenario =
      scenario::load_scenario(scenario::scenario_path(scenario_root, name), flavour);
  for (const std::string& note : scenario.notes) std::cerr << "note: " << note << '\n';
  return scenario;
}

}  // namespace s4tp::commands
