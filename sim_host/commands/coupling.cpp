#include <array>
#include <iomanip>
#include <iostream>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/sumo/coupling_floor.hpp"

namespace s4tp::commands {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> scenarios{"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"};
  int episodes = 50;
};

struct Variant {
  const char* name;
  sumo::EgoCoupling coupling;
  int replays = 0;
  int touched = 0;
  int stood = 0;
  double strayed_m = 0.0;
};

/// Each part of the coupling left out in turn, beside all of it and none of it.
std::vector<Variant> variants() {
  const auto without = [](const char* name, auto change) {
    Variant variant;
    variant.name = name;
    change(variant.coupling);
    return variant;
  };
  using Coupling = sumo::EgoCoupling;
  return {without("plain moveToXY", [](Coupling& c) { c.early = c.ahead = c.wishes = c.on_route = false; }),
          without("without early", [](Coupling& c) { c.early = false; }),
          without("without ahead", [](Coupling& c) { c.ahead = false; }),
          without("without wishes", [](Coupling& c) { c.wishes = false; }),
          without("without route", [](Coupling& c) { c.on_route = false; }),
          without("as it is", [](Coupling&) {})};
}

void add(const sumo::Replay& replay, Variant& variant) {
  ++variant.replays;
  variant.touched += replay.touched ? 1 : 0;
  variant.stood += replay.touched && replay.stood ? 1 : 0;
  variant.strayed_m += replay.others_strayed_m;
}

/// Impatient, with short gaps: SUMO's others must cope with an ego that is not like the one they expect.
constexpr const char* kBold =
    "impatience=\"1\" jmTimegapMinor=\"0.3\" tau=\"0.6\" sigma=\"0\" speedFactor=\"1.1\" lcAssertive=\"2\"";

int measure(const Options& options) {
  constexpr std::array<const char*, 2> kDrivers{"", kBold};
  campaign::ConsoleProgress progress(options.scenarios.size() * kDrivers.size() *
                                     static_cast<std::size_t>(options.episodes));
  std::cout << "SUMO's own drives that touched nobody, replayed as an ego it does not drive\n";
  for (const std::string& name : options.scenarios) {
    const scenario::Scenario scenario = options.common.find_scenario(name);
    for (const std::string driver : kDrivers) {
      std::vector<Variant> all = variants();
      int touched = 0;
      int unfinished = 0;
      for (int i = 0; i < options.episodes; ++i) {
        const std::uint64_t seed = options.common.seed + static_cast<std::uint64_t>(i);
        const sumo::Drive drive = sumo::sumo_drive(scenario, seed, driver);
        touched += drive.touched ? 1 : 0;
        unfinished += drive.arrived ? 0 : 1;
        if (!drive.touched) {
          for (Variant& variant : all) add(sumo::replay(scenario, seed, drive, variant.coupling), variant);
        }
        progress.done(name + (driver.empty() ? "" : ", bold driver") + ", seed " + std::to_string(seed));
      }
      std::cout << '\n'
                << name << (driver.empty() ? "" : ", bold driver") << ": " << options.episodes << " drives, "
                << touched << " touched somebody, " << unfinished << " did not arrive\n";
      for (const Variant& v : all) {
        std::cout << "  " << std::left << std::setw(16) << v.name << std::right << std::setw(4) << v.touched
                  << " of " << v.replays << " touched, " << v.stood << " while the ego stood; others strayed "
                  << std::fixed << std::setprecision(2) << v.strayed_m / std::max(v.replays, 1)
                  << " m on average\n";
      }
      std::cout.flush();  // long runs show what they have
    }
  }
  progress.end();
  return kDone;
}

}  // namespace

Command add_coupling(CLI::App& tool) {
  CLI::App* coupling =
      tool.add_subcommand("coupling", "how often SUMO's traffic touches an ego through no fault of its own");
  const auto options = std::make_shared<Options>();
  coupling->add_option("--seed,--first-seed", options->common.seed, "first seed (default 0)")->check(kSeed);
  coupling->add_option("--flavour", options->common.flavour, "smarts (default) or social");
  coupling->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  coupling->add_option("--scenarios", options->scenarios, "shipped names or folders")->delimiter(',');
  coupling->add_option("--episodes", options->episodes, "per scenario and driver (default 50)")
      ->check(kEpisodes);
  return {coupling, [options] { return measure(*options); }};
}

}  // namespace s4tp::commands
