#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/clips/against_floor.hpp"
#include "sim_host/commands/command.hpp"

namespace s4tp::commands {
namespace {

struct PredictOptions {
  std::filesystem::path clips;
  std::vector<std::string> predictors{clips::forecaster_names()};
  std::filesystem::path weights;
  bool kept = false;
  std::filesystem::path json;
};

void print(const nlohmann::json& run) {
  const nlohmann::json& manoeuvre = run.at("manoeuvre");
  std::printf("%-22s %-12s %7d %6.2f / %.2f %8.2f %7.1f %% %6.2f   %6d %6.2f / %.2f\n",
              run.at("predictor").get<std::string>().c_str(), run.at("family").get<std::string>().c_str(),
              run.at("windows").get<int>(), run.at("ade_3s").get<double>(), run.at("fde_3s").get<double>(),
              run.at("min_ade_3").get<double>(), 100.0 * run.at("miss_rate_2m").get<double>(),
              run.at("nll").get<double>(), manoeuvre.at("windows").get<int>(),
              manoeuvre.at("ade_3s").get<double>(), manoeuvre.at("fde_3s").get<double>());
}

using Families = std::map<std::string, clips::FamilySums>;

// The best of those that know of nobody else.
const clips::WindowSums* best_floor(const std::vector<std::string>& names,
                                    const std::vector<Families>& measured, const std::string& family,
                                    clips::WindowSums clips::FamilySums::*part, std::string& name) {
  const clips::WindowSums* best = nullptr;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == "satp" || names[k] == "kinematic") continue;
    const auto found = measured[k].find(family);
    if (found == measured[k].end() || (found->second.*part).windows == 0) continue;
    if (best != nullptr && best->fde_m <= (found->second.*part).fde_m) continue;
    best = &(found->second.*part);
    name = names[k];
  }
  return best;
}

// FDE of the firmware's predictors over the best floor's, all windows and manoeuvres, interval by vehicle.
void compare_with_floors(const std::vector<std::string>& names, const std::vector<Families>& measured,
                         nlohmann::json& runs) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] != "satp" && names[k] != "kinematic") continue;
    for (const auto& [family, sums] : measured[k]) {
      for (const auto part : {&clips::FamilySums::all, &clips::FamilySums::manoeuvre}) {
        std::string floor;
        const clips::WindowSums* const best = best_floor(names, measured, family, part, floor);
        if (best == nullptr) continue;
        const clips::Ratio ratio = clips::fde_ratio(sums.*part, *best);
        const bool all = part == &clips::FamilySums::all;
        std::printf("%-22s %-12s %s FDE %.2f (%.2f .. %.2f) of %s\n", names[k].c_str(), family.c_str(),
                    all ? "all:       " : "manoeuvres:", ratio.value, ratio.low, ratio.high, floor.c_str());
        for (nlohmann::json& run : runs) {
          if (run.at("predictor") != names[k] || run.at("family") != family) continue;
          (all ? run : run.at("manoeuvre"))["fde_of_best_floor"] = {
              {"floor", floor}, {"ratio", ratio.value}, {"low", ratio.low}, {"high", ratio.high}};
        }
      }
    }
  }
}

int run(const PredictOptions& options) {
  const std::vector<std::filesystem::path> files = clips::clip_files(options.clips);
  nlohmann::json runs = nlohmann::json::array();
  std::printf("%-22s %-12s %7s  ADE / FDE 3 s  minADE  miss 2 m    NLL   of them manoeuvres, ADE / FDE\n",
              "predictor", "family", "windows");
  std::vector<std::unique_ptr<clips::Forecaster>> forecasters;  // all, before the first takes its time
  for (const std::string& name : options.predictors) {
    const bool other = name == "satp" && !options.weights.empty();
    forecasters.push_back(other ? clips::make_satp_forecaster(campaign::bank_with(options.weights))
                                : clips::make_forecaster(name));
  }
  std::vector<Families> measured;
  for (std::size_t k = 0; k < forecasters.size(); ++k) {
    const std::string& name = options.predictors[k];
    clips::ClipFigures figures(*forecasters[k], options.kept);
    campaign::ConsoleProgress progress(files.size());
    for (const std::filesystem::path& file : files) {
      figures.add(clips::load_clip(file));
      progress.done(name + ", clip " + file.filename().string());
    }
    progress.end();
    measured.push_back(figures.families());
    for (const auto& [family, sums] : measured.back()) {
      nlohmann::json run = sums.all.figures();
      run["predictor"] = name;
      run["family"] = family;
      run["manoeuvre"] = sums.manoeuvre.figures();
      print(run);
      runs.push_back(std::move(run));
    }
  }
  compare_with_floors(options.predictors, measured, runs);
  if (!options.json.empty()) campaign::write_json(options.json, {{"runs", runs}});
  return kDone;
}

}  // namespace

Command add_predict(CLI::App& tool) {
  CLI::App* predict = tool.add_subcommand("predict", "predictors measured on recorded clips of real drivers");
  const auto options = std::make_shared<PredictOptions>();
  predict->add_option("--clips", options->clips, "folder of clips (docs/recorded_clips.md)")->required();
  predict->add_option("--predictor,--predictors", options->predictors, "which (default: all)")
      ->delimiter(',');
  predict->add_option("--weights", options->weights, "weight image of satp (default: the build's own)")
      ->check(CLI::ExistingFile);
  predict->add_flag("--kept", options->kept, "only vehicles that ./s4tp train data --clips leaves out");
  predict->add_option("--json", options->json, "write the figures here");
  return {predict, [options] { return run(*options); }};
}

}  // namespace s4tp::commands
