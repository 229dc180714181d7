#pragma once
/// Turns what is observed into fault bits: pure, without memory of its own.

#include <cstdint>

#include "firmware/ecu/modes.hpp"
#include "firmware/ecu/vehicle_clock.hpp"
#include "hal/can.hpp"

namespace s4tp::ecu {

/// Ages are of vehicle time, since the last valid arrival.
struct Observations {
  std::uint32_t motion_missing_ticks = kNeverMs;
  std::uint32_t motion_mistimed_ticks = 0;  ///< consecutive motion frames with an interval outside 8 .. 12 ms
  std::uint32_t pose_age_ms = kNeverMs;
  std::uint32_t steering_age_ms = kNeverMs;
  std::uint32_t tracks_age_ms = kNeverMs;
  std::uint32_t map_age_ms = kNeverMs;   ///< since a whole map was confirmed
  std::uint32_t plan_age_ms = kNeverMs;  ///< since a plan took effect
  bool version_mismatch = false;
  bool plan_late = false;
  bool refused = false;  ///< the planner or the parameters
  bool gate_denied = false;
  bool driver_override = false;
  hal::CanState bus = hal::CanState::kActive;
  float plan_distance_m = 0.0F;  ///< while following a plan
  Faults implausible = 0;        ///< what the plausibility monitor found
};

[[nodiscard]] Faults find_faults(const Observations& observed);

}  // namespace s4tp::ecu
