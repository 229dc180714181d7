#pragma once
/// Traffic samples put into figures: the same for every engine, so that they can stand side by side.

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sim_host/metrics/traffic_statistics.hpp"

namespace s4tp::metrics {

/// One scenario's traffic as one engine drives it.
struct TrafficRun {
  std::string scenario;
  std::string flavour;
  std::string engine;
  int episodes = 0;
  TrafficSamples samples;
};

[[nodiscard]] nlohmann::ordered_json traffic_json(const std::vector<TrafficRun>& runs);

/// Markdown, one table a scenario and flavour, one column an engine.
void write_traffic_tables(std::ostream& out, const std::vector<TrafficRun>& runs);

}  // namespace s4tp::metrics
