#pragma once
/// Modes of the ECU and the faults that move it between them; every transition stands in one table
/// (modes.cpp).

#include <cstdint>

namespace s4tp::ecu {

enum class Mode : std::uint8_t {
  kStandby = 0,      ///< ECU-001 not driving; commands say so; parameters may be set
  kReady = 1,        ///< ECU-002 all inputs whole, a plan is at hand, waiting to be engaged
  kDriving = 2,      ///< ECU-003 following plans
  kDegraded = 3,     ///< ECU-004 driving with something missing: slower, no lane change
  kMinimumRisk = 4,  ///< ECU-005 stopping safely
  kStopped = 5,      ///< ECU-006 at rest after a minimum-risk manoeuvre, held until released
  kFault = 6,        ///< ECU-007 cannot drive: self-test or internal fault
};
inline constexpr int kModeCount = 7;

/// Bits of the status frame's fault field.
enum class FaultBit : std::uint16_t {
  kMotionMissing = 1U << 0,    ///< ECU-010 no valid motion frame for 3 ticks
  kMotionTiming = 1U << 1,     ///< ECU-011 interval outside 8 .. 12 ms for 3 ticks, early or late
  kPoseMissing = 1U << 2,      ///< ECU-012 no valid pose for 100 ms
  kSteeringMissing = 1U << 3,  ///< ECU-013 no valid steering frame for 100 ms
  kTracksStale = 1U << 4,      ///< ECU-014 no whole track list for 300 ms
  kTracksLost = 1U << 5,       ///< ECU-015 none for 1000 ms
  kMapStale = 1U << 6,         ///< ECU-016 map not confirmed for 1 s
  kMapLost = 1U << 7,          ///< ECU-017 none for 5 s
  kVersionMismatch = 1U << 8,  ///< ECU-018 other wire version or layout
  kPlanLate = 1U << 9,         ///< ECU-019 a plan missed its boundary; the old one stays
  kPlanLost = 1U << 10,        ///< ECU-020 no new plan for 500 ms
  kSelfTest = 1U << 11,        ///< ECU-021 init refused: arithmetic or parameters
  kBusOff = 1U << 12,          ///< ECU-022 the bus is off or down
  kTracking = 1U << 13,        ///< ECU-023 further than 1.5 m from the plan
  kGateDenied = 1U << 14,      ///< ECU-024 the gate denied a command while driving
  kDriverOverride = 1U << 15,  ///< ECU-025 the driver took over
};

}  // namespace s4tp::ecu
