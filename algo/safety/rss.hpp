#pragma once
/// Responsibility-sensitive safety as a response (method.md 4.10): from tracks and map, never predictions.
/// Source: Shalev-Shwartz et al. 2017, definitions 1, 6 and the proper response.
///
/// \code
///   rear --v_r-->  [   d_long   ]  front --v_f-->     safe: gap >= d_long(v_r, v_f)
/// \endcode
/// Longitudinal: for whoever is ahead of us in our strip of the road, and only there: he who comes from
/// behind is obliged himself (RSS-003). Who leaves that strip in time answers by steering (RSS-009).
/// Junctions: right of way over crossing and oncoming traffic is the guard's (guard.hpp), and
/// so is not changing lanes into somebody's safe distance.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// What we may do while a situation is unsafe. No restriction: the vehicle's own limits.
struct RssEnvelope {
  float acceleration_max_mps2;  ///< upper bound; negative: a braking that is due
  float lateral_left_max_mps;   ///< largest lateral speed to the left (relative to our lane); 0: none
  float lateral_right_max_mps;
  bool active = false;       ///< any restriction
  std::uint8_t agent = 255;  ///< who caused the strictest one
};

/// Smallest safe longitudinal distance of a follower behind a leader, same direction [m] (definition 1,
/// RSS-001).
[[nodiscard]] float safe_distance_m(float rear_speed_mps, float front_speed_mps,
                                    const Parameters& parameters);

/// Smallest safe lateral distance, speeds positive towards each other [m] (definition 6,
/// RSS-002).
[[nodiscard]] float safe_lateral_m(float speed_a_mps, float speed_b_mps, const Parameters& parameters);

/// The proper response to every unsafe pair now. It is as soft as keeps a follower out of reach of a leader
/// that brakes at b_max at any moment (RSS-004): from 0 at the safe distance to b_min where the response time
/// is used up; more only when even that is too late. So a cut-in asks for braking, not for a stop (RSS-005).
/// Beside somebody nearer than the safe lateral distance: no lateral speed towards him (RSS-006). No braking
/// for a leader whose strip `plan` leaves for good, and keeps clear of though he brakes at b_max from now on
/// and comes towards us as definition 6 lets him: laterally it is safe before longitudinally it is not
/// (RSS-009).
[[nodiscard]] RssEnvelope rss_envelope(const Scene& scene, const Trajectory& plan,
                                       const Parameters& parameters);

/// Clips the trajectory's accelerations to the envelope over the first second, and lets it gain no speed
/// afterwards; the path stays, driven later (RSS-007). An inactive envelope changes nothing (RSS-008). The
/// lateral bounds cannot be met on a given path: they are for whoever shapes one. \return whether anything
/// changed
bool clip_to_envelope(const RssEnvelope& envelope, const Parameters& parameters, Trajectory& trajectory);

}  // namespace s4tp
