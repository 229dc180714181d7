#pragma once
/// Where a car may stand: on no ground that it shares with others.
///
/// \code
///   line |<- may stand ->|###### group ######|<- may stand ->|## group ##|
///        '--- lane through the junction, along its centre ---------------'
/// \endcode
/// LAW-004 A legal place to stand is one where the car's box is on no zone of its way; between two of them a
/// place counts from half a metre on. Everything between two such places is one group: it is entered as a
/// whole or not at all.

#include <span>
#include <vector>

#include "sim_host/world/judge/journey.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::judge {

/// A zone as the box centre meets it, in metres of the way (`Stretch::start_m`); grown by what the car is
/// longer than 5 m.
struct ZoneOnWay {
  map::LaneId lane = map::kNoLane;
  traffic::Meeting meeting;
  double entry_m = 0.0;
  double exit_m = 0.0;
};

struct ZoneGroup {
  double entry_m = 0.0;
  double exit_m = 0.0;
  std::vector<ZoneOnWay> zones;  ///< by entry
};

/// All groups of a way, in order.
[[nodiscard]] std::vector<ZoneGroup> zone_groups(const traffic::RoadIndex& road, std::span<const Stretch> way,
                                                 double length_m);

/// \param at_m  of the box centre on the way
[[nodiscard]] bool may_stand(std::span<const ZoneGroup> groups, double at_m);

/// What a zone's arc lengths are of another car, for its length.
[[nodiscard]] double longer_by_m(double length_m);

}  // namespace s4tp::judge
