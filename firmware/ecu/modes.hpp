#pragma once
/// Modes of the ECU and the faults that move it between them. Every transition stands in one table
/// (modes.cpp); nothing else changes the mode.
///
/// \code
///                     +--------------------------- override, engage off ---------------------------+
///                     v                                                                            |
///   Fault <---- Standby <----> Ready ---- engage ----> Driving <----> Degraded                     |
///     ^               ^                                   |              |                         |
///     |               | engage off                        +-- lost ------+                         |
///     +---- Stopped --+                                          v                                 |
///              ^------------------ at rest ---------------- MinimumRisk ---------------------------+
/// \endcode

#include <cstdint>

namespace s4tp::ecu {

enum class Mode : std::uint8_t {
  kStandby = 0,      ///< ECU-001 not driving; commands say so; parameters may be set
  kReady = 1,        ///< ECU-002 all inputs whole, a plan is at hand, waiting to be engaged
  kDriving = 2,      ///< ECU-003 following plans
  kDegraded = 3,     ///< ECU-004 driving with something missing: slower, no lane change
  kMinimumRisk = 4,  ///< ECU-005 stopping along the path of the plan in force, as ECU-105 says
  kStopped = 5,      ///< ECU-006 at rest after a minimum-risk manoeuvre, held until released
  kFault = 6,        ///< ECU-007 cannot drive: self-test or internal fault
};
inline constexpr int kModeCount = 7;

/// In words, as reports and pages show it; "?" for none of them.
[[nodiscard]] const char* mode_name(Mode mode);

/// Bits of the status frame's fault field. The exact conditions stand in supervision.hpp.
enum class FaultBit : std::uint32_t {
  kMotionMissing = 1U << 0,    ///< ECU-010 no valid motion frame for 3 ticks
  kMotionTiming = 1U << 1,     ///< ECU-011 interval outside 8 .. 12 ms for 3 ticks, early or late
  kPoseMissing = 1U << 2,      ///< ECU-012 no valid pose for 100 ms
  kSteeringMissing = 1U << 3,  ///< ECU-013 no valid steering frame for 100 ms
  kTracksStale = 1U << 4,      ///< ECU-014 no whole track list for 250 ms: two are missing
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
  // What the senders say contradicts itself, physics or our commands (plausibility.hpp).
  kMotionImplausible = 1U << 16,    ///< ECU-096 speed, acceleration or yaw rate
  kSteeringImplausible = 1U << 17,  ///< ECU-097 steering angle
  kPoseImplausible = 1U << 18,      ///< ECU-098 pose
  kClockImplausible = 1U << 19,     ///< ECU-099 vehicle time
};

using Faults = std::uint32_t;
constexpr Faults bit(FaultBit fault) {
  return static_cast<Faults>(fault);
}

inline constexpr int kFaultCount = 20;
inline constexpr Faults kAllFaults = (1U << kFaultCount) - 1U;
/// Number of the requirement that defines fault bit `index`: ECU-010 for bit 0.
constexpr int fault_requirement(int index) {
  return index < 16 ? 10 + index : 80 + index;
}
/// What fault bit `index` means, in a few words; "?" where there is none.
[[nodiscard]] const char* fault_name(int index);

/// Faults that let the car drive on, degraded.
inline constexpr Faults kDegradingFaults = bit(FaultBit::kMotionTiming) | bit(FaultBit::kTracksStale) |
                                           bit(FaultBit::kMapStale) | bit(FaultBit::kPlanLate) |
                                           bit(FaultBit::kClockImplausible);
/// Faults that end the drive; all others but the driver's override.
inline constexpr Faults kEndingFaults = kAllFaults & ~(kDegradingFaults | bit(FaultBit::kDriverOverride));

/// ECU-105 The minimum-risk manoeuvre is the fail-safe in force, as the guard has shown it: driven on to its branch (out
/// of the junction, over to the other lane), then braked. While a silent fault stands it is braked; once any ending
/// fault but the unseen and the silent ones has come, it is braked to the end.
/// Unseen: what is around, or what to do next, is not known; what the ego does is.
inline constexpr Faults kUnseenFaults =
    bit(FaultBit::kTracksLost) | bit(FaultBit::kMapLost) | bit(FaultBit::kPlanLost);
/// Silent: what the ego does is not told.
inline constexpr Faults kSilentFaults =
    bit(FaultBit::kMotionMissing) | bit(FaultBit::kPoseMissing) | bit(FaultBit::kSteeringMissing);

/// ECU-100 While one of these stands no new plan takes effect: it was made from what is not believed, and the
/// minimum-risk manoeuvre goes on along the one before.
inline constexpr Faults kLyingFaults =
    bit(FaultBit::kMotionImplausible) | bit(FaultBit::kSteeringImplausible) | bit(FaultBit::kPoseImplausible);

/// What transitions are decided by.
struct Situation {
  Faults faults = 0;
  bool version_known = false;   ///< the world's version arrived and fits
  bool plan_at_hand = false;    ///< made from whole inputs: no fault since it was asked for
  bool engage = false;          ///< switch on; after an override, on again
  bool engage_released = true;  ///< switch off
  bool at_rest = false;         ///< by a valid motion frame
  bool well = false;            ///< no fault for 1 s (ECU-026)
};

/// One id a row; also the reason in the mode record.
enum class TransitionId : std::uint8_t {
  kNone = 0,
  kStandbyFault = 30,         ///< ECU-030 self-test refused
  kStandbyReady = 31,         ///< ECU-031 no fault at all, version known, a plan at hand made without any
  kReadyFault = 32,           ///< ECU-032 self-test refused
  kReadyStandby = 33,         ///< ECU-033 any fault, or the plan is gone
  kReadyDriving = 34,         ///< ECU-034 engage
  kDrivingStandby = 35,       ///< ECU-035 driver override or engage released
  kDrivingMinimumRisk = 36,   ///< ECU-036 an ending fault
  kDrivingDegraded = 37,      ///< ECU-037 a degrading fault
  kDegradedStandby = 38,      ///< ECU-038 driver override or engage released
  kDegradedMinimumRisk = 39,  ///< ECU-039 an ending fault
  kDegradedDriving = 40,      ///< ECU-040 no fault for 1 s
  kMinimumRiskStandby = 41,   ///< ECU-041 driver override
  kMinimumRiskStopped = 42,   ///< ECU-042 at rest
  kStoppedFault = 43,         ///< ECU-043 self-test refused
  kStoppedStandby = 44,       ///< ECU-044 driver override or engage released
};

struct Transition {
  Mode from;
  bool (*condition)(const Situation& situation);
  Mode to;
  TransitionId id;
};

inline constexpr int kTransitionCount = 15;
/// Row `index` of the table, in order of precedence. \pre 0 <= index < kTransitionCount
[[nodiscard]] const Transition& transition(int index);

/// The first row that applies. \return nullptr: the mode stays
[[nodiscard]] const Transition* find_transition(Mode from, const Situation& situation);

/// Whether commands of this mode may reach the actuators.
[[nodiscard]] bool may_command(Mode mode);

}  // namespace s4tp::ecu
