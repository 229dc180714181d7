#pragma once
/// The reader's end: the ECU of a name, whichever process it is at the moment.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/linux/shared_records.hpp"
#include "sim_host/campaign/trace.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::telemetry {

/// What is new since the last look. Of states the newest only.
struct News {
  bool another_ecu = false;  ///< the first one, or one in place of the last: all that was known is void
  bool ecu_gone = false;
  bool plan = false;
  bool control = false;
  bool status = false;
  std::vector<ecu::ModeRecord> mode_changes;
};

class Watch {
 public:
  explicit Watch(std::string name) : name_(std::move(name)) {}

  /// TELE-003 Finds the ECU when it comes, and again when another process takes its place. Never blocks.
  News look();

  [[nodiscard]] bool present() const { return memory_.is_open(); }
  /// Why it is not, in words.
  [[nodiscard]] const std::string& absence() const { return absence_; }
  [[nodiscard]] const IdentityRecord& identity() const { return identity_; }
  [[nodiscard]] const ecu::PlanRecord& plan() const { return plan_; }
  /// TELE-004 The cycle that plan() came of; null when it was overwritten before it was read.
  [[nodiscard]] const CycleRecord* cycle() const { return cycle_known_ ? &cycle_ : nullptr; }
  /// By the mode changes seen; of those before it looked, as many as are kept.
  [[nodiscard]] const campaign::EcuState& ecu() const { return ecu_; }
  [[nodiscard]] const ecu::ControlRecord& control() const { return control_; }
  [[nodiscard]] const StatusRecord& status() const { return status_; }
  [[nodiscard]] int writer() const { return memory_.is_open() ? memory_.writer() : 0; }

 private:
  void attach(News& news);
  template <class Record>
  bool take(Stream stream, Record& record);
  [[nodiscard]] bool find_cycle();

  std::string name_;
  std::string absence_ = "not looked for yet";
  hal::linux_host::SharedRecordsReader memory_;
  std::uint64_t seen_[kStreamCount] = {};
  std::uint64_t looks_ = 0;
  bool cycle_known_ = false;
  IdentityRecord identity_;
  ecu::PlanRecord plan_;
  campaign::EcuState ecu_;
  CycleRecord cycle_;
  ecu::ControlRecord control_;
  StatusRecord status_;
};

/// The same as campaign::Trace keeps of a cycle, for words and pictures.
[[nodiscard]] campaign::CycleTrace trace_of(const ecu::PlanRecord& plan, const CycleRecord* cycle,
                                            const campaign::EcuState& ecu);

}  // namespace s4tp::telemetry
