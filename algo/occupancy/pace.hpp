#pragma once
/// Motion along a line in closed form: the one answer to "when is it there" and "how far does it come".
/// OCC-001 Way, speed and time belong to each other: a vehicle gains speed up to a top speed and keeps it.
/// OCC-002 Who brakes as hard as it can is the latest to cover a way, or never covers it. OCC-005 Braking takes its time to
/// build up.

namespace s4tp::occupancy {

/// Stands for "not within any time that matters" [s].
inline constexpr float kNeverS = 1e3F;

/// T_settle of the law (D4): until others are used to whoever changed into their lane.
inline constexpr float kSettleS = 2.0F;

/// Physics: nobody turns faster [m/s^2].
inline constexpr float kGripMps2 = 7.0F;

/// A vehicle that gains speed up to a top speed and then keeps it.
struct Pace {
  float speed_mps = 0.0F;  ///< now, >= 0
  float gain_mps2 = 0.0F;  ///< >= 0
  float top_mps = 0.0F;    ///< kept when speed_mps is above it already
};

/// \return speed after `time_s` >= 0
[[nodiscard]] float speed_after_mps(const Pace& pace, float time_s);

/// \return way covered in `time_s` >= 0 [m]
[[nodiscard]] float way_after_m(const Pace& pace, float time_s);

/// \return time to cover `way_m`; 0 for a way <= 0, at most kNeverS
[[nodiscard]] float time_to_cover_s(const Pace& pace, float way_m);

/// \return way to a standstill [m]. \pre braking_mps2 > 0
[[nodiscard]] float stopping_way_m(float speed_mps, float braking_mps2);

/// Hardest change of acceleration of our own plans [m/s^3], when they brake hard.
inline constexpr float kHardJerkMps3 = 40.0F;

/// \return our own way to a standstill [m]: from `acceleration_mps2` the braking builds up with kHardJerkMps3; no
/// shorter than stopping_way_m. \pre braking_mps2 > 0
[[nodiscard]] float braking_way_m(float speed_mps, float acceleration_mps2, float braking_mps2);

/// Time a vehicle needs at least that brakes as hard as it can and yet covers `way_m`; kNeverS when it can
/// stop before. \pre braking_mps2 > 0
[[nodiscard]] float latest_time_s(float speed_mps, float braking_mps2, float way_m);

}  // namespace s4tp::occupancy
