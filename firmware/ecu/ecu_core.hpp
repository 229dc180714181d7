#pragma once
/// The ECU application without its planner: everything that does not depend on the planner's type.

#include <cstdint>

#include "algo/satp/weight_image.hpp"
#include "firmware/ecu/cycle.hpp"
#include "firmware/ecu/event_ring.hpp"
#include "firmware/ecu/inputs.hpp"
#include "firmware/ecu/modes.hpp"
#include "firmware/ecu/plausibility.hpp"
#include "firmware/ecu/records.hpp"
#include "firmware/ecu/reports.hpp"
#include "firmware/ecu/supervision.hpp"
#include "firmware/ecu/tracker.hpp"
#include "firmware/ecu/triple_buffer.hpp"
#include "firmware/gate/command_gate.hpp"
#include "hal/can.hpp"
#include "hal/cycle_counter.hpp"
#include "hal/flash_bank.hpp"
#include "hal/telemetry.hpp"
#include "hal/watchdog.hpp"

namespace s4tp::ecu {

/// What the ECU stands on; telemetry may be null. No clock: the application's time is vehicle time, so that a
/// log replays to the bit.
struct Ports {
  hal::Can* can = nullptr;
  hal::CycleCounter* cycles = nullptr;
  hal::Watchdog* watchdog = nullptr;
  hal::Telemetry* telemetry = nullptr;
  const hal::FlashBank* weights = nullptr;  ///< read in place; null: the weights the build carries
};

enum class UpdateResult : std::uint8_t {
  kTaken = 0,     ///< ECU-090 in force for control at once, for planning from the next boundary
  kNotNow = 1,    ///< ECU-091 neither at start nor in standby: nothing changed
  kWrongCrc = 2,  ///< ECU-092 damaged on its way: nothing changed
  kInvalid = 3,   ///< ECU-093 a field is outside its range: nothing changed
};

inline constexpr int kMaxFramesPerTick = 256;  ///< the rest of a burst is taken in the next tick

class EcuCore {
 public:
  void init(const Parameters& parameters, const Ports& ports, bool refused, satp::WeightStatus weights);
  [[nodiscard]] UpdateResult update_parameters(const Parameters& parameters, std::uint32_t crc);

  void control_tick();
  void inject_deadline_miss() { miss_injected_ = true; }

  [[nodiscard]] bool planning_due() const { return snapshots_.front() != nullptr; }
  /// Planning context: the snapshot, and where its result goes. \pre planning_due()
  [[nodiscard]] const Snapshot& begin_cycle(CycleResult*& result);
  void end_cycle();

  [[nodiscard]] Mode mode() const { return mode_; }
  [[nodiscard]] Faults faults() const { return faults_; }
  [[nodiscard]] std::uint32_t now_ms() const { return inputs_.now_ms(); }
  [[nodiscard]] const Inputs& inputs() const { return inputs_; }
  [[nodiscard]] const PlausibilityMonitor& plausibility() const { return plausibility_; }
  [[nodiscard]] const Plan& plan() const { return plan_; }
  /// Of the planner's weights at start; kAbsent: it takes none.
  [[nodiscard]] satp::WeightStatus weights() const { return weights_; }
  [[nodiscard]] const CycleStatistics& statistics() const { return statistics_; }

 private:
  void take_parameters(const Parameters& parameters, std::uint32_t crc);
  void take_frames();
  /// \return whether a boundary has passed since the last tick
  [[nodiscard]] bool pass_time();
  void take_result();
  void give_snapshot();
  void supervise();
  void change_mode();
  [[nodiscard]] bool following() const {
    return mode_ == Mode::kDriving || mode_ == Mode::kDegraded || mode_ == Mode::kMinimumRisk;
  }
  /// ECU-107 A stop begun is gone on with: meanwhile no plan to drive on takes effect, and where it is not the fail-safe
  /// that is driven, none at all.
  [[nodiscard]] bool takes(PlanKind kind) const;
  [[nodiscard]] bool drives_fail_safe() const { return fail_safe_holds_ && (faults_ & kSilentFaults) == 0; }
  [[nodiscard]] gate::Command ask();
  void report(const gate::Command& command);
  void publish(RecordKind kind, const void* record, std::uint32_t size) const;

  Ports ports_;
  Parameters parameters_;
  std::uint32_t parameters_crc_ = 0;

  // Shared with the planning context, and nothing else is.
  EventRing<Snapshot, 1> snapshots_;
  TripleBuffer<CycleResult> results_;

  // Of the control context.
  Inputs inputs_;
  PlausibilityMonitor plausibility_;
  Commanded commanded_;  ///< in the tick before
  gate::CommandGate gate_{gate::Limits{}};
  Tracker tracker_;
  Reporter reporter_;
  Plan plan_;  ///< in force
  planner::Explanation explanation_;
  Status planner_status_ = Status::kNotInitialized;
  CycleStatistics statistics_;
  Age plan_age_;  ///< since it took effect
  std::uint32_t plan_sequence_ = 0;
  std::uint32_t last_ms_ = 0;      ///< vehicle time of the last tick
  std::uint32_t boundary_ms_ = 0;  ///< the newest one, in steps of 100 ms from a whole one on
  std::uint32_t ticks_ = 0;
  std::uint32_t well_ticks_ = 0;
  Mode mode_ = Mode::kStandby;
  Faults faults_ = 0;
  bool boundary_known_ = false;
  bool planning_idle_ = false;  ///< as of the last boundary
  bool miss_injected_ = false;
  bool plan_late_ = false;
  bool refused_ = false;
  satp::WeightStatus weights_ = satp::WeightStatus::kAbsent;
  bool gate_denied_ = false;
  bool fail_safe_holds_ = true;  ///< ECU-105: nothing has ended it in this manoeuvre
  bool engage_armed_ = true;
};

}  // namespace s4tp::ecu
