#include "sim_host/processes/world_process.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "hal/linux/host_clock.hpp"
#include "hal/linux/timer_tick.hpp"
#include "sim_host/campaign/bus_log.hpp"
#include "sim_host/campaign/weights_file.hpp"
#include "sim_host/processes/bus_end.hpp"
#include "sim_host/world/nodes/tick_echo.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::processes {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr milliseconds kLook{50};
constexpr milliseconds kTick{10};
constexpr int kToldUnanswered = 5;
constexpr int kPriority = 60;  // below an ECU of the same machine
constexpr std::uint64_t kQuiet_us =
    2000;                          // before a tick: sleeping until an instant is more exact than waiting
constexpr int kTicksToEnd = 1000;  // pre-roll and the 200 ticks after which the world calls the ECU dead

int to_ms(steady_clock::duration time) {
  return static_cast<int>(std::max(std::chrono::ceil<milliseconds>(time), milliseconds{0}).count());
}

class Session {
 public:
  /// \param authentic  of `can`; null: none
  Session(const scenario::Scenario& scenario, hal::linux_host::LinuxCan& can, secoc::AuthenticCan* authentic,
          const WorldProcessOptions& options, std::ostream& out, const std::atomic<bool>& stop)
      : can_(can),
        authentic_(authentic),
        options_(options),
        out_(out),
        stop_(stop),
        world_(scenario, world_options(options)) {
    if (options.log) log_.emplace(*options.log, options.seed, options.ecu_note);
  }

  WorldProcessResult run() {
    if (!meet_ecu()) return result_;
    result_.met_ecu = true;
    if (options_.realtime) {
      drive_in_real_time();
    } else {
      drive_in_lock_step();
    }
    print_news(out_, options_.bus, can_);
    if (authentic_ != nullptr) teller_.sum_up(out_, *authentic_);
    result_.recording = world_.recording();
    return result_;
  }

 private:
  static world::WorldOptions world_options(const WorldProcessOptions& options) {
    world::WorldOptions result;
    result.seed = options.seed;
    result.engine = options.engine;
    result.perception = options.perception;
    return result;
  }

  [[nodiscard]] bool ecu_lives() const { return !options_.ecu_lives || options_.ecu_lives(); }

  bool meet_ecu() {
    const auto end = steady_clock::now() + seconds(options_.wait_s);
    bool there = false;
    while (options_.wait_s > 0) {
      hal::CanFrame frame;
      while (can_.receive(frame)) {
        if (frame.id != wire::kVersionEcuId || !wire::e2e_crc_fits(to_wire(frame))) continue;
        if (!there) tell_weights(to_wire(frame));
        there = true;
      }
      if (authentic_ != nullptr) authentic_->announce();
      if (there && (authentic_ == nullptr || authentic_->session().has_key())) return true;
      print_news(out_, options_.bus, can_);
      if (stop_ || !ecu_lives() || steady_clock::now() >= end) {
        if (there) out_ << "the ECU says no nonce: it runs without --authentic" << std::endl;
        return false;
      }
      (void)can_.wait(to_ms(kLook));
    }
    return true;
  }

  /// Why the ECU drives without the network it was given.
  void tell_weights(const wire::Frame& frame) {
    wire::VersionEcu version;
    if (!wire::decode(frame, version)) return;
    const std::string words =
        campaign::refused_weights_words(static_cast<satp::WeightStatus>(version.weights));
    if (!words.empty()) out_ << words << std::endl;
  }

  void drive_in_lock_step() {
    auto answered = steady_clock::now();
    auto next = answered;
    while (!world_.finished() && !stop_) {
      // What was late is not made up for: nobody could look at it.
      if (options_.paced) std::this_thread::sleep_until(next = std::max(next + kTick, steady_clock::now()));
      begin_tick();
      if (await_answer()) {
        answered = steady_clock::now();
        continue;
      }
      if (stop_) return;
      ++result_.unanswered;
      tell_unanswered();
      if (link_was_down_ && usable()) answered = steady_clock::now();  // it is back
      if (ecu_lives() && steady_clock::now() < answered + milliseconds(options_.dead_after_ms)) continue;
      out_ << "no answer from the ECU: it is dead" << std::endl;
      for (int i = 0; i < kTicksToEnd && !world_.finished(); ++i) world_.tick(frames_);
      return;
    }
  }

  /// The first few: what came instead of the answer.
  void tell_unanswered() {
    if (result_.unanswered > kToldUnanswered) return;
    out_ << "tick " << result_.ticks << " is not answered; " << refused_text_ << std::endl;
  }

  /// \return whether the ECU answered this tick
  bool await_answer() {
    auto end = steady_clock::now() + milliseconds(options_.answer_within_ms);
    const auto link_end = steady_clock::now() + milliseconds(options_.link_back_within_ms);
    link_was_down_ = false;
    while (!stop_) {
      if (take_frames(0)) return true;
      print_news(out_, options_.bus, can_);
      if (!ecu_lives()) return false;
      const auto now = steady_clock::now();
      if (!usable() && now < link_end) {
        link_was_down_ = true;
        end = now;
      } else if (now >= end) {
        return false;
      }
      (void)can_.wait(link_was_down_ ? to_ms(kLook) : std::min(to_ms(kLook), to_ms(end - now)));
    }
    return false;
  }

