#pragma once
/// How a plain driver follows, and which gaps it accepts.
///
/// Sources: IDM: Treiber et al. 2000; lane change: MOBIL's two criteria, Kesting et al. 2007. Acceleration,
/// headway and gap are those of SUMO's passenger cars. Its braking, 4.5 m/s^2, is the pressed one here: who
/// brakes for every stop as late as that is stopped by any guard that wants comfort.

#include "algo/trajectory/along_path.hpp"

namespace s4tp::baselines {

struct IdmDriver {
  float acceleration_mps2 = 2.6F;     ///< a
  float braking_mps2 = 2.0F;          ///< b, comfortable
  float headway_s = 1.0F;             ///< T
  float standstill_gap_m = 2.5F;      ///< s0
  float pressed_braking_mps2 = 4.5F;  ///< the same where the change must be made soon, or is under way
  float asked_braking_mps2 = 3.0F;    ///< MOBIL's b_safe: what a change may ask of the one behind, and of us
  float change_gain_mps2 = 1.0F;  ///< MOBIL's threshold: what a change that the route does not need must gain
  float gap_margin_s = 1.0F;      ///< between our leaving a zone and the next one's arrival
  float going_margin_s = 0.3F;    ///< the same, once we have set off
  float committed_mps2 = 6.0F;    ///< who would have to brake harder for a zone goes through
};

/// a (1 - (v / v0)^4), never below -b.
[[nodiscard]] float idm_free(const IdmDriver& driver, float speed_mps, float desired_mps);

/// What a leader `gap_m` (bumper to bumper) ahead leaves room for: a (1 - (s* / s)^2),
/// s* = s0 + v T + v (v - v_leader) / (2 sqrt(a b)). The driver takes the smaller of it and the free one.
[[nodiscard]] float idm_behind(const IdmDriver& driver, float speed_mps, float gap_m, float leader_mps);

/// Whether a lane change between the two is safe: neither we nor the one behind must brake harder than asked.
/// \param ahead, behind  in the lane we want; agent < 0: nobody
[[nodiscard]] bool change_accepted(const IdmDriver& driver, float speed_mps, const trajectory::Leader& ahead,
                                   const trajectory::Leader& behind);

/// Somebody on the way through a conflict zone of ours, in seconds from now.
struct Crosser {
  float arrives_s = 0.0F;  ///< <= 0: in it already
  float gone_s = 0.0F;
  Priority priority = Priority::kFirstYields;  ///< seen from us: kFirstYields = we yield
  bool can_stop = true;                        ///< before it, braking at b
};

/// Whether we may be in the zone from `in_s` to `out_s`: the other one has gone, comes `margin_s` later, or owes us the
/// way.
[[nodiscard]] bool gap_accepted(const Crosser& crosser, float in_s, float out_s, float margin_s);

}  // namespace s4tp::baselines
