#include "sim_host/train/figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

namespace s4tp::train {
namespace {

constexpr double kNormal95 = 1.96;
constexpr double kMissM = 2.0;
constexpr int kBins = 10;

nlohmann::ordered_json json_of(const RoadMean& mean) {
  return {{"mean", mean.mean()}, {"half_width", mean.half_width()}};
}

void judge(const Sample& sample, int vehicle, const Forecast& forecast, VehicleErrors& errors) {
  errors.road = sample.road;
  errors.scenario = sample.scenario;
  errors.rule = sample.rule[vehicle];
  errors.min_ade_m = 1e9;
  errors.min_fde_m = 1e9;
  for (int mode = 0; mode < kMaxModes; ++mode) {
    errors.probability[mode] = static_cast<double>(forecast.probability[mode]);
    if (forecast.probability[mode] <= 0.0F) continue;
    double sum_m = 0.0;
    int steps = 0;
    for (int i = 0; i < kHorizonSteps; ++i) {
      if ((sample.target.valid[vehicle] >> static_cast<unsigned>(i) & 1U) == 0) continue;
      const float(&truth)[3] = sample.target.pose[vehicle][i];
      const float(&place)[2] = forecast.position_m[mode][i];
      errors.end_m[mode] =
          std::hypot(static_cast<double>(place[0]) - truth[0], static_cast<double>(place[1]) - truth[1]);
      sum_m += errors.end_m[mode];
      ++steps;
    }
    const double ade_m = sum_m / steps;
    errors.weighted_ade_m += errors.probability[mode] * ade_m;
    if (ade_m < errors.min_ade_m) {
      errors.min_ade_m = ade_m;
      errors.nearest = mode;
    }
    errors.min_fde_m = std::min(errors.min_fde_m, errors.end_m[mode]);
    if (mode == forecast.likeliest()) {
      errors.top_1_ade_m = ade_m;
      errors.top_1_fde_m = errors.end_m[mode];
    }
  }
}

nlohmann::ordered_json reliability_of(const std::vector<VehicleErrors>& errors) {
  struct Bin {
    double expected = 0.0;
    double happened = 0.0;
    int count = 0;
  } bins[kBins];
  for (const VehicleErrors& one : errors) {
    for (int mode = 0; mode < kMaxModes; ++mode) {
      if (one.probability[mode] <= 0.0) continue;
      Bin& bin = bins[std::min(static_cast<int>(one.probability[mode] * kBins), kBins - 1)];
      bin.expected += one.probability[mode];
      bin.happened += mode == one.nearest ? 1.0 : 0.0;
      ++bin.count;
    }
  }
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (int i = 0; i < kBins; ++i) {
    if (bins[i].count == 0) continue;
    result.push_back({{"from", static_cast<double>(i) / kBins},
                      {"to", static_cast<double>(i + 1) / kBins},
                      {"count", bins[i].count},
                      {"expected", bins[i].expected / bins[i].count},
                      {"happened", bins[i].happened / bins[i].count}});
  }
  return result;
}

}  // namespace

bool judged(const Sample& sample, int vehicle) {
  const bool seen = (sample.target.valid[vehicle] >> static_cast<unsigned>(kHorizonSteps - 1) & 1U) != 0;
  return seen && sample.kinematic[vehicle].probability[0] > 0.0F;
}

void RoadMean::add(std::uint64_t road, double value) {
  Sum& sum = sums_[road];
  sum.value += value;
  sum.count += 1.0;
}

double RoadMean::count() const {
  double count = 0.0;
  for (const auto& [road, sum] : sums_) count += sum.count;
  return count;
}

double RoadMean::mean() const {
  double value = 0.0;
  for (const auto& [road, sum] : sums_) value += sum.value;
  return sums_.empty() ? 0.0 : value / count();
}

double RoadMean::half_width() const {
  const auto roads = static_cast<double>(sums_.size());
  if (roads < 2.0) return 0.0;
  const double centre = mean();
  double squares = 0.0;
  for (const auto& [road, sum] : sums_) {
    const double off = sum.value - centre * sum.count;
    squares += off * off;
  }
  return kNormal95 * std::sqrt(roads / (roads - 1.0) * squares) / count();
}

std::vector<VehicleErrors> errors_of(const SampleSet& set, const std::vector<std::size_t>& samples,
                                     const Forecasts& forecasts) {
  std::vector<VehicleErrors> result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = set[samples[i]];
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) {
      if (!judged(sample, vehicle)) continue;
      judge(sample, vehicle, forecasts[i][static_cast<std::size_t>(vehicle)], result.emplace_back());
    }
  }
  return result;
}

double negative_log_likelihood(const VehicleErrors& errors, double sigma_m) {
  const double variance = sigma_m * sigma_m;
  // The nearest mode's exponent is taken out, so that what is far off is still told apart.
  double nearest_m = 1e9;
  for (int mode = 0; mode < kMaxModes; ++mode) {
    if (errors.probability[mode] > 0.0) nearest_m = std::min(nearest_m, errors.end_m[mode]);
  }
  double sum = 0.0;
  for (int mode = 0; mode < kMaxModes; ++mode) {
    const double off = errors.end_m[mode] * errors.end_m[mode] - nearest_m * nearest_m;
    sum += errors.probability[mode] * std::exp(-std::max(off, 0.0) / (2.0 * variance));
  }
  return nearest_m * nearest_m / (2.0 * variance) + std::log(2.0 * std::numbers::pi * variance) -
         std::log(sum);
}

