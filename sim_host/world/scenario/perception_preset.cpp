#include "sim_host/world/scenario/perception_preset.hpp"

#include <stdexcept>

namespace s4tp::scenario {

const std::vector<std::string>& perception_names() {
  static const std::vector<std::string> names{"ideal", "real"};
  return names;
}

PerceptionOptions perception_preset(const std::string& name) {
  PerceptionOptions options;
  if (name == "ideal") return options;
  if (name != "real") throw std::invalid_argument("perception \"" + name + "\": there are ideal and real");
  options.position_noise_m = 0.15;
  options.heading_noise_rad = 0.035;
  options.speed_noise_mps = 0.3;
  options.latency_ticks = 10;
  options.dropout = 0.02;
  options.id_switches_per_s = 0.01;
  options.occlusion = true;
  return options;
}

}  // namespace s4tp::scenario
