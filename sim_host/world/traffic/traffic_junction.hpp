#pragma once
/// How a driver gets through a junction: whose way he waits for, and for whom he brakes late.
///
/// \code
///   other one                            what he does
///   -----------------------------------  ------------------------------------------------------------
///   has right of way                     goes through a gap in time with his margin only, else stops
///                                        at the line
///   the same, and lets him go            goes
///   yields, still before his line        trusts him; who stands waits until he is gone if he has begun
///   the same, and has waited long        a courteous one stops for some seconds, where comfortable
///   yields, but is inside, in the way    brakes before the shared ground after his reaction time
///   first come, first served             lets him go if he is inside or will be there first
///   all who stand wait for each other    goes if he has waited longest
///   stands in a queue before his line    does not wait for him
///   no room behind the junction          does not enter
///   he himself is inside                 goes on
/// \endcode

#include "sim_host/world/traffic/traffic_driver.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::world {

/// The driver's own side of it.
struct Approach {
  const Actor* self = nullptr;
  const Driver* driver = nullptr;
  double wanted_mps = 0.0;
  double waited_s = 0.0;    ///< standing near the line so far
  double gave_way_s = 0.0;  ///< time already given to somebody waiting
  int lets_go = kNoCar;     ///< who that is
  bool committed = false;   ///< past the point of no return with a gap accepted
  Leader leader;
};

struct JunctionChoice {
  bool near = false;           ///< there is a junction ahead within sight
  double line_m = 0.0;         ///< from the bumper to the stop line
  bool stop = false;           ///< before the line
  bool queues = false;         ///< stands behind somebody who stands before the line
  std::vector<int> waits_for;  ///< whose way he waits for
  bool goes_first = false;     ///< all wait for each other, he the longest
  int lets_go = kNoCar;        ///< id of somebody waiting, for whom he stops out of courtesy
  int hazard = kNoCar;         ///< id of somebody who should not be in the way
  double hazard_m = 0.0;       ///< from the bumper to where the ground shared with him begins
};

/// Whether a car that appeared at the start of this way would surprise somebody who has accepted a gap in a
/// junction close ahead: arms of a network are cut short, drivers would have seen it coming for longer.
[[nodiscard]] bool surprises_at_junction(const TrafficView& view, const std::vector<WayPart>& way);

[[nodiscard]] JunctionChoice choose_at_junction(const TrafficView& view, const Approach& approach);

}  // namespace s4tp::world
