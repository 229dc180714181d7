#pragma once
/// Judges an ECU from outside: by the frames it took, the frames it sent, and how fast the car really
/// was. Has the gate's limits by their numbers, not from the gate.
///
/// FAULT-010 Never silent: every control tick on a living bus ends with exactly one Command frame, the last
/// of that tick, intact, its counter one further; a status frame every tenth tick, of the same mode.
/// FAULT-011 Never outside the limits of the command gate, at the speed of the newest intact motion frame
/// among those it says it has taken. FAULT-012 While it does not drive, whatever the reason, the car slows
/// down by 2 m/s^2 at least, one second of grace, until it stands, and then stays where it is; in the
/// minimum-risk mode only once the branch of its fail-safe is behind, 3 s at most, unless it reports a fault
/// that ends that (ECU-105). FAULT-013 When
/// the faults have been over for long enough (settling_ticks()), it drives again without any fault, or has
/// come to rest for good (kStopped), or the driver took over and it waits. FAULT-014 It never reaches kFault,
/// crashes (a signal) or hangs. FAULT-018 Whatever is lost, late, repeated or damaged, it touches nobody by its
/// own fault, as the world judges it. Two are counted beside: where a sender lies it may be led astray, and where
/// nothing comes from it for 100 ms the vehicle brakes by itself, wherever that is, until it drives again.

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/ecu/modes.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/frame.hpp"
#include "sim_host/faults/script.hpp"

namespace s4tp::faults {

/// What is wrong with the ECU. In the order of the table.
enum class Breach : std::uint8_t {
  kNone,
  kSilence,
  kLimits,
  kUnsafeStop,
  kNoRecovery,
  kFaultMode,
  kCrash,
  kHang,
  kContact,
};
inline constexpr int kBreaches = 9;
[[nodiscard]] const char* breach_name(Breach breach);

/// How a run ended, when nothing is wrong.
enum class Outcome : std::uint8_t {
  kDrive,
  kDegraded,    ///< driving on with less
  kStopping,    ///< minimum-risk manoeuvre under way
  kStopped,     ///< at rest after one
  kHandedOver,  ///< not driving: its commands brake
  kCutOff,      ///< nothing can get out (bus off; lock-step without TICK): the car brakes by itself
};
inline constexpr int kOutcomes = 6;
[[nodiscard]] const char* outcome_name(Outcome outcome);

struct Verdict {
  Outcome outcome = Outcome::kHandedOver;
  Breach breach = Breach::kNone;
  int tick = 0;      ///< of the first breach, since entry
  std::string what;  ///< the same in words
};

/// How long after the last fault everything must be as before, if the mode table allows: 1 s without a fault
/// (ECU-026), and before that 5 s for the map's records to come round or, where a fault was in what the car
/// tells of itself, for the sums of the plausibility monitor to be forgotten (PLAUS-012); else 1 s for the
/// lists.
[[nodiscard]] int settling_ticks(const FaultScript& script);

class Judge {
 public:
  explicit Judge(int settling_ticks) : settling_ticks_(settling_ticks) {}

  /// Once in each 10 ms, before the ECU's control ticks. \param speed_mps  true one \param over  no fault is
  /// active any more
  void begin_tick(int tick, double speed_mps, bool over);
  /// A frame the ECU takes from its controller.
  void taken(const wire::Frame& frame);
  /// What a control tick of the ECU sent. \param off_bus  its controller can send nothing
  void control_tick(const std::vector<wire::Frame>& sent, bool off_bus);
  /// Ends a tick.
  void end_tick();
  /// The car touches somebody, and the fault is its own. \param cause  in words
  void contact(const std::string& cause);

  [[nodiscard]] bool breached() const { return verdict_.breach != Breach::kNone; }
  [[nodiscard]] ecu::Mode mode() const { return mode_; }  ///< as its commands say
  [[nodiscard]] Verdict verdict() const;

 private:
  void breach(Breach breach, const std::string& what);
  void judge_tick(const std::vector<wire::Frame>& sent, bool off_bus);
  [[nodiscard]] bool read_command(const std::vector<wire::Frame>& sent, wire::Command& command);
  void read_status(const std::vector<wire::Frame>& sent);
  void check_limits(const wire::Command& command);
  void check_steering(const wire::Command& command, double steps);
  void check_standing();
  void check_recovery();
  [[nodiscard]] bool drives() const;
  /// It may be on its way to its fail-safe's branch.
  [[nodiscard]] bool before_branch() const;

  int settling_ticks_;
  Verdict verdict_;
  int tick_ = 0;
  double speed_mps_ = 0.0;
  int quiet_ticks_ = 0;  ///< since the last fault

  // What it took.
  int taken_ = 0;
  double known_speed_mps_ = 0.0;
  int motion_age_ticks_ = 1'000'000;
  int motion_counter_ = -1;
  bool overridden_ = false;

  // What it said last.
  wire::Command last_;
  bool has_command_ = false;
  bool off_bus_ = false;
  int counter_ = -1;
  int ticks_since_command_ = 0;  ///< control ticks
  int ticks_since_status_ = 0;   ///< control ticks
  int command_age_ticks_ = 0;    ///< ticks of 10 ms
  ecu::Mode mode_ = ecu::Mode::kStandby;
  int minimum_risk_ticks_ = 0;   ///< since the manoeuvre began
  bool in_doubt_ = false;        ///< its last status names a fault of the ego's own state
  bool fail_safe_over_ = false;  ///< one was named in this manoeuvre that ends the fail-safe
  bool cut_off_ = false;         ///< it brakes by itself, or has not driven since
  bool touched_ = false;

  // Since when it does not drive.
  int idle_ticks_ = 0;
  int standing_ticks_ = 0;
  double idle_speed_mps_ = 0.0;
};

}  // namespace s4tp::faults
