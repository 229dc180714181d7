#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::traffic {

const char* cause_words(Fault fault, Cause cause) {
  const bool ours = fault == Fault::kEgo;
  switch (cause) {
    case Cause::kEntered:
      return ours ? "entered without licence" : "was not given way";
    case Cause::kNoRoom:
      return ours ? "entered without room beyond" : "other entered without room";
    case Cause::kIntoRightful:
      return ours ? "hit one there by right" : "hit while there by right";
    case Cause::kEnteredLater:
      return ours ? "entered after the other" : "entered before the other";
    case Cause::kCutIn:
      return ours ? "cut in" : "was cut in on";
    case Cause::kStopped:
      return "stopped in a live lane";
    case Cause::kRanInto:
      return ours ? "ran into" : "was run into";
    case Cause::kOncoming:
      return ours ? "drove on the wrong side" : "met on its own side";
    case Cause::kChangedLane:
      return ours ? "changed lane into" : "changed lane into us";
    case Cause::kAppeared:
      return "came into the world there";
    case Cause::kUnclear:
      return "unclear";
    case Cause::kNone:
      break;
  }
  return "nothing";
}

}  // namespace s4tp::traffic
