// The words for how an episode ended, and back.

#include <stdexcept>

#include "sim_host/metrics/metrics.hpp"

namespace s4tp::metrics {
namespace {

constexpr world::Ending kEndings[] = {world::Ending::kRunning,   world::Ending::kGoal,
                                      world::Ending::kCollision, world::Ending::kOffRoad,
                                      world::Ending::kTimeOut,   world::Ending::kDeadEcu};

}  // namespace

const char* ending_name(world::Ending ending) {
  switch (ending) {
    case world::Ending::kRunning:
      return "running";
    case world::Ending::kGoal:
      return "goal";
    case world::Ending::kCollision:
      return "collision";
    case world::Ending::kOffRoad:
      return "off road";
    case world::Ending::kTimeOut:
      return "time-out";
    case world::Ending::kDeadEcu:
      return "dead ECU";
  }
  return "?";
}

world::Ending ending_of(const std::string& name) {
  for (const world::Ending ending : kEndings) {
    if (name == ending_name(ending)) return ending;
  }
  throw std::invalid_argument("no ending is called '" + name + "'");
}

}  // namespace s4tp::metrics