double fitted_sigma_m(const std::vector<VehicleErrors>& errors) {
  const auto loss = [&](double log_sigma) {
    double sum = 0.0;
    for (const VehicleErrors& one : errors) sum += negative_log_likelihood(one, std::exp(log_sigma));
    return sum;
  };
  double low = std::log(0.05);
  double high = std::log(20.0);
  for (int i = 0; i < 40; ++i) {  // thirds: 1e-7 of the range
    const double left = low + (high - low) / 3.0;
    const double right = high - (high - low) / 3.0;
    (loss(left) < loss(right) ? high : low) = loss(left) < loss(right) ? right : left;
  }
  return std::exp(0.5 * (low + high));
}

nlohmann::ordered_json figures_of(const std::vector<VehicleErrors>& errors, double sigma_m) {
  RoadMean top_1, weighted, nearest, top_1_end, nearest_end, missed, likelihood;
  for (const VehicleErrors& one : errors) {
    top_1.add(one.road, one.top_1_ade_m);
    weighted.add(one.road, one.weighted_ade_m);
    nearest.add(one.road, one.min_ade_m);
    top_1_end.add(one.road, one.top_1_fde_m);
    nearest_end.add(one.road, one.min_fde_m);
    missed.add(one.road, one.min_fde_m > kMissM ? 1.0 : 0.0);
    likelihood.add(one.road, negative_log_likelihood(one, sigma_m));
  }
  return {{"vehicles", errors.size()},
          {"roads", top_1.roads()},
          {"top_1_ade", json_of(top_1)},
          {"weighted_ade", json_of(weighted)},
          {"min_ade", json_of(nearest)},
          {"top_1_fde", json_of(top_1_end)},
          {"min_fde", json_of(nearest_end)},
          {"miss_rate_2m", json_of(missed)},
          {"nll", json_of(likelihood)},
          {"sigma", sigma_m},
          {"reliability", reliability_of(errors)}};
}

namespace {

nlohmann::ordered_json figures_of_group(const Judged& of, const Judged& reference,
                                        const std::function<bool(const VehicleErrors&)>& belongs) {
  std::vector<VehicleErrors> part;
  RoadMean distance, likelihood;
  for (std::size_t i = 0; i < of.errors.size(); ++i) {
    const VehicleErrors& one = of.errors[i];
    const VehicleErrors& other = reference.errors[i];
    if (!belongs(one)) continue;
    part.push_back(one);
    distance.add(one.road, one.top_1_ade_m - other.top_1_ade_m);
    likelihood.add(one.road, negative_log_likelihood(one, of.sigma_m) -
                                 negative_log_likelihood(other, reference.sigma_m));
  }
  if (part.empty()) return {};
  nlohmann::ordered_json result = figures_of(part, of.sigma_m);
  result["top_1_ade_less_reference"] = json_of(distance);
  result["nll_less_reference"] = json_of(likelihood);
  return result;
}

}  // namespace

nlohmann::ordered_json figures_by_group(const Judged& of, const Judged& reference) {
  nlohmann::ordered_json result;
  const auto add = [&](const char* name, const std::function<bool(const VehicleErrors&)>& belongs) {
    nlohmann::ordered_json figures = figures_of_group(of, reference, belongs);
    if (figures.empty()) return;
    for (int i = 0; i <= static_cast<int>(SampleRule::kFirstCome); ++i) {
      const auto rule = static_cast<SampleRule>(i);
      nlohmann::ordered_json part = figures_of_group(
          of, reference, [&](const VehicleErrors& one) { return one.rule == rule && belongs(one); });
      if (!part.empty()) figures["right_of_way"][name_of(rule)] = std::move(part);
    }
    result[name] = std::move(figures);
  };
  add("all", [](const VehicleErrors&) { return true; });
  for (int i = 0; i <= static_cast<int>(SampleScenario::kGenerated); ++i) {
    const auto scenario = static_cast<SampleScenario>(i);
    add(name_of(scenario), [&](const VehicleErrors& one) { return one.scenario == scenario; });
  }
  return result;
}

const char* name_of(SampleRule rule) {
  switch (rule) {
    case SampleRule::kNoZone:
      return "no_zone";
    case SampleRule::kYields:
      return "yields";
    case SampleRule::kHasPriority:
      return "has_priority";
    case SampleRule::kFirstCome:
      break;
  }
  return "first_come";
}

const char* name_of(SampleScenario scenario) {
  switch (scenario) {
    case SampleScenario::kLeftTurn:
      return "left_turn";
    case SampleScenario::kLeftTurnT:
      return "left_turn_t";
    case SampleScenario::kMerge:
      return "merge";
    case SampleScenario::kCruise:
      return "cruise";
    case SampleScenario::kOvertake:
      return "overtake";
    case SampleScenario::kCutIn:
      return "cut_in";
    case SampleScenario::kGenerated:
      return "generated";
    case SampleScenario::kOther:
      break;
  }
  return "other";
}

}  // namespace s4tp::train
