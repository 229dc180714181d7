#pragma once
/// How the ego met others, by the judge's fixed values (world/judge/law.hpp): never by a planner's opinion.

#include "sim_host/world/judge/evidence.hpp"

namespace s4tp::metrics {

/// Two cars that meet at a zone and come over the same ground within this time: a near miss, unless they
/// touch. Source: Allen, Shin, Cooper 1978 (post-encroachment time); below 1 s is the usual limit of a
/// conflict.
inline constexpr double kNearMiss_s = 1.0;
/// Below it an encounter was close.
inline constexpr double kCloseEncroachment_s = 1.5;
/// Nearer than this in time somebody is pressed.
inline constexpr double kPressed_s = 1.5;
/// Times beyond this are nobody's concern and count as this.
inline constexpr double kApart_s = 10.0;

struct Encounters {
  /// MET-001 Least time between one car's leaving a place and another one's being there, at a zone both pass,
  /// in whole snapshots; 0 when their boxes are there at once, kApart_s when nobody was met.
  double min_post_encroachment_s = kApart_s;
  int near_misses = 0;  ///< MET-002 cars met so within kNearMiss_s and not touched
  /// MET-003 Least time gap in which others come near: at zones as above; of one behind the ego in its lane;
  /// and of the ego behind one that has been ahead for less than Law::settle_s. Whoever is behind drives 3
  /// m/s or more.
  double min_time_gap_s = kApart_s;
  /// MET-004 Hardest braking of any car while the ego is what it reacts to: next ahead in its way, or on a
  /// zone of its way where it need not yield, nearer than 2 s and a gentle braking of 2 m/s^2 take. >= 0
  double imposed_braking_mps2 = 0.0;
  double mean_gap_m = 0.0;  ///< to the next car ahead in our lane; 0 when there never was one
  /// MET-005 Of the time: nearer to it than RSS allows, and it came in more than 1 s ago.
  double rss_violation_share = 0.0;
  int rss_violations = 0;  ///< how many times that began
};

/// \param evidence  with the ego, up to where it counts  \param from_s  since when it counts
[[nodiscard]] Encounters encounters_of(const judge::Law& law, const judge::Evidence& evidence, double from_s);

}  // namespace s4tp::metrics
