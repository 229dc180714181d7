#pragma once
/// Why a car may stand in a live lane.

#include <optional>

#include "sim_host/world/judge/evidence.hpp"

namespace s4tp::judge {

enum class Reason {
  kQueue,       ///< somebody close ahead in its way
  kGivesWay,    ///< before a group of zones where it has to yield, or whoever comes first goes
  kLaneChange,  ///< at the last place from which the lane change that the route needs can be made
  kLawBroken,   ///< somebody broke the law before it within the last 3 s
};

/// LAW-030 The ego's at a time, the first that holds; none: it stands without reason.
[[nodiscard]] std::optional<Reason> reason_to_stand(const Law& law, const Evidence& evidence,
                                                    const map::RouteGuide& guide, double time_s);

/// Since when one car has been in the lane ahead of another one; minus infinity: always.
/// \pre both were there at `time_s`
[[nodiscard]] double ahead_since_s(const Journey& front, const Journey& rear, double time_s);

/// Whether one who came into the lane ahead of another one left it the RSS gap. \pre both were there then
[[nodiscard]] bool left_gap(const Law& law, const Journey& front, const Journey& rear, double time_s);

}  // namespace s4tp::judge
