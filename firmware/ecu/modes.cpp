#include "firmware/ecu/modes.hpp"

#include "algo/core/check.hpp"

namespace s4tp::ecu {
namespace {

bool has(const Situation& s, Faults faults) {
  return (s.faults & faults) != 0;
}

bool refused(const Situation& s) {
  return has(s, bit(FaultBit::kSelfTest));
}
bool whole(const Situation& s) {
  return s.faults == 0 && s.version_known && s.plan_at_hand;
}
bool not_whole(const Situation& s) {
  return !whole(s);
}
bool engaged(const Situation& s) {
  return s.engage;
}
bool taken_over(const Situation& s) {
  return has(s, bit(FaultBit::kDriverOverride)) || s.engage_released;
}
bool overridden(const Situation& s) {
  return has(s, bit(FaultBit::kDriverOverride));
}
bool ended(const Situation& s) {
  return has(s, kEndingFaults);
}
bool degraded(const Situation& s) {
  return has(s, kDegradingFaults);
}
bool well(const Situation& s) {
  return s.well;
}
bool at_rest(const Situation& s) {
  return s.at_rest;
}

constexpr Transition kTable[] = {
    {Mode::kStandby, refused, Mode::kFault, TransitionId::kStandbyFault},
    {Mode::kStandby, whole, Mode::kReady, TransitionId::kStandbyReady},
    {Mode::kReady, refused, Mode::kFault, TransitionId::kReadyFault},
    {Mode::kReady, not_whole, Mode::kStandby, TransitionId::kReadyStandby},
    {Mode::kReady, engaged, Mode::kDriving, TransitionId::kReadyDriving},
    {Mode::kDriving, taken_over, Mode::kStandby, TransitionId::kDrivingStandby},
    {Mode::kDriving, ended, Mode::kMinimumRisk, TransitionId::kDrivingMinimumRisk},
    {Mode::kDriving, degraded, Mode::kDegraded, TransitionId::kDrivingDegraded},
    {Mode::kDegraded, taken_over, Mode::kStandby, TransitionId::kDegradedStandby},
    {Mode::kDegraded, ended, Mode::kMinimumRisk, TransitionId::kDegradedMinimumRisk},
    {Mode::kDegraded, well, Mode::kDriving, TransitionId::kDegradedDriving},
    {Mode::kMinimumRisk, overridden, Mode::kStandby, TransitionId::kMinimumRiskStandby},
    {Mode::kMinimumRisk, at_rest, Mode::kStopped, TransitionId::kMinimumRiskStopped},
    {Mode::kStopped, refused, Mode::kFault, TransitionId::kStoppedFault},
    {Mode::kStopped, taken_over, Mode::kStandby, TransitionId::kStoppedStandby},
};
static_assert(sizeof(kTable) / sizeof(kTable[0]) == kTransitionCount);

}  // namespace

const char* mode_name(Mode mode) {
  static constexpr const char* kNames[kModeCount] = {"standby",      "ready",   "driving", "degraded",
                                                     "minimum risk", "stopped", "fault"};
  const int index = static_cast<int>(mode);
  return index < kModeCount ? kNames[index] : "?";
}

const char* fault_name(int index) {
  static constexpr const char* kNames[kFaultCount] = {"no motion frames",
                                                      "motion frames early or late",
                                                      "no pose",
                                                      "no steering angle",
                                                      "track list late",
                                                      "no track list",
                                                      "map late",
                                                      "no map",
                                                      "another version",
                                                      "plan late",
                                                      "no plan",
                                                      "self-test refused",
                                                      "bus off",
                                                      "far from the plan",
                                                      "the gate refused",
                                                      "the driver took over",
                                                      "motion implausible",
                                                      "steering implausible",
                                                      "pose implausible",
                                                      "vehicle time implausible"};
  return index >= 0 && index < kFaultCount ? kNames[index] : "?";
}

const Transition& transition(int index) {
  S4TP_ASSERT(index >= 0 && index < kTransitionCount);
  return kTable[index];
}

const Transition* find_transition(Mode from, const Situation& situation) {
  for (const Transition& row : kTable) {
    if (row.from == from && row.condition(situation)) return &row;
  }
  return nullptr;
}

bool may_command(Mode mode) {
  return mode == Mode::kDriving || mode == Mode::kDegraded || mode == Mode::kMinimumRisk ||
         mode == Mode::kStopped;
}

}  // namespace s4tp::ecu
