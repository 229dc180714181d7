#pragma once
/// How a driver gets through a junction: whom it waits for, and for whom it brakes late.
///
/// \code
///   the other one                        what the driver does
///   -----------------------------------  ------------------------------------------------------------
///   has right of way                     goes through a gap in time with its margin only, else stops
///                                        at the line
///   the same, and lets it go             goes
///   yields, still before its line        trusts it; from rest, waits until it is gone if it has begun
///   the same, and has waited long        a courteous one stops for some seconds, where comfortable
///   yields, but is inside, in the way    brakes before the shared ground after its reaction time
///   first come, first served             lets it go if it is inside or will be there first
///   all who stand wait for each other    goes if it has waited longest
///   stands in a queue before its line    does not wait for it
///   no room behind the junction          does not enter
///   the driver is inside itself          goes on
/// \endcode

#include "sim_host/world/traffic/traffic_driver.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::traffic {

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
  std::vector<int> waits_for;  ///< whom it waits for
  bool goes_first = false;     ///< all wait for each other, this one the longest
  int lets_go = kNoCar;        ///< id of somebody waiting, for whom it stops out of courtesy
  int hazard = kNoCar;         ///< id of somebody who should not be in the way
  double hazard_m = 0.0;       ///< from the bumper to where the ground shared with it begins
};

/// Whether a car that appeared at the start of this way would surprise somebody who has accepted a gap in a
/// junction close ahead: arms of a network are cut short, drivers would have seen it coming for longer.
[[nodiscard]] bool surprises_at_junction(const TrafficView& view, const std::vector<WayPart>& way);

[[nodiscard]] JunctionChoice choose_at_junction(const TrafficView& view, const Approach& approach);

}  // namespace s4tp::traffic
