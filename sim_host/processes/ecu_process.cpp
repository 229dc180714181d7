#include "sim_host/processes/ecu_process.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <semaphore>
#include <thread>

#include "algo/core/versions.hpp"
#include "firmware/ecu/records.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "firmware/wire/version.hpp"
#include "hal/sim/null_devices.hpp"
#include "hal/sim/sim_clock.hpp"
#include "sim_host/campaign/any_ecu.hpp"
#include "sim_host/campaign/frames.hpp"
#include "sim_host/processes/bus_end.hpp"
#include "sim_host/processes/lockstep_bus.hpp"

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

/// "I am there", until the world begins.
class Hello {
 public:
  void send(hal::Can& can) {
    wire::VersionEcu version;
    version.wire_version = wire::wire_version();
    version.layout_hash = wire::layout_hash();
    version.api_version = kApiVersion;
    wire::Frame frame;
    if (!wire::encode(version, frame)) return;
    sender_.protect(frame);
    (void)can.send(campaign::to_hal(frame));  // the next one is on its way
  }

 private:
  wire::E2eSender sender_;
};

}  // namespace

EcuEnd run_ecu(hal::linux_host::LinuxCan& can, const EcuProcessOptions& options, std::ostream& out,
               const std::atomic<bool>& stop) {
  LockstepBus bus(can);
  hal::sim::SimClock clock;
  hal::sim::NullCycleCounter cycles;
  hal::sim::NullWatchdog watchdog;
  Reporter reporter(out);
  const auto ecu = campaign::make_ecu(options.planner, options.parameters,
                                      {&bus, &clock, &cycles, &watchdog, &reporter}, nullptr);
  std::optional<PlanningThread> planning;
  if (options.realtime) planning.emplace(*ecu);

  Hello hello;
  std::uint32_t ticks = 0;
  EcuEnd end = EcuEnd::kStopped;
  auto heard = steady_clock::now();
  while (!stop) {
    if (ticks == 0) hello.send(can);
    const bool opened = bus.wait_tick(kHelloEvery_ms);
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
