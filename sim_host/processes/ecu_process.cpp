#include "sim_host/processes/ecu_process.hpp"

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "firmware/ecu/reports.hpp"
#include "firmware/lockstep/lockstep_bus.hpp"
#include "hal/sim/null_devices.hpp"
#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/processes/bus_end.hpp"
#include "sim_host/processes/ecu_realtime.hpp"
#include "sim_host/processes/ecu_reporter.hpp"
#include "sim_host/processes/timed_bus.hpp"
#include "sim_host/telemetry/ecu_tap.hpp"

namespace s4tp::processes {
namespace {

using std::chrono::steady_clock;

/// What an ECU stands on in this process, besides its bus.
struct Devices {
  hal::sim::NullCycleCounter cycles;
  hal::sim::NullWatchdog watchdog;
  EcuReporter reporter;
  telemetry::EcuTap tap{&reporter};

  std::unique_ptr<baselines::AnyEcu> make_ecu(const EcuProcessOptions& options, hal::Can& bus,
                                              std::ostream& out) {
    hal::linux_host::Reason reason;
    const bool told = !options.telemetry.empty();
    if (told && !tap.open(options.telemetry, options.planner, options.bus, options.parameters, reason))
      out << "no telemetry: " << reason.text << std::endl;
    return baselines::make_ecu(options.planner, options.guarded, options.parameters,
                               {&bus, &cycles, &watchdog, &tap, options.weights.get()},
                               tap.is_open() ? &tap : nullptr);
  }
};

/// Waits until a tick opens. \return false: none in `timeout_ms`, however many other frames come
bool wait_tick(lockstep::LockstepBus& bus, hal::linux_host::LinuxCan& can, int timeout_ms) {
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

/// Authentication around a bus end, where there are keys.
struct Authentic {
  Authentic(hal::Can& bus, const EcuProcessOptions& options) {
    if (options.keys != nullptr)
      can = std::make_unique<secoc::AuthenticCan>(bus, *options.keys, secoc::End::kEcu);
  }
  /// What the ECU has to stand on.
  [[nodiscard]] hal::Can& over(hal::Can& bus) const { return can != nullptr ? *can : bus; }
  void announce() {
    if (can != nullptr) can->announce();
  }
  void tell(std::ostream& out) {
    if (can != nullptr) teller.tell(out, *can);
  }
  void sum_up(std::ostream& out) const {
    if (can != nullptr) teller.sum_up(out, *can);
  }

  std::unique_ptr<secoc::AuthenticCan> can;
  SessionTeller teller{"ECU"};
};

template <class Bus>
void print_summary(std::ostream& out, const EcuProcessOptions& options, std::uint32_t ticks,
                   const EcuReporter& reporter, const baselines::AnyEcu& ecu, const Bus& bus) {
  out << "ECU: " << ticks << " ticks, " << reporter.plans() << " plans, " << ecu.core().statistics().slips
      << " deadlines missed, " << bus.refused_ticks() << " TICK frames refused\n";
  print_counters(out, "ECU on " + options.bus, bus.counters());
  out.flush();
}

EcuEnd run_in_lock_step(hal::linux_host::LinuxCan& can, const EcuProcessOptions& options, std::ostream& out,
                        const std::atomic<bool>& stop) {
  lockstep::LockstepBus bus(can);
  Authentic authentic(bus, options);
  hal::Can& top = authentic.over(bus);
  const auto kept = std::make_unique<Devices>();  // tens of KiB
  Devices& devices = *kept;
  const auto ecu = devices.make_ecu(options, top, out);
  ecu::Reporter hello;  // "I am there", until the world begins
  std::uint32_t ticks = 0;
  EcuEnd end = EcuEnd::kStopped;
  auto heard = steady_clock::now();
  while (!stop) {
    if (ticks == 0) {
      hello.version(can, ecu->core().weights());
      authentic.announce();
    }
    const bool opened = wait_tick(bus, can, kHelloEvery_ms);
    print_news(out, options.bus, can);
    if (!opened) {
      const auto silence = steady_clock::now() - heard;
      if (silence < std::chrono::seconds(ticks == 0 ? options.wait_s : options.silence_s)) continue;
      end = ticks == 0 ? EcuEnd::kNothingHeard : EcuEnd::kSilence;
      break;
    }
    heard = steady_clock::now();
    ++ticks;
    ecu->control_tick();
    if (ecu->planning_due()) ecu->planning_cycle();
    devices.tap.note_status(ecu->core(), top);
    devices.reporter.print(out, options.bus);
    authentic.tell(out);
  }
  authentic.sum_up(out);
  print_summary(out, options, ticks, devices.reporter, *ecu, bus);
  return end;
}

EcuEnd run_in_real_time(hal::linux_host::LinuxCan& can, const EcuProcessOptions& options, std::ostream& out,
                        const std::atomic<bool>& stop) {
  TimedBus bus(can);
  Authentic authentic(bus, options);
  const auto kept = std::make_unique<Devices>();  // tens of KiB
  Devices& devices = *kept;
  const auto ecu = devices.make_ecu(options, authentic.over(bus), out);
  const RealtimeDrive drive = drive_in_real_time(
      *ecu, bus, can, devices.reporter, devices.tap, options, [&authentic] { authentic.announce(); }, out,
      stop);
  authentic.sum_up(out);
  print_summary(out, options, drive.ticks, devices.reporter, *ecu, bus);
  if (drive.ticks > 0) print(out, drive.report);
  if (!options.report.empty()) {
    std::ofstream file(options.report);
    file << to_json(drive.report).dump(1) << '\n';
    if (!file) throw std::runtime_error(options.report.string() + ": cannot write the report");
  }
  return drive.end;
}

}  // namespace

EcuEnd run_ecu(hal::linux_host::LinuxCan& can, const EcuProcessOptions& options, std::ostream& out,
               const std::atomic<bool>& stop) {
  return options.realtime ? run_in_real_time(can, options, out, stop)
                          : run_in_lock_step(can, options, out, stop);
}

}  // namespace s4tp::processes
