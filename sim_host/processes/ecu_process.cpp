#include "sim_host/processes/ecu_process.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <semaphore>
#include <thread>

#include "firmware/ecu/lockstep_bus.hpp"
#include "firmware/ecu/records.hpp"
#include "firmware/ecu/reports.hpp"
#include "hal/sim/null_devices.hpp"
#include "hal/sim/sim_clock.hpp"
#include "sim_host/campaign/any_ecu.hpp"
#include "sim_host/processes/bus_end.hpp"

namespace s4tp::processes {
namespace {

using std::chrono::steady_clock;
constexpr int kHelloEvery_ms = 100;
constexpr std::uint32_t kTick_ms = 10;

const char* mode_name(ecu::Mode mode) {
  static constexpr const char* kNames[ecu::kModeCount] = {"standby",      "ready",   "driving", "degraded",
                                                          "minimum risk", "stopped", "fault"};
  return kNames[static_cast<int>(mode)];
}

/// Tells of mode changes; counts plans.
class Reporter final : public hal::Telemetry {
 public:
  explicit Reporter(std::ostream& out) : out_(out) {}
  bool publish(std::uint16_t kind, const void* record, std::uint32_t) override {
    switch (static_cast<ecu::RecordKind>(kind)) {
      case ecu::RecordKind::kModeChange:
        print(*static_cast<const ecu::ModeRecord*>(record));
        break;
      case ecu::RecordKind::kPlan:
        ++plans_;
        break;
      case ecu::RecordKind::kControl:
        break;
    }
    return true;
  }
  [[nodiscard]] int plans() const { return plans_; }

 private:
  void print(const ecu::ModeRecord& change) {
    char text[80];
    std::snprintf(text, sizeof text, "ECU %8.2f s  %s -> %s", change.time_ms / 1000.0, mode_name(change.from),
                  mode_name(change.to));
    out_ << text;
    for (int bit = 0; bit < 16; ++bit) {  // ids of the faults stand beside the bits, in modes.hpp
      if ((change.faults >> bit & 1) != 0) out_ << ", fault ECU-0" << 10 + bit;
    }
    out_ << std::endl;
  }
  std::ostream& out_;
  int plans_ = 0;
};

/// The planning context as a thread.
class PlanningThread {
 public:
  explicit PlanningThread(campaign::AnyEcu& ecu)
      : thread_([this, &ecu](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            wake_.acquire();
            if (ecu.planning_due()) ecu.planning_cycle();
          }
        }) {}
  ~PlanningThread() {
    thread_.request_stop();
    wake_.release();
  }
  PlanningThread(const PlanningThread&) = delete;
  PlanningThread& operator=(const PlanningThread&) = delete;
  void wake() { wake_.release(); }

 private:
  std::counting_semaphore<> wake_{0};
  std::jthread thread_;
};

/// Waits until a tick opens. \return false: none in `timeout_ms`, however many other frames come
bool wait_tick(ecu::LockstepBus& bus, hal::linux_host::LinuxCan& can, int timeout_ms) {
  const auto end = steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  for (;;) {
    const auto now = steady_clock::now();
    const auto now_ms = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch());
    if (bus.take_tick(static_cast<std::uint64_t>(now_ms.count()))) return true;
    if (now >= end) return false;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
    (void)can.wait(static_cast<int>(left.count()));
  }
}

}  // namespace

EcuEnd run_ecu(hal::linux_host::LinuxCan& can, const EcuProcessOptions& options, std::ostream& out,
               const std::atomic<bool>& stop) {
  ecu::LockstepBus bus(can);
  hal::sim::SimClock clock;
  hal::sim::NullCycleCounter cycles;
  hal::sim::NullWatchdog watchdog;
  Reporter reporter(out);
  const auto ecu = campaign::make_ecu(options.planner, options.guarded, options.parameters,
                                      {&bus, &clock, &cycles, &watchdog, &reporter}, nullptr);
  std::optional<PlanningThread> planning;
  if (options.realtime) planning.emplace(*ecu);

  ecu::Reporter hello;  // "I am there", until the world begins
  std::uint32_t ticks = 0;
  EcuEnd end = EcuEnd::kStopped;
  auto heard = steady_clock::now();
  while (!stop) {
    if (ticks == 0) hello.version(can);
    const bool opened = wait_tick(bus, can, kHelloEvery_ms);
    print_news(out, options.bus, can);
    if (!opened) {
      const auto silence = steady_clock::now() - heard;
      if (silence < std::chrono::seconds(ticks == 0 ? options.wait_s : options.silence_s)) continue;
      end = ticks == 0 ? EcuEnd::kNothingHeard : EcuEnd::kSilence;
      break;
    }
    heard = steady_clock::now();
    clock.follow(++ticks * kTick_ms);
    ecu->control_tick();
    if (planning) {
      planning->wake();
    } else if (ecu->planning_due()) {
      ecu->planning_cycle();
    }
  }
  planning.reset();
  out << "ECU: " << ticks << " ticks, " << reporter.plans() << " plans, " << ecu->core().statistics().slips
      << " deadlines missed, " << bus.refused_ticks() << " TICK frames refused\n";
  print_counters(out, "ECU on " + options.bus, bus.counters());
  out.flush();
  return end;
}

}  // namespace s4tp::processes
