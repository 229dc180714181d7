#include "sim_host/train/conditioning.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "sim_host/train/figures.hpp"

namespace s4tp::train {
namespace {

using Place = std::array<double, 2>;

constexpr double kDiffersM = 2.0;
constexpr double kPhantomM = 0.3;
constexpr double kTrulySameM = 0.2;
constexpr double kUntouchedM = 0.5;
constexpr int kBins = 10;

double length(const Place& place) {
  return std::hypot(place[0], place[1]);
}
Place operator-(const Place& a, const Place& b) {
  return {a[0] - b[0], a[1] - b[1]};
}
double dot(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1];
}

Place true_end(const Sample& sample, int vehicle) {
  const float(&pose)[3] = sample.target.pose[vehicle][kHorizonSteps - 1];
  return {pose[0], pose[1]};
}

double log_likelihood(const Forecast& forecast, const Place& truth, double sigma_m) {
  VehicleErrors errors;
  for (int mode = 0; mode < kMaxModes; ++mode) {
    const float(&place)[2] = forecast.position_m[mode][kHorizonSteps - 1];
    errors.probability[mode] = static_cast<double>(forecast.probability[mode]);
    errors.end_m[mode] = length(Place{place[0], place[1]} - truth);
  }
  return -negative_log_likelihood(errors, sigma_m);
}

struct Pairs {
  RoadMean told_apart;
  RoadMean phantom;
  RoadMean phantom_in_hindsight;
  RoadMean untouched;
  double both = 0.0;  ///< sums of true . predicted, predicted squared, true squared
  double predicted = 0.0;
  double truth = 0.0;
  int count = 0;

  void add(const Sample& first, const Sample& second, int vehicle, const Forecast& under_first,
           const Forecast& under_second, double sigma_m) {
    const Place end_first = true_end(first, vehicle);
    const Place end_second = true_end(second, vehicle);
    const Place really = end_first - end_second;
    const Place expected = under_first.mean_end() - under_second.mean_end();
    both += dot(really, expected);
    predicted += dot(expected, expected);
    truth += dot(really, really);
    ++count;
    if (length(really) >= kDiffersM) {
      for (const Place& end : {end_first, end_second}) {
        const double gain =
            log_likelihood(under_first, end, sigma_m) - log_likelihood(under_second, end, sigma_m);
        told_apart.add(first.road, (end == end_first ? gain : -gain) > 0.0 ? 1.0 : 0.0);
      }
    }
    if (first.input.paths_meet[vehicle] == 0)
      phantom.add(first.road, length(expected) < kPhantomM ? 1.0 : 0.0);
    if (first.interacts[vehicle] == 0 && second.interacts[vehicle] == 0) {
      phantom_in_hindsight.add(first.road, length(expected) < kPhantomM ? 1.0 : 0.0);
    } else if (length(really) < kTrulySameM) {
      untouched.add(first.road, length(expected) < kUntouchedM ? 1.0 : 0.0);
    }
  }
};

nlohmann::ordered_json share_of(const RoadMean& mean) {
  return {{"share", mean.mean()}, {"half_width", mean.half_width()}, {"count", mean.count()}};
}

}  // namespace

nlohmann::ordered_json conditioning_figures(const SampleSet& set, const std::vector<std::size_t>& samples,
                                            const Forecasts& forecasts, double sigma_m) {
  std::map<std::uint64_t, std::vector<std::size_t>> forks;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if ((set[samples[i]].flags & kForked) != 0) forks[set[samples[i]].fork].push_back(i);
  }
  Pairs pairs;
  for (const auto& [fork, branches] : forks) {
    for (std::size_t a = 0; a < branches.size(); ++a) {
      for (std::size_t b = a + 1; b < branches.size(); ++b) {
        const Sample& first = set[samples[branches[a]]];
        const Sample& second = set[samples[branches[b]]];
        for (int vehicle = 0; vehicle < std::min(first.input.hdvs, second.input.hdvs); ++vehicle) {
          if (!judged(first, vehicle) || !judged(second, vehicle)) continue;
          const auto at = static_cast<std::size_t>(vehicle);
          pairs.add(first, second, vehicle, forecasts[branches[a]][at], forecasts[branches[b]][at], sigma_m);
        }
      }
    }
  }
  nlohmann::ordered_json result{{"forks", forks.size()},
                                {"pairs", pairs.count},
                                {"told_apart", share_of(pairs.told_apart)},
                                {"phantom", share_of(pairs.phantom)},
                                {"phantom_in_hindsight", share_of(pairs.phantom_in_hindsight)},
                                {"untouched", share_of(pairs.untouched)}};
  if (pairs.predicted > 0.0 && pairs.truth > 0.0) {
    result["slope"] = pairs.both / pairs.predicted;
    result["explained"] = pairs.both * pairs.both / (pairs.predicted * pairs.truth);
  }
  return result;
}

