#include "sim_host/faults/judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "firmware/wire/e2e.hpp"

namespace s4tp::faults {
namespace {

constexpr double kTick_s = 0.01;
// The gate's limits, and half a step of the wire beside each. GATE-001 .. GATE-008.
constexpr double kAccelerationStep_mps2 = 0.005;
constexpr double kSteeringStep_rad = 0.0002;
constexpr double kAccelerationMax_mps2 = 3.5;
constexpr double kBrakingMax_mps2 = 9.0;
constexpr double kRiseMax_mps3 = 20.0;
constexpr double kSteeringMax_rad = 0.55;
constexpr double kSteeringRateMax_radps = 0.7;
constexpr double kLateralMax_mps2 = 6.0;
constexpr double kLateralShare = 0.98;
constexpr double kWheelbase_m = 2.9;
constexpr double kSpeedMax_mps = 40.0;
constexpr int kMotionAgeMax_ticks = 10;
constexpr double kDeniedBraking_mps2 = 3.0;

constexpr int kCounters = 15;
constexpr int kStatusTicks = 10;
constexpr int kCommandAgeMax_ticks = 10;  // after which the car brakes by itself
constexpr double kSlowing_mps2 = 2.0;
constexpr int kGraceTicks = 100;
constexpr int kLatestBranchTicks = 300;  // the horizon of a plan
constexpr double kStanding_mps = 0.1;
constexpr int kRestTicks = 100;  // standing so long, a minimum-risk manoeuvre is over
constexpr int kLongSettling = 650;
constexpr int kShortSettling = 250;

bool commanding(ecu::Mode mode) {
  return mode == ecu::Mode::kDriving || mode == ecu::Mode::kDegraded || mode == ecu::Mode::kMinimumRisk ||
         mode == ecu::Mode::kStopped;
}

/// The map's records come round in 5 s, and in that time the plausibility monitor forgets its sums.
bool slow_to_return(const Fault& fault) {
  if (fault.kind == FaultKind::kBusOff || fault.kind == FaultKind::kBurst) return true;
  for (int i = 0; i < kMessageCount; ++i) {
    if (((fault.messages >> i) & 1U) == 0U) continue;
    const std::uint32_t id = message(i).id;
    const bool of_us = id == wire::kMotionId || id == wire::kSteeringId || id == wire::kPoseId;
    if (of_us || id >= wire::kMapHeaderId) return true;
  }
  return false;
}

}  // namespace

const char* breach_name(Breach breach) {
  constexpr std::array<const char*, kBreaches> kNames{
      "none", "silence", "limits", "unsafe stop", "no recovery", "fault mode", "crash", "hang", "contact"};
  return kNames.at(static_cast<std::size_t>(breach));
}

const char* outcome_name(Outcome outcome) {
  constexpr std::array<const char*, kOutcomes> kNames{"drive",   "degraded",    "stopping",
                                                      "stopped", "handed over", "cut off"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

int settling_ticks(const FaultScript& script) {
  const bool slow = std::any_of(script.faults.begin(), script.faults.end(), slow_to_return);
  return slow ? kLongSettling : kShortSettling;
}

void Judge::breach(Breach breach, const std::string& what) {
  if (breached()) return;
  verdict_.breach = breach;
  verdict_.tick = tick_;
  verdict_.what = what;
}

void Judge::begin_tick(int tick, double speed_mps, bool over) {
  tick_ = tick;
  speed_mps_ = speed_mps;
  quiet_ticks_ = over ? quiet_ticks_ + 1 : 0;
  ++command_age_ticks_;
}

bool Judge::read_command(const std::vector<wire::Frame>& sent, wire::Command& command) {
  const auto commands = std::count_if(sent.begin(), sent.end(),
                                      [](const wire::Frame& frame) { return frame.id == wire::kCommandId; });
  if (commands != 1 || sent.back().id != wire::kCommandId) {
    breach(Breach::kSilence, "a control tick with " + std::to_string(commands) + " command frames" +
                                 (commands == 1 ? ", not the last one" : ""));
    return false;
  }
  const wire::Frame& frame = sent.back();
  const int counter = frame.data[1] & 0x0F;
  const int wanted = (counter_ + 1 + ticks_since_command_) % kCounters;
  if (!wire::e2e_crc_fits(frame) || !wire::decode(frame, command) || (counter_ >= 0 && counter != wanted)) {
    breach(Breach::kSilence, "a command frame nobody may believe: CRC or counter");
    return false;
  }
  counter_ = counter;
  return true;
}

void Judge::read_status(const std::vector<wire::Frame>& sent) {
  ++ticks_since_status_;
  for (const wire::Frame& frame : sent) {
    wire::EcuStatus status;
    if (!wire::decode(frame, status)) continue;
    ticks_since_status_ = 0;
    if (status.mode != static_cast<std::uint8_t>(mode_)) {
      breach(Breach::kSilence, "status and command name different modes");
    }
    const ecu::Faults in_doubt = status.faults & ecu::kEndingFaults & ~ecu::kUnseenFaults;
    in_doubt_ = in_doubt != 0;
    fail_safe_over_ = fail_safe_over_ || (in_doubt & ~ecu::kSilentFaults) != 0;
  }
  if (ticks_since_status_ > kStatusTicks) breach(Breach::kSilence, "no status frame for 100 ms");
}

void Judge::control_tick(const std::vector<wire::Frame>& sent, bool off_bus) {
  judge_tick(sent, off_bus);
  ++motion_age_ticks_;
}

void Judge::judge_tick(const std::vector<wire::Frame>& sent, bool off_bus) {
  off_bus_ = off_bus;
  if (off_bus) {
    ++ticks_since_command_;
    ticks_since_status_ = 0;
    return;
  }
  wire::Command command;
  if (!read_command(sent, command)) return;
  if (command.accepted != (taken_ & 0xFFF)) {
    breach(Breach::kSilence, "the command echoes another number of frames than were taken");
  }
  mode_ = static_cast<ecu::Mode>(command.mode);
  if (mode_ == ecu::Mode::kFault) breach(Breach::kFaultMode, "the ECU gave itself up");
  read_status(sent);
  check_limits(command);
  last_ = command;
  has_command_ = true;
  ticks_since_command_ = 0;
  command_age_ticks_ = 0;
}

void Judge::taken(const wire::Frame& frame) {
  ++taken_;
  if (!wire::e2e_crc_fits(frame)) return;
  wire::Motion motion;
  wire::Steering steering;
  const int counter = frame.data[1] & 0x0F;
  if (wire::decode(frame, motion) && counter != motion_counter_) {
    motion_counter_ = counter;
    motion_age_ticks_ = 0;
    known_speed_mps_ = static_cast<double>(motion.speed_mps);
  } else if (wire::decode(frame, steering) && steering.driver_override != 0) {
    overridden_ = true;
  }
}

void Judge::check_limits(const wire::Command& command) {
  const auto mode = static_cast<ecu::Mode>(command.mode);
  const double acceleration = static_cast<double>(command.acceleration_mps2);
  const double tolerance = 0.5 * kAccelerationStep_mps2 + 1e-4;
  const auto demand = [&](bool holds, const std::string& limit) {
    if (holds) return;
    std::ostringstream what;
    what << limit << ": " << acceleration << " m/s^2, " << command.steering_rad << " rad after "
         << last_.acceleration_mps2 << " m/s^2, " << last_.steering_rad << " rad, at " << known_speed_mps_
         << " m/s";
    breach(Breach::kLimits, what.str());
  };
  demand(acceleration <= kAccelerationMax_mps2 + tolerance, "GATE-001 acceleration");
  demand(acceleration >= -kBrakingMax_mps2 - tolerance, "GATE-002 braking");
  demand(known_speed_mps_ <= kSpeedMax_mps || acceleration <= tolerance, "GATE-007 drive above 40 m/s");
  if (!commanding(mode)) {
    demand(acceleration <= -kDeniedBraking_mps2 + tolerance, "GATE-009 denied, but not braking");
    return;
  }
  const bool stale = motion_age_ticks_ > kMotionAgeMax_ticks;
  demand(!stale || acceleration <= -kDeniedBraking_mps2 + tolerance, "GATE-008 stale, but not braking");
  const bool told_of_doubt = ticks_since_status_ == 0 && in_doubt_;
  demand(drives() || (before_branch() && !told_of_doubt) || acceleration < 0.0,
         "a minimum-risk manoeuvre that does not brake");
  const double bound_rad =
      std::atan(kLateralMax_mps2 * kWheelbase_m / std::max(known_speed_mps_ * known_speed_mps_, 1e-3));
  const double steering = std::abs(static_cast<double>(command.steering_rad));
  const double half_step = 0.5 * kSteeringStep_rad + 1e-5;
  demand(steering <= kSteeringMax_rad + half_step, "GATE-004 steering");
  if (!has_command_ || !commanding(static_cast<ecu::Mode>(last_.mode))) return;  // GATE-012

  const double ticks = 1.0 + ticks_since_command_;
  const double rise = acceleration - static_cast<double>(last_.acceleration_mps2);
  demand(rise <= kRiseMax_mps3 * kTick_s * ticks + 2.0 * tolerance, "GATE-003 rise of acceleration");
  const double step =
      std::abs(static_cast<double>(command.steering_rad) - static_cast<double>(last_.steering_rad));
  const double step_max = kSteeringRateMax_radps * kTick_s * ticks;
  demand(step <= step_max + 2.0 * half_step, "GATE-005 steering rate");
  // Where the wheels cannot turn back fast enough, they turn back as fast as they can.
  const double before = std::abs(static_cast<double>(last_.steering_rad));
  const bool turns_back = steering <= before - kSteeringRateMax_radps * kTick_s + 2.0 * half_step;
  demand(steering <= bound_rad + half_step || turns_back, "GATE-006 lateral acceleration");
  // Stale, it holds the wheels, or turns them back to GATE-006, whose bound the gate has a little lower than
  // the arc tangent; unheard, it may turn.
  const bool turns_in = steering <= before && steering >= kLateralShare * bound_rad - half_step;
  const bool holds = ticks_since_command_ > 0 || step <= 2.0 * half_step || turns_back || turns_in;
  demand(!stale || holds, "GATE-008 stale, but steering");
}

bool Judge::drives() const {
  return mode_ == ecu::Mode::kDriving || mode_ == ecu::Mode::kDegraded;
}

bool Judge::before_branch() const {
  return mode_ == ecu::Mode::kMinimumRisk && !fail_safe_over_ && minimum_risk_ticks_ <= kLatestBranchTicks;
}

void Judge::contact(const std::string& cause) {
  if (!touched_ && !cut_off_) breach(Breach::kContact, cause);
  touched_ = true;
}

void Judge::check_standing() {
  const bool stops = mode_ == ecu::Mode::kMinimumRisk;
  minimum_risk_ticks_ = stops ? minimum_risk_ticks_ + 1 : 0;
  fail_safe_over_ = fail_safe_over_ && stops;
  const bool heard = !off_bus_ && command_age_ticks_ <= kCommandAgeMax_ticks;
  cut_off_ = tick_ > 0 && (!heard || (cut_off_ && !drives()));
  if (tick_ <= 0 || (heard && (drives() || (before_branch() && !in_doubt_)))) {
    idle_ticks_ = 0;
    standing_ticks_ = 0;
    idle_speed_mps_ = speed_mps_;
    return;
  }
  ++idle_ticks_;
  standing_ticks_ = speed_mps_ <= kStanding_mps ? standing_ticks_ + 1 : 0;
  const double braked_s = kTick_s * std::max(0, idle_ticks_ - kGraceTicks);
  const double allowed_mps = std::max(0.0, idle_speed_mps_ - kSlowing_mps2 * braked_s);
  if (idle_ticks_ < kGraceTicks || speed_mps_ <= allowed_mps + kStanding_mps) return;
  std::ostringstream what;
  what << "not driving for " << kTick_s * idle_ticks_ << " s, and still " << speed_mps_ << " m/s";
  breach(Breach::kUnsafeStop, what.str());
}

void Judge::check_recovery() {
  if (quiet_ticks_ < settling_ticks_ || tick_ < settling_ticks_) return;
  const bool drive = mode_ == ecu::Mode::kDriving;
  const bool waits = mode_ == ecu::Mode::kReady && overridden_;
  const bool stops =
      mode_ == ecu::Mode::kStopped || (mode_ == ecu::Mode::kMinimumRisk && standing_ticks_ < kRestTicks);
  if (drive || waits || stops) return;
  breach(Breach::kNoRecovery, "all is well again since " + std::to_string(quiet_ticks_) +
                                  " ticks, but the mode is " + std::to_string(static_cast<int>(mode_)));
}

void Judge::end_tick() {
  check_standing();
  check_recovery();
}

Verdict Judge::verdict() const {
  Verdict verdict = verdict_;
  verdict.outcome = Outcome::kHandedOver;
  if (mode_ == ecu::Mode::kDriving) verdict.outcome = Outcome::kDrive;
  if (mode_ == ecu::Mode::kDegraded) verdict.outcome = Outcome::kDegraded;
  if (mode_ == ecu::Mode::kMinimumRisk) verdict.outcome = Outcome::kStopping;
  if (mode_ == ecu::Mode::kStopped) verdict.outcome = Outcome::kStopped;
  if (off_bus_ || command_age_ticks_ > kCommandAgeMax_ticks) verdict.outcome = Outcome::kCutOff;
  return verdict;
}

}  // namespace s4tp::faults
