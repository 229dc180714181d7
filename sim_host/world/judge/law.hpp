#pragma once
/// The law of the road as the world's judge states it: what drivers owe each other, and when one may enter
/// against priority. It measures traffic, says whose fault a touch was, and binds the legal adversary; no
/// planner took part in it and none is asked.
///
/// |    | who                 | owes                                                                     |
/// |----|---------------------|--------------------------------------------------------------------------|
/// | D1 | who has to give way | not to enter a group of zones before one with priority without licence,  |
/// |    |                     | if the car could still stop when the duty began, or began anew           |
/// | D2 | everybody           | not to drive into what is there by right and has been in sight for       |
/// |    |                     | `reaction_s`, if the car could stop; inside a junction owed only to what |
/// |    |                     | is ahead                                                                 |
/// | D3 | who changes lane    | RSS gaps to the new leader and the new follower when its centre is on    |
/// |    |                     | the line                                                                 |
/// | D4 | a follower          | the RSS gap, from `settle_s` after the one ahead came into the lane      |
///
/// | id      |       | one may enter before one with priority                                        |
/// |---------|-------|-------------------------------------------------------------------------------|
/// | LAW-001 | clear | who will be gone before the other, driving as fast as it may, is there        |
/// | LAW-002 | L1    | if the other, driving as fast as it may, can still stop gently, and sees one  |
/// | LAW-003 | L2    | if the other stands and has seen one's nose at the line for `shown_s`; where  |
/// |         |       | both have stood for `deadlock_s` any one may                                  |
///
/// LAW-005 The duty begins anew when a licence is lost, as when the other sets off: whoever cannot stop any more then goes in
/// by the licence it had, and the other is bound by it; so is whoever comes into the world after that and can stop.
///
/// A zone is ground that two lanes share (map::Conflict); a group is all zones between two places where a
/// car can stand without being on any (standing.hpp). At first-come zones nothing is owed before somebody is
/// inside. Source: method.md 4.9; RSS: Shalev-Shwartz, Shammah, Shashua 2017.

namespace s4tp::judge {

/// RSS along a lane: the one behind answers after `reaction_s`, until then gaining speed, and brakes with at
/// least `braking_mps2`; the one ahead brakes with at most `front_braking_mps2`.
struct Rss {
  double reaction_s = 0.5;
  double acceleration_mps2 = 2.0;
  double braking_mps2 = 5.0;
  double front_braking_mps2 = 8.0;
};

/// The judge's fixed values.
struct Law {
  double acceleration_mps2 = 3.2;   ///< hardest to be reckoned with
  double over_limit = 1.2;          ///< times the speed limit, up to which a car may speed up
  double duty_braking_mps2 = 4.0;   ///< owed for D1 and D2
  double reaction_s = 1.0;          ///< after it, once a duty
  double settle_s = 2.0;            ///< a newcomer has been ahead so long before its follower owes the gap
  double asked_braking_mps2 = 2.0;  ///< what L1 may ask of the other
  double asked_after_s = 1.5;
  double shown_s = 0.7;
  double shown_within_m = 4.0;  ///< of the group: there the nose can be seen
  double deadlock_s = 2.0;
  double standing_mps = 0.3;  ///< below it a car stands
  Rss rss;
};

/// Least gap bumper to bumper, >= 0.
[[nodiscard]] double rss_gap_m(const Rss& rss, double rear_mps, double front_mps);

/// Way to a standstill: `delay_s` at `acceleration_mps2`, no faster than `top_mps`, then braking.
[[nodiscard]] double stopping_m(double speed_mps, double delay_s, double acceleration_mps2, double top_mps,
                                double braking_mps2);

/// A car that knows its duty can fulfil it: D1 and D2 bind.
[[nodiscard]] bool can_stop(const Law& law, double speed_mps, double distance_m);

/// Speed a car may reach: that of the law, or the one it has.
[[nodiscard]] double top_speed_mps(const Law& law, double speed_mps, double limit_mps);

enum class Licence { kNone, kClear, kCanStop, kStands };

/// One who enters a group of zones, and another one with priority at a zone of it, at one instant.
struct Entry {
  bool merging = false;          ///< both end up in one lane
  double gone_after_s = 0.0;     ///< the entering car has left the zone
  double gone_mps = 0.0;         ///< how fast it then drives
  double other_to_zone_m = 0.0;  ///< of its box centre; <= 0: inside
  double other_to_end_m = 0.0;
  double other_mps = 0.0;
  double other_limit_mps = 13.89;
  double bumpers_m = 5.0;      ///< half of both lengths
  bool in_sight = true;        ///< of the other
  double shown_s = 0.0;        ///< the nose has been at the line, in sight
  double other_stood_s = 0.0;  ///< 0: moves
  double both_stood_s = 0.0;
};

/// The first of LAW-001, LAW-002 and LAW-003 that holds. Merging, "gone" asks for the RSS gap behind it.
[[nodiscard]] Licence licence_of(const Law& law, const Entry& entry);

}  // namespace s4tp::judge
