#include "sim_host/world/scenario/engine.hpp"

#include <algorithm>
#include <stdexcept>

namespace s4tp::scenario {

const std::vector<std::string>& engine_names() {
  static const std::vector<std::string> names{"builtin", "sumo", "adversary"};  // in the order of Engine
  return names;
}

Engine engine_of(const std::string& name) {
  const auto found = std::find(engine_names().begin(), engine_names().end(), name);
  if (found == engine_names().end()) {
    throw std::invalid_argument("traffic \"" + name + "\": there are builtin, sumo and adversary");
  }
  return static_cast<Engine>(found - engine_names().begin());
}

}  // namespace s4tp::scenario
