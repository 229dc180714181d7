#include "sim_host/metrics/clusters.hpp"

#include <algorithm>

namespace s4tp::metrics {
namespace {

Cluster sum_of(const std::vector<Cluster>& clusters) {
  Cluster all;
  for (const Cluster& cluster : clusters) {
    all.episodes += cluster.episodes;
    all.sum += cluster.sum;
    all.squares += cluster.squares;
  }
  return all;
}

}  // namespace

void Cluster::add(double value) {
  ++episodes;
  sum += value;
  squares += value * value;
}

double design_effect(const std::vector<Cluster>& clusters) {
  const Cluster seen = sum_of(clusters);
  const double roads = static_cast<double>(clusters.size());
  const double size = seen.episodes / roads;
  const double episodes = seen.episodes + size;
  const double sum = seen.sum + 0.5 * size;
  const double mean = sum / episodes;
  const double simple =
      seen.squares + 0.5 * size - sum * mean;                // sum of squared deviations, episode by episode
  const auto between = [&](double of_road, double number) {  // the same, road by road
    return (of_road - mean * number) * (of_road - mean * number);
  };
  double clustered = between(0.5 * size, size);
  for (const Cluster& cluster : clusters) clustered += between(cluster.sum, cluster.episodes);
  clustered *= (roads + 1.0) / roads;
  return std::max(1.0, clustered / simple);
}

Interval clustered_wilson(const std::vector<Cluster>& failures) {
  const Cluster all = sum_of(failures);
  const double effect = design_effect(failures);
  return wilson(all.sum / effect, all.episodes / effect);
}

}  // namespace s4tp::metrics
