// The words for how an episode ended, and back.

#include <stdexcept>

#include "sim_host/metrics/metrics.hpp"

namespace s4tp::metrics {
namespace {

using traffic::Ending;

constexpr Ending kEndings[] = {Ending::kRunning, Ending::kGoal,    Ending::kCollision,
                               Ending::kOffRoad, Ending::kTimeOut, Ending::kDeadEcu};

}  // namespace

const char* ending_name(Ending ending) {
  switch (ending) {
    case Ending::kRunning:
      return "running";
    case Ending::kGoal:
      return "goal";
    case Ending::kCollision:
      return "collision";
    case Ending::kOffRoad:
      return "off road";
    case Ending::kTimeOut:
      return "time-out";
    case Ending::kDeadEcu:
      return "dead ECU";
  }
  return "?";
}

Ending ending_of(const std::string& name) {
  for (const Ending ending : kEndings) {
    if (name == ending_name(ending)) return ending;
  }
  throw std::invalid_argument("no ending is called '" + name + "'");
}

}  // namespace s4tp::metrics
