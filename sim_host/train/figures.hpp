#pragma once
/// How far forecasts were off, with 95 % intervals clustered by road: what happens on one road is alike.

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "sim_host/train/forecast.hpp"

namespace s4tp::train {

/// A mean over things that come in roads.
class RoadMean {
 public:
  void add(std::uint64_t road, double value);
  [[nodiscard]] double mean() const;
  /// Half of the 95 % interval, from the roads' deviations (a ratio estimator's variance); 0 for one road.
  [[nodiscard]] double half_width() const;
  [[nodiscard]] double count() const;
  [[nodiscard]] std::size_t roads() const { return sums_.size(); }

 private:
  struct Sum {
    double value = 0.0;
    double count = 0.0;
  };
  std::map<std::uint64_t, Sum> sums_;
};

/// Whether a vehicle was seen at 3 s and there is a kinematic forecast to compare with; others are not
/// judged.
[[nodiscard]] bool judged(const Sample& sample, int vehicle);

/// Errors of one vehicle's forecast, over the steps seen.
struct VehicleErrors {
  std::uint64_t road = 0;
  SampleScenario scenario = SampleScenario::kOther;
  SampleRule rule = SampleRule::kNoZone;
  double top_1_ade_m = 0.0;     ///< mean distance of the likeliest mode
  double weighted_ade_m = 0.0;  ///< of all modes, by probability
  double min_ade_m = 0.0;       ///< of the nearest mode
  double top_1_fde_m = 0.0;     ///< distance of the likeliest mode at 3 s
  double min_fde_m = 0.0;
  double probability[kMaxModes] = {};
  double end_m[kMaxModes] = {};  ///< distance at 3 s
  int nearest = 0;               ///< mode of min_ade
};

/// In the order of samples and vehicles: the same for every predictor, so that they pair.
[[nodiscard]] std::vector<VehicleErrors> errors_of(const SampleSet& set,
                                                   const std::vector<std::size_t>& samples,
                                                   const Forecasts& forecasts);

/// Negative log-likelihood of the true position at 3 s, each mode a round Gaussian of `sigma_m`.
[[nodiscard]] double negative_log_likelihood(const VehicleErrors& errors, double sigma_m);
/// The width that makes them likeliest on average, 0.05 .. 20 m.
[[nodiscard]] double fitted_sigma_m(const std::vector<VehicleErrors>& errors);

/// {"vehicles", "roads", "top_1_ade": {"mean", "half_width"}, ..., "reliability": [{"from", "to", "count",
/// "expected", "happened"}]}: how often the mode of such a probability was the nearest
[[nodiscard]] nlohmann::ordered_json figures_of(const std::vector<VehicleErrors>& errors, double sigma_m);

/// A predictor's errors and the width its likelihoods are taken with.
struct Judged {
  std::vector<VehicleErrors> errors;
  double sigma_m = 1.0;
};

/// The same over all and per scenario, in each by right of way ("right_of_way": {"has_priority", ...}), and the paired differences of top-1 ADE and of negative log-likelihood to
/// `reference`, each likelihood with its own width. \pre both of the same vehicles
[[nodiscard]] nlohmann::ordered_json figures_by_group(const Judged& of, const Judged& reference);

[[nodiscard]] const char* name_of(SampleScenario scenario);
[[nodiscard]] const char* name_of(SampleRule rule);

}  // namespace s4tp::train
