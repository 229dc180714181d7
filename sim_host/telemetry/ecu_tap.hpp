#pragma once
/// The ECU's end: writes records into shared memory as they arise. Bounded copies, no lock, no system call.

#include <cstdint>
#include <string>

#include "algo/core/parameters.hpp"
#include "algo/planner/probe.hpp"
#include "firmware/ecu/ecu_core.hpp"
#include "hal/linux/shared_records.hpp"
#include "hal/telemetry.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::telemetry {

/// TELE-002 Whoever reads, stops reading or never comes: what the ECU does is the same to the bit. TELE-007 And a
/// planning cycle takes the same instructions.
class EcuTap final : public hal::Telemetry, public planner::Probe {
 public:
  /// \param next  gets every record, too; may be null
  explicit EcuTap(hal::Telemetry* next = nullptr, planner::Probe* next_probe = nullptr)
      : next_(next), next_probe_(next_probe) {}

  /// Before the ECU is made. Without it all goes to `next` alone.
  /// \return false, with the reason, when there is no shared memory to be had
  [[nodiscard]] bool open(const std::string& name, const std::string& planner, const std::string& bus,
                          const Parameters& parameters, hal::linux_host::Reason& reason);
  [[nodiscard]] bool is_open() const { return memory_.is_open(); }
  /// Whoever reads learns that this ECU has ended.
  void close() { memory_.close(); }

  /// Control context, after each tick.
  void note_status(const ecu::EcuCore& core, const hal::Can& can);

  // Control context.
  bool publish(std::uint16_t kind, const void* record, std::uint32_t size) override;

  // Planning context.
  void stage_begin(planner::Stage stage) override;
  void stage_end(planner::Stage stage) override;
  void candidates_done(const planner::CandidatesView& view) override;
  void cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                  const sadrf::RiskProfile& risk) override;

 private:
  hal::Telemetry* next_;
  planner::Probe* next_probe_;
  hal::linux_host::SharedRecordsWriter memory_;
  std::uint32_t ticks_ = 0;           ///< control context
  CycleRecord cycle_;                 ///< planning context
  std::uint64_t stage_began_ns_ = 0;  ///< planning context
};

}  // namespace s4tp::telemetry
