#include "sim_host/train/evaluation.hpp"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "sim_host/train/conditioning.hpp"
#include "sim_host/train/figures.hpp"
#include "sim_host/train/image_export.hpp"
#include "sim_host/train/predict.hpp"
#include "sim_host/train/reliability_plot.hpp"
#include "sim_host/train/trainer.hpp"

namespace s4tp::train {
namespace {

// One predictor's lines of the table, and its figures for the file.
nlohmann::ordered_json judge(const char* name, const Judged& judged, const Judged& reference) {
  nlohmann::ordered_json figures = figures_by_group(judged, reference);
  for (const auto& [scenario, of] : figures.items()) {
    const auto mean = [&](const char* figure) { return of[figure]["mean"].get<double>(); };
    const auto half = [&](const char* figure) { return of[figure]["half_width"].get<double>(); };
    std::printf(
        "%-22s %-12s %8zu %6.3f +- %.3f %9.3f %7.3f %7.3f %7.3f %7.3f   %+.3f +- %.3f   %+.3f +- %.3f\n",
        name, scenario.c_str(), of["vehicles"].get<std::size_t>(), mean("top_1_ade"), half("top_1_ade"),
        mean("weighted_ade"), mean("min_ade"), mean("top_1_fde"), mean("min_fde"), mean("nll"),
        mean("top_1_ade_less_reference"), half("top_1_ade_less_reference"), mean("nll_less_reference"),
        half("nll_less_reference"));
  }
  return figures;
}

}  // namespace

void evaluate(const satp::NetworkShape& shape, const EvaluationOptions& options) {
  if (options.checkpoint.empty() && options.image.empty()) {
    throw std::runtime_error("nothing to judge: neither a checkpoint nor an image");
  }
  const SampleSet set = samples_to_learn_from(options.data);
  const std::vector<std::size_t> calibration = samples_of(set, Part::kCalibration);
  SampleSet fresh_set;
  if (!options.fresh.empty()) fresh_set = SampleSet(options.fresh);
  const SampleSet& judged_set = options.fresh.empty() ? set : fresh_set;
  std::vector<std::size_t> samples = samples_of(judged_set, Part::kValidation);
  if (!options.fresh.empty()) {
    for (const Part part : {Part::kTraining, Part::kCalibration}) {
      const auto more = samples_of(judged_set, part);
      samples.insert(samples.end(), more.begin(), more.end());
    }
  }
  std::shared_ptr<Network> network;
  double temperature = 1.0;
  if (!options.checkpoint.empty()) {
    network = load_network(shape, options.checkpoint);
    network->to(best_device());
    temperature = calibrated_temperature(*network, set, calibration);
    calibrate_yields(*network, set, calibration, temperature);
    std::printf("temperature %.3f, ", temperature);
  }
  std::printf(
      "calibrated on %zu samples; %zu samples judged\n\n%-22s %-12s %8s %15s %9s %7s %7s %7s %7s   %-18s "
      "%s\n",
      calibration.size(), samples.size(), "predictor", "scenario", "vehicles", "top-1 ADE [m]", "weighted",
      "nearest", "FDE", "nearest", "NLL", "ADE less kinematic", "NLL less kinematic");
  const auto judged_by = [&](auto&& forecasts_of, const Forecasts& forecasts) {
    return Judged{errors_of(judged_set, samples, forecasts),
                  fitted_sigma_m(errors_of(set, calibration, forecasts_of(set, calibration)))};
  };
  const Judged kinematic = judged_by(kinematic_forecasts, kinematic_forecasts(judged_set, samples));
  nlohmann::ordered_json result;
  if (network) result["temperature"] = temperature;
  const auto add = [&](const char* name, auto&& forecasts_of) {
    Forecasts forecasts = forecasts_of(judged_set, samples);
    const Judged judged = judged_by(forecasts_of, forecasts);
    result["predictors"][name] = judge(name, judged, kinematic);
    std::fflush(stdout);
    result["width_m"][name] = judged.sigma_m;  // of its likelihoods
    return std::pair(std::move(forecasts), judged.sigma_m);
  };
  const auto network_of = [&](bool with_plan) {
    return [&network, temperature, with_plan](const SampleSet& of, const std::vector<std::size_t>& which) {
      return network_forecasts(*network, of, which, with_plan, temperature);
    };
  };
  add("constant velocity", steady_forecasts);
  add("kinematic", kinematic_forecasts);
  add("kinematic, 3 speeds", kinematic_variants);
  // What a plan does to a forecast, and what is promised of it; each with the width fitted for itself.
  const auto condition = [&](const char* name, const Forecasts& planned, double sigma_m) {
    nlohmann::ordered_json& figures = result["conditioned"][name];
    figures["conditioning"] = conditioning_figures(judged_set, samples, planned, sigma_m);
    figures["gate"] = gate_figures(judged_set, samples, planned);
    figures["yields"] = yield_figures(judged_set, samples, planned);
    for (const auto& [figure, value] : figures.items())
      std::printf("%s: %s %s\n", name, figure.c_str(), value.dump().c_str());
  };
  if (network) {
    add("satp, no plan", network_of(false));
    const auto [planned, sigma_m] = add("satp, our plan", network_of(true));
    condition("satp", planned, sigma_m);
  }
  if (!options.image.empty()) {
    const std::vector<std::uint32_t> image = read_image(options.image);
    const auto image_of = [&image](bool with_plan) {
      return [&image, with_plan](const SampleSet& of, const std::vector<std::size_t>& which) {
        return image_forecasts(image, of, which, with_plan);
      };
    };
    add("image, no plan", image_of(false));
    const auto [planned, sigma_m] = add("image, our plan", image_of(true));
    condition("image", planned, sigma_m);
  }
  if (!options.plot.empty()) {
    const char* drawn = network ? "satp, our plan" : "image, our plan";
    std::vector<Reliability> curves{
        {"futures, by probability", result["predictors"][drawn]["all"]["reliability"]}};
    for (const auto& [name, figures] : result["conditioned"].items())
      curves.push_back({"p(yields, we go), " + name, figures["yields"]["bins"]});
    draw_reliability(curves, options.plot);
  }
  if (!options.json.empty()) {
    std::ofstream out(options.json);
    out << result.dump(1) << '\n';
    if (!out) throw std::runtime_error(options.json.string() + " cannot be written");
  }
}

}  // namespace s4tp::train
