#pragma once
/// Whose fault a touch is and why, from what was recorded and the law alone.
///
/// The first row that fits. "Ours" wherever a row names nobody.
/// | id      | situation                                                                        | at fault       | cause         |
/// |---------|----------------------------------------------------------------------------------|----------------|---------------|
/// | LAW-018 | the other came into the world less than reaction_s ago: nobody answers sooner    | the other      | kAppeared     |
/// | LAW-019 | across or head-on; we have stood for 1 s within our line, with a reason          | the other      | kIntoRightful |
/// |         | (reasons.hpp), on no zone of our way                                             |                |               |
/// | LAW-020 | on a zone; who had to yield entered without licence, or when the other was there | who had to     | kEntered      |
/// | LAW-021 | the same, licensed, but stands there for want of room beyond the group           | who had to     | kNoRoom       |
/// | LAW-022 | the same, licensed; if the other has stood for 1 s, it is who had to             | the other      | kIntoRightful |
/// | LAW-023 | on a zone, first come                                                            | the later one  | kEnteredLater |
/// | LAW-024 | nose to tail; the one in front came into the lane within settle_s, no RSS gap,   | it             | kCutIn        |
/// |         | and did not merge with priority over the one behind, or by its licence           |                |               |
/// | LAW-025 | nose to tail; we are in front and stand for 1 s without reason (reasons.hpp)     | we             | kStopped      |
/// | LAW-026 | nose to tail                                                                     | the one behind | kRanInto      |
/// | LAW-027 | head-on; one is over its line, the other not                                     | the first      | kOncoming     |
/// | LAW-028 | side by side; came over its line in settle_s, or is over it with its centre short  | the last one   | kChangedLane  |
/// |         | of it; of two: who came over later, or has not come yet                          |                |               |
/// | LAW-029 | anything else                                                                    | we             | kUnclear      |

#include <span>

#include "sim_host/world/judge/law.hpp"
#include "sim_host/world/map/network.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::judge {

struct Verdict {
  traffic::Fault fault = traffic::Fault::kNone;
  traffic::Cause cause = traffic::Cause::kNone;
};

/// \param guide    the ego's route
/// \param history  snapshots every 0.1 s up to and including the touch; lanes as engines label them
/// \param other    whom the ego touches
[[nodiscard]] Verdict attribute(const map::Network& network, const map::RouteGuide& guide,
                                std::span<const traffic::Snapshot> history, int other, const Law& law = {});

}  // namespace s4tp::judge
