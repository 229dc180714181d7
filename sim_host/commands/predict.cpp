#include <iostream>
#include <nlohmann/json.hpp>

#include "sim_host/campaign/progress.hpp"
#include "sim_host/campaign/results.hpp"
#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/clips/figures.hpp"
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
  for (std::size_t k = 0; k < forecasters.size(); ++k) {
    const std::string& name = options.predictors[k];
    clips::ClipFigures figures(*forecasters[k], options.kept);
    campaign::ConsoleProgress progress(files.size());
    for (const std::filesystem::path& file : files) {
      figures.add(clips::load_clip(file));
      progress.done(name + ", clip " + file.filename().string());
    }
    progress.end();
    for (const auto& [family, sums] : figures.families()) {
      nlohmann::json run = sums.all.figures();
      run["predictor"] = name;
      run["family"] = family;
      run["manoeuvre"] = sums.manoeuvre.figures();
      print(run);
      runs.push_back(std::move(run));
    }
  }
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
