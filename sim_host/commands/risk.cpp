#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/campaign/threshold.hpp"
#include "sim_host/commands/command.hpp"
#include "sim_host/view/field_picture.hpp"

namespace s4tp::commands {
namespace {

const char* preset_name(sadrf::FieldPreset preset) {
  return preset == sadrf::FieldPreset::kPaper ? "paper" : "kolekar2020";
}

const char* look_ahead_name(sadrf::LookAhead look_ahead) {
  return look_ahead == sadrf::LookAhead::kShrinking ? "shrinking" : "fixed";
}

int draw(CommonOptions& common) {
  const OwnFolder own = common.choose_out();
  std::filesystem::create_directories(common.out);
  for (const sadrf::FieldPreset preset : {sadrf::FieldPreset::kPaper, sadrf::FieldPreset::kKolekar2020}) {
    const std::filesystem::path file = common.out / (std::string("field_") + preset_name(preset) + ".svg");
    view::draw_field_grid(preset, file);
    std::cout << file.string() << '\n';
  }
  return kDone;
}

struct RiskOptions {
  CommonOptions common;
  std::vector<std::string> scenarios{"left_turn", "left_turn_t", "merge", "cruise", "overtake", "cut_in"};
  std::vector<std::string> flavours{"smarts", "social"};
  std::filesystem::path json;
  campaign::CalibrationOptions calibration;
};

nlohmann::ordered_json json_of(const campaign::Calibration& calibration) {
  nlohmann::ordered_json cells = nlohmann::ordered_json::array();
  for (const campaign::ThresholdCell& cell : calibration.cells) {
    cells.push_back({{"preset", preset_name(cell.preset)},
                     {"look_ahead", look_ahead_name(cell.look_ahead)},
                     {"instants", cell.risks.size()},
                     {"p50", cell.percentile(0.5)},
                     {"p90", cell.percentile(0.9)},
                     {"threshold", cell.percentile(0.95)},
                     {"p99", cell.percentile(0.99)}});
  }
  return {{"drives", calibration.drives}, {"left_out", calibration.left_out}, {"cells", cells}};
}

int calibrate(RiskOptions& options) {
  campaign::Calibration calibration = campaign::empty_calibration();
  options.calibration.first_seed = options.common.seed;
  campaign::ConsoleProgress progress(options.flavours.size() * options.scenarios.size() *
                                     static_cast<std::size_t>(options.calibration.episodes));
  for (const std::string& flavour : options.flavours) {
    options.common.flavour = flavour;
    for (const std::string& name : options.scenarios) {
      const scenario::Scenario scenario = options.common.find_scenario(name);
      options.calibration.on_episode = [&](int) { progress.done(name + ", " + flavour); };
      campaign::calibrate(scenario, options.calibration, calibration);
    }
  }
  progress.end();
  if (calibration.cells.front().risks.empty()) {
    throw std::runtime_error("nobody drove for 3.4 s: more --seconds or --episodes");
  }
  std::printf("%d drives, of them %d left out for touching somebody; seeds from %llu\n", calibration.drives,
              calibration.left_out, static_cast<unsigned long long>(options.common.seed));
  std::printf("%-12s %-10s %10s %9s %9s %9s %9s\n", "preset", "look-ahead", "instants", "p50", "p90",
              "p95 = C_t", "p99");
  for (const campaign::ThresholdCell& cell : calibration.cells) {
    std::printf("%-12s %-10s %10zu %9.0f %9.0f %9.0f %9.0f\n", preset_name(cell.preset),
                look_ahead_name(cell.look_ahead), cell.risks.size(),
                static_cast<double>(cell.percentile(0.5)), static_cast<double>(cell.percentile(0.9)),
                static_cast<double>(cell.percentile(0.95)), static_cast<double>(cell.percentile(0.99)));
  }
  if (!options.json.empty()) {
    std::ofstream stream(options.json);
    stream << json_of(calibration).dump(2) << '\n';
    stream.close();
    if (!stream) throw std::runtime_error(options.json.string() + ": cannot be written");
  }
  return kDone;
}

}  // namespace

Command add_risk(CLI::App& tool) {
  CLI::App* risk = tool.add_subcommand("risk", "the driving risk field: its pictures, its threshold");
  const auto options = std::make_shared<RiskOptions>();
  CLI::App* field = risk->add_subcommand("field", "draws the field over speed and steering, both presets");
  options->common.out = std::filesystem::path("out") / "risk";
  options->common.out_named =
      field->add_option("--out", options->common.out, "folder for the pictures (default out/risk)");

  CLI::App* threshold = risk->add_subcommand(
      "calibrate",
      "C_t: 95th percentile of R_obs(t) along collision-free drives of the traffic's own drivers");
  threshold->add_option("--scenarios,--scenario", options->scenarios, "shipped names, folders or .toml files")
      ->delimiter(',');
  threshold->add_option("--flavour", options->flavours, "smarts, social (default: both)")->delimiter(',');
  threshold->add_option("--episodes", options->calibration.episodes, "per scenario and flavour (default 10)")
      ->check(kEpisodes);
  threshold->add_option("--seed,--first-seed", options->common.seed, "first seed (default 0)")->check(kSeed);
  threshold->add_option("--seconds", options->calibration.duration_s, "length of an episode (default 60)")
      ->check(CLI::Range(10.0, 3600.0));
  threshold->add_option("--json", options->json, "write the figures here");
  threshold->add_option("--scenarios-folder", options->common.scenario_root, "where shipped scenarios lie");
  risk->require_subcommand(1);
  return {risk, [=] { return field->parsed() ? draw(options->common) : calibrate(*options); }};
}

}  // namespace s4tp::commands
