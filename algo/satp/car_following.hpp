#pragma once
/// The intelligent driver model (Treiber et al. 2000): how a driver accelerates on an open road and behind
/// somebody.

namespace s4tp::satp {

/// Strongest acceleration [m/s^2].
inline constexpr float kAccelerationMps2 = 2.0F;
/// Usual time headway behind a leader [s].
inline constexpr float kUsualHeadwayS = 1.3F;
/// Gap to a standing leader [m].
inline constexpr float kStandstillGapM = 2.5F;

/// \return acceleration towards the desired speed [m/s^2], -3 .. 2
[[nodiscard]] float free_acceleration(float speed_mps, float desired_mps);

/// Acceleration a leader `gap_m` (bumper to bumper) ahead leaves room for [m/s^2], up to 2; 0 at the wanted
/// gap. The driver takes the smaller of it and the free one: the model's plain difference of both would brake
/// at the desired speed however large the gap.
[[nodiscard]] float following_acceleration(float speed_mps, float gap_m, float leader_mps, float headway_s);

/// Drivers keep the headway they have: what the model takes for a driver now `gap_m` behind, 0.4 .. 1.3 s.
[[nodiscard]] float kept_headway_s(float gap_m, float speed_mps);

}  // namespace s4tp::satp
