#pragma once
/// How the tick of a real target keeps its distance to the motion frames, whose sender has a clock of its own.
///
/// \code
///   motion frames   M         M         M         M          the car's clock
///   ticks            . lead T . lead T                       ours, shifted by at most 0.5 ms a tick
/// \endcode

#include <cstdint>

namespace s4tp::hal {

inline constexpr std::uint32_t kTickPeriodUs = 10'000;
/// From a motion frame to the tick that uses it: the frames of a tick take 3 ms on a bus of 500 kbit/s, and the answer has
/// the rest of the tick.
inline constexpr std::uint32_t kTickLeadUs = 4'000;

/// What a tick is shifted by at most, when so much is asked for.
[[nodiscard]] inline std::int32_t limited_phase_us(std::int32_t phase_us) {
  constexpr std::int32_t kMaxPhaseUs = 500;
  return phase_us < -kMaxPhaseUs ? -kMaxPhaseUs : phase_us > kMaxPhaseUs ? kMaxPhaseUs : phase_us;
}

/// HAL-023 What to give to Tick::adjust(), so that ticks come `lead_us` after the motion frames: a quarter of what
/// is missing, the shorter way round, so that a frame's jitter is damped and the two clocks' drift of some
/// 100 ppm leaves 7 us at most.
/// \param arrival_us  of any motion frame, \param due_us  of any tick, on one clock, or both modulo the period
[[nodiscard]] inline std::int32_t phase_shift_us(std::uint64_t arrival_us, std::uint32_t lead_us,
                                                 std::uint64_t due_us) {
  constexpr auto kPeriod = static_cast<std::int32_t>(kTickPeriodUs);
  const auto wanted = static_cast<std::int32_t>((arrival_us + lead_us) % kTickPeriodUs);
  const auto is = static_cast<std::int32_t>(due_us % kTickPeriodUs);
  std::int32_t missing = wanted - is;
  if (missing > kPeriod / 2) missing -= kPeriod;
  if (missing < -kPeriod / 2) missing += kPeriod;
  return missing / 4;
}

}  // namespace s4tp::hal
