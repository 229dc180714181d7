#pragma once
/// An episode within one process, told through shared memory and driven at the pace of the clock: to be
/// looked at.

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>

#include "sim_host/campaign/episode.hpp"
#include "sim_host/telemetry/ecu_tap.hpp"

namespace s4tp::telemetry {

/// Told to stop, a live drive ends so.
struct DriveStopped : std::runtime_error {
  DriveStopped() : std::runtime_error("the drive was stopped") {}
};

/// TELE-005 The same drive to the bit as without it, 10 ms of host time a tick.
class LiveDrive final : public campaign::Onlooker {
 public:
  /// \param stop  null: nobody stops it
  LiveDrive(std::string name, std::string planner, const Parameters& parameters,
            const std::atomic<bool>* stop = nullptr)
      : name_(std::move(name)), planner_(std::move(planner)), parameters_(parameters), stop_(stop) {}

  /// \throws std::runtime_error when there is no shared memory to be had
  void begin(campaign::Trace* trace) override;
  hal::Telemetry* telemetry() override { return &*tap_; }
  planner::Probe* probe() override { return &*tap_; }
  /// \throws DriveStopped
  void ticked(const campaign::Driver& driver) override;

 private:
  std::string name_;
  std::string planner_;
  Parameters parameters_;
  const std::atomic<bool>* stop_;
  std::optional<EcuTap> tap_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace s4tp::telemetry