nlohmann::ordered_json gate_figures(const SampleSet& set, const std::vector<std::size_t>& samples,
                                    const Forecasts& forecasts) {
  RoadMean meets, apart, shut;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = set[samples[i]];
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) {
      const double gate = static_cast<double>(forecasts[i][static_cast<std::size_t>(vehicle)].gate);
      (sample.interacts[vehicle] != 0 ? meets : apart).add(sample.road, gate);
      shut.add(sample.road, gate == 0.0 ? 1.0 : 0.0);
    }
  }
  const auto json = [](const RoadMean& mean) {
    return nlohmann::ordered_json{
        {"mean", mean.mean()}, {"half_width", mean.half_width()}, {"count", mean.count()}};
  };
  return {{"shares_something", json(meets)}, {"shares_nothing", json(apart)}, {"shut", json(shut)}};
}

nlohmann::ordered_json yield_figures(const SampleSet& set, const std::vector<std::size_t>& samples,
                                     const Forecasts& forecasts) {
  struct One {
    double expected;
    double happened;
    SampleRule rule;
  };
  std::vector<One> all;
  std::map<SampleRule, std::pair<double, double>> base;  // yielded, all
  int collided = 0;
  int unsettled = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = set[samples[i]];
    if ((sample.flags & kForked) == 0 || (sample.flags & kEgoGoes) == 0) continue;
    for (int vehicle = 0; vehicle < sample.input.hdvs; ++vehicle) {
      if (sample.rule[vehicle] == SampleRule::kNoZone) continue;
      if (sample.yields[vehicle] < 0) {
        ++unsettled;
        continue;
      }
      collided += (sample.flags & kCollided) != 0 ? 1 : 0;
      const double happened = sample.yields[vehicle] == 1 ? 1.0 : 0.0;
      all.push_back({forecasts[i][static_cast<std::size_t>(vehicle)].yield_probability(), happened,
                     sample.rule[vehicle]});
      base[sample.rule[vehicle]].first += happened;
      base[sample.rule[vehicle]].second += 1.0;
    }
  }
  if (all.empty()) return {{"count", 0}};
  double ours = 0.0;
  double by_class = 0.0;
  double expected[kBins] = {}, happened[kBins] = {}, count[kBins] = {};
  for (const One& one : all) {
    const auto& [yielded, of] = base[one.rule];
    ours += (one.expected - one.happened) * (one.expected - one.happened);
    by_class += (yielded / of - one.happened) * (yielded / of - one.happened);
    const int bin = std::min(static_cast<int>(one.expected * kBins), kBins - 1);
    expected[bin] += one.expected;
    happened[bin] += one.happened;
    count[bin] += 1.0;
  }
  double error = 0.0;
  nlohmann::ordered_json bins = nlohmann::ordered_json::array();
  for (int i = 0; i < kBins; ++i) {
    if (count[i] == 0.0) continue;
    error += std::abs(expected[i] - happened[i]) / static_cast<double>(all.size());
    bins.push_back(
        {{"count", count[i]}, {"expected", expected[i] / count[i]}, {"happened", happened[i] / count[i]}});
  }
  return {{"count", all.size()},
          {"of_collided_branches", collided},
          {"unsettled", unsettled},
          {"error", error},
          {"brier_skill", by_class > 0.0 ? 1.0 - ours / by_class : 0.0},
          {"bins", bins}};
}

}  // namespace s4tp::train
