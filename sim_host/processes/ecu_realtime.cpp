#include "sim_host/processes/ecu_realtime.hpp"

#include <chrono>
#include <latch>
#include <semaphore>
#include <thread>

#include "firmware/ecu/reports.hpp"
#include "hal/linux/host_clock.hpp"
#include "hal/linux/timer_tick.hpp"

namespace s4tp::processes {
namespace {

using hal::kTickPeriodUs;
using hal::linux_host::Grant;

constexpr int kControlPriority = 80;
constexpr int kPlanningPriority = 70;
// Listening ends so long before a tick: waiting for frames is less exact than sleeping until an instant.
constexpr std::uint64_t kQuiet_us = 1000;
constexpr int kWaitsPerTick = 64;  // a line that comes in pieces wakes us without a frame
constexpr std::chrono::milliseconds kPrintEvery{20};

std::uint32_t clamp_us(std::uint64_t time_us) {
  return time_us < UINT32_MAX ? static_cast<std::uint32_t>(time_us) : UINT32_MAX;
}

class Drive {
 public:
  Drive(baselines::AnyEcu& ecu, TimedBus& bus, hal::linux_host::LinuxCan& can, EcuReporter& reporter,
        telemetry::EcuTap& tap, const EcuProcessOptions& options, const std::function<void()>& announce,
        const std::atomic<bool>& stop)
      : ecu_(ecu),
        bus_(bus),
        can_(can),
        reporter_(reporter),
        tap_(tap),
        options_(options),
        announce_(announce),
        kernel_(options.kernel != nullptr ? *options.kernel : hal::linux_host::this_kernel()),
        stop_(stop) {}

  RealtimeDrive run(std::ostream& out) {
    std::thread control([this] {
      control_grant_ = be_ready("control", kControlPriority);
      if (meet_world()) drive();
      control_done_ = true;
    });
    std::thread planning([this] {
      planning_grant_ = be_ready("planning", kPlanningPriority);
      plan();
    });
    asked_.wait();
    const Grant memory = hal::linux_host::ask_for_locked_memory(kernel_);
    go_.count_down();
    while (!control_done_) {
      reporter_.print(out, options_.bus);
      std::this_thread::sleep_for(kPrintEvery);
    }
    control.join();
    planning_ends_ = true;
    wake_.release();
    planning.join();
    reporter_.print(out, options_.bus);

    RealtimeReport& report = result_.report;
    report.task = "ECU control";
    report.grants = {control_grant_, planning_grant_, memory};
    report.kernel = hal::linux_host::read_preemption(kernel_);
    report.planning = planning_durations_;
    report.deadline_misses = ecu_.core().statistics().slips;
    return result_;
  }

 private:
  Grant be_ready(const char* thread, int priority) {
    const Grant grant = hal::linux_host::ask_for_fifo(kernel_, thread, priority);
    hal::linux_host::touch_stack();
    asked_.count_down();
    go_.wait();  // locking memory stops whoever needs a new page
    return grant;
  }

  // Control's thread.

  /// \return whether a world has begun
  bool meet_world() {
    const std::uint64_t begin_us = clock_.now_us();
    std::uint64_t hello_us = begin_us;
    ecu::Reporter hello;  // "I am there"
    while (!stop_) {
      const std::uint64_t now_us = clock_.now_us();
      if (now_us >= hello_us) {
        hello.version(can_, ecu_.core().weights());
        announce_();
        hello_us = now_us + kHelloEvery_ms * 1000U;
      }
      (void)bus_.take(static_cast<int>((hello_us - now_us) / 1000U) + 1);
      note_news();
      if (bus_.take_heard()) return true;
      if (clock_.now_us() - begin_us >= static_cast<std::uint64_t>(options_.wait_s) * 1'000'000U) {
        result_.end = EcuEnd::kNothingHeard;
        return false;
      }
    }
    return false;
  }

  void drive() {
    std::uint64_t heard_us = clock_.now_us();
    timer_.start(bus_.take_motion_arrival().value_or(heard_us) + hal::kTickLeadUs);
    while (!stop_) {
      listen();
      timer_.sleep();
      if (!timer_.take()) continue;
      result_.report.wake_ups.add(timer_.wake_up().late_us);
      result_.report.wake_ups.add_slips(timer_.wake_up().skipped);
      (void)bus_.take(0);
      if (const auto motion_us = bus_.take_motion_arrival())
        timer_.adjust(hal::phase_shift_us(*motion_us, hal::kTickLeadUs, timer_.due_us()));
      ecu_.control_tick();
      wake_.release();
      tap_.note_status(ecu_.core(), bus_);
      ++result_.ticks;
      note_news();
      const std::uint64_t now_us = clock_.now_us();
      if (bus_.take_heard()) heard_us = now_us;
      if (now_us - heard_us < static_cast<std::uint64_t>(options_.silence_s) * 1'000'000U) continue;
      result_.end = EcuEnd::kSilence;
      return;
    }
  }

  /// Takes frames until shortly before the tick.
  void listen() {
    for (int fruitless = 0; fruitless < kWaitsPerTick;) {
      const std::uint64_t quiet_us = timer_.due_us() - kQuiet_us;
      const std::uint64_t now_us = clock_.now_us();
      if (now_us + 1000U > quiet_us) return;
      if (bus_.take(static_cast<int>((quiet_us - now_us) / 1000U)) == 0) ++fruitless;
    }
  }

  void note_news() {
    for (hal::linux_host::LinkNews news{}; can_.take_news(news);) reporter_.note_news(news);
  }

  // Planning's thread.

  void plan() {
    for (;;) {
      wake_.acquire();
      if (planning_ends_) return;
      if (!ecu_.planning_due()) continue;
      const std::uint64_t begin_us = clock_.now_us();
      ecu_.planning_cycle();
      planning_durations_.add(clamp_us(clock_.now_us() - begin_us));
    }
  }

  baselines::AnyEcu& ecu_;
  TimedBus& bus_;
  hal::linux_host::LinuxCan& can_;
  EcuReporter& reporter_;
  telemetry::EcuTap& tap_;
  const EcuProcessOptions& options_;
  const std::function<void()>& announce_;
  hal::linux_host::RealtimeKernel& kernel_;
  const std::atomic<bool>& stop_;
  hal::linux_host::MonotonicClock clock_;  // has no state

  std::latch asked_{2};
  std::latch go_{1};
  std::counting_semaphore<> wake_{0};
  std::atomic<bool> control_done_{false};
  std::atomic<bool> planning_ends_{false};

  // Of control, until it has ended.
  hal::linux_host::TimerTick timer_{clock_};
  RealtimeDrive result_;
  Grant control_grant_;
  // Of planning.
  hal::linux_host::LatencyHistogram planning_durations_;
  Grant planning_grant_;
};

}  // namespace

RealtimeDrive drive_in_real_time(baselines::AnyEcu& ecu, TimedBus& bus, hal::linux_host::LinuxCan& can,
                                 EcuReporter& reporter, telemetry::EcuTap& tap,
                                 const EcuProcessOptions& options, const std::function<void()>& announce,
                                 std::ostream& out, const std::atomic<bool>& stop) {
  return Drive(ecu, bus, can, reporter, tap, options, announce, stop).run(out);
}

}  // namespace s4tp::processes