  void drive_in_real_time() {
    using namespace hal::linux_host;
    RealtimeKernel& kernel = options_.kernel != nullptr ? *options_.kernel : this_kernel();
    RealtimeReport& report = result_.timing.emplace();
    report.task = "world";
    report.grants = {ask_for_fifo(kernel, "the world", kPriority), ask_for_locked_memory(kernel)};
    report.kernel = read_preemption(kernel);
    touch_stack();
    MonotonicClock clock;
    TimerTick timer(clock);
    timer.start(clock.now_us());
    while (!world_.finished() && !stop_) {
      timer.sleep();
      if (!timer.take()) continue;
      report.wake_ups.add(timer.wake_up().late_us);
      report.wake_ups.add_slips(timer.wake_up().skipped);
      if (result_.ticks > 0 && !take_frames(nodes::kOldestEcho)) ++result_.unanswered;
      begin_tick();
      // Frames stay in the socket until the tick; only the link is looked after.
      for (auto now_us = clock.now_us(); now_us + kQuiet_us + 1000U <= timer.due_us();
           now_us = clock.now_us()) {
        if (can_.wait(static_cast<int>((timer.due_us() - kQuiet_us - now_us) / 1000U))) break;
      }
      print_news(out_, options_.bus, can_);
    }
  }

  void begin_tick() {
    frames_.clear();
    world_.tick(frames_);
    ++result_.ticks;
    for (const wire::Frame& frame : frames_) (void)can_.send(to_hal(frame));  // counted there
    if (authentic_ != nullptr) teller_.tell(out_, *authentic_);
    log(frames_);
    if (log_) log_->flush();
  }

  /// Takes what has come, up to the Command frame that answers this tick or one of the last `oldest`.
  bool take_frames(unsigned oldest) {
    bool answered = false;
    hal::CanFrame received;
    while (can_.receive(received)) {
      if (received.length > 8) continue;  // no FD frame is ours
      const wire::Frame frame = to_wire(received);
      // Until its first command the ECU only says that it is there.
      if (!first_answer_ && frame.id == wire::kVersionEcuId) continue;
      log({frame});
      if (frame.id != wire::kCommandId) continue;
      if (!answers(frame, oldest)) {
        ++result_.refused_commands;
        refused_text_ = "the last command refused " + reason_of_refusal(frame);
        continue;
      }
      first_answer_ = answered = true;
      world_.receive(frame);
      if (!options_.realtime) return true;
    }
    return answered;
  }

  static std::string reason_of_refusal(const wire::Frame& frame) {
    wire::Command command;
    if (!wire::e2e_crc_fits(frame)) return "has a wrong CRC";
    if (!wire::decode(frame, command)) return "is no command";
    return "echoes tick " + std::to_string(command.tick);
  }

  [[nodiscard]] bool answers(const wire::Frame& frame, unsigned oldest) const {
    return nodes::answers_tick(frame, static_cast<unsigned>(result_.ticks), oldest, !first_answer_);
  }

  void log(const std::vector<wire::Frame>& frames) {
    constexpr std::uint64_t kTick_us = 10'000;
    const std::uint64_t time_us = static_cast<std::uint64_t>(result_.ticks - 1) * kTick_us;
    if (log_) log_->write(time_us, frames);
    if (options_.record) options_.record(time_us, frames);
  }

  [[nodiscard]] bool usable() const {
    return can_.state() == hal::CanState::kActive || can_.state() == hal::CanState::kPassive;
  }

  hal::linux_host::LinuxCan& can_;
  secoc::AuthenticCan* authentic_;
  SessionTeller teller_{"world"};
  const WorldProcessOptions& options_;
  std::ostream& out_;
  const std::atomic<bool>& stop_;
  world::World world_;
  std::optional<campaign::BusLog> log_;
  std::vector<wire::Frame> frames_;
  WorldProcessResult result_;
  std::string refused_text_ = "no command was refused so far";
  bool first_answer_ = false;
  bool link_was_down_ = false;
};

}  // namespace

WorldProcessResult run_world(const scenario::Scenario& scenario, hal::linux_host::LinuxCan& can,
                             const WorldProcessOptions& options, std::ostream& out,
                             const std::atomic<bool>& stop) {
  if (options.keys == nullptr) return Session(scenario, can, nullptr, options, out, stop).run();
  const auto link = std::make_unique<AuthenticLink>(can, *options.keys, secoc::End::kWorld);
  return Session(scenario, *link, &link->authentic(), options, out, stop).run();
}

void print_link(std::ostream& out, const WorldProcessOptions& options, const WorldProcessResult& result,
                hal::linux_host::LinuxCan& can) {
  out << "world: " << result.ticks << " ticks, " << result.unanswered << " unanswered, "
      << result.refused_commands << " commands refused";
  out << '\n';
  print_counters(out, "world on " + options.bus, can.counters());
  if (result.timing) print(out, *result.timing);
}

}  // namespace s4tp::processes
