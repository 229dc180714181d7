#include "sim_host/faults/fault_run.hpp"

#include <algorithm>
#include <iomanip>
#include <stdexcept>

#include "algo/core/parameters.hpp"
#include "firmware/can/frames.hpp"
#include "firmware/ecu/records.hpp"
#include "firmware/lockstep/lockstep_bus.hpp"
#include "firmware/wire/codec.hpp"
#include "hal/sim/bus.hpp"
#include "hal/sim/null_devices.hpp"
#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/campaign/fault_names.hpp"
#include "sim_host/faults/faulty_bus.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::faults {
namespace {

using Frames = std::vector<wire::Frame>;

/// Stands between the ECU and its controller, and shows the judge what the ECU takes.
class Witness final : public hal::Can {
 public:
  Witness(hal::Can& can, Judge& judge) : can_(can), judge_(judge) {}
  bool receive(hal::CanFrame& frame) override {
    if (!can_.receive(frame)) return false;
    taken.push_back(to_wire(frame));
    judge_.taken(taken.back());
    return true;
  }
  bool send(const hal::CanFrame& frame) override { return can_.send(frame); }
  hal::CanState state() const override { return can_.state(); }
  hal::CanCounters counters() const override { return can_.counters(); }

  Frames taken;

 private:
  hal::Can& can_;
  Judge& judge_;
};

class Story final : public hal::Telemetry {
 public:
  explicit Story(std::ostream* out) : out_(out) {}
  bool publish(std::uint16_t kind, const void* record, std::uint32_t) override {
    if (static_cast<ecu::RecordKind>(kind) != ecu::RecordKind::kModeChange) return true;
    const auto& change = *static_cast<const ecu::ModeRecord*>(record);
    modes |= 1U << static_cast<unsigned>(change.to);
    if (out_ == nullptr) return true;
    *out_ << "tick " << std::setw(5) << tick << ": " << ecu::mode_name(change.from) << " -> "
          << ecu::mode_name(change.to) << " (ECU-0" << static_cast<int>(change.reason) << ")";
    if (change.faults != 0)
      *out_ << ", faults 0x" << std::hex << change.faults << std::dec << ": "
            << campaign::fault_names(change.faults);
    *out_ << '\n';
    return true;
  }

  int tick = 0;
  unsigned modes = 1U;

 private:
  std::ostream* out_;
};

class Run {
 public:
  Run(const scenario::Scenario& scenario, const FaultScript& script, const RunOptions& options)
      : script_(script),
        options_(options),
        world_(scenario, world_options(script, options)),
        faults_(script),
        judge_(settling_ticks(script)),
        story_(options.story) {}

  RunResult run() {
    // A car that gets no commands is no reason to stop looking: they may come back.
    const auto goes_on = [this] {
      return !world_.finished() || world_.recording().ending == traffic::Ending::kDeadEcu;
    };
    for (int tick = 1 - kPreRollTicks; tick <= kRunTicks && goes_on() && !judge_.breached(); ++tick)
      step(tick);
    RunResult result;
    result.verdict = judge_.verdict();
    result.ending = world_.recording().ending;
    result.modes = story_.modes;
    result.own_fault = own_contact() != nullptr;
    return result;
  }

 private:
  static world::WorldOptions world_options(const FaultScript& script, const RunOptions& run) {
    world::WorldOptions options;
    options.sensors = run.sensors;
    options.seed = script.seed;
    options.pre_roll_s = kPreRollTicks * 0.01;
    return options;
  }

  [[nodiscard]] const traffic::Collision* own_contact() const {
    const std::vector<traffic::Collision>& all = world_.recording().collisions;
    const auto found = std::find_if(all.begin(), all.end(), [](const traffic::Collision& one) {
      return one.fault == traffic::Fault::kEgo;
    });
    return found == all.end() ? nullptr : &*found;
  }

  void step(int tick) {
    story_.tick = tick;
    Frames frames;
    world_.tick(frames);
    for (const wire::Frame& frame : frames) {
      wire::Motion motion;
      if (wire::decode(frame, motion)) speed_mps_ = static_cast<double>(motion.speed_mps);
      wire::Pose pose;
      if (wire::decode(frame, pose)) pose_ = pose;
    }
    judge_.begin_tick(tick, speed_mps_, faults_.over(tick));
    const hal::CanState state = faults_.controller(tick);
    ecu_port_->set_state(state);
    // A full queue loses the frame, which is as it should be in a burst.
    for (const wire::Frame& frame : faults_.to_ecu(tick, frames)) {
      static_cast<void>(world_port_->send(to_hal(frame)));
    }
    if (faults_.plan_late(tick) && tick % 10 == 0) ecu_->inject_deadline_miss();
    const bool off_bus = state == hal::CanState::kBusOff || state == hal::CanState::kDown;
    Frames sent;
    if (script_.tick == TickSource::kTimer) {
      control_tick(off_bus, sent);
    } else {
      const auto now_ms = static_cast<std::uint64_t>(10 * (tick + kPreRollTicks));
      while (lockstep_.take_tick(now_ms)) control_tick(off_bus, sent);
    }
    for (const wire::Frame& frame : faults_.to_world(tick, sent)) world_.receive(frame);
    if (options_.watch) options_.watch(tick, ecu_->core(), pose_);
    const traffic::Collision* const contact = honest(script_) ? own_contact() : nullptr;
    if (contact != nullptr) judge_.contact(traffic::cause_words(contact->fault, contact->cause));
    judge_.end_tick();
  }

  void control_tick(bool off_bus, Frames& to_world) {
    const std::uint32_t refused = ecu_port_->counters().dropped;
    witness_.taken.clear();
    ecu_->control_tick();
    if (ecu_->planning_due()) ecu_->planning_cycle();
    Frames sent;
    hal::CanFrame frame;
    while (world_port_->receive(frame)) sent.push_back(to_wire(frame));
    if (options_.defect) options_.defect(witness_.taken, sent);
    judge_.control_tick(sent, off_bus && ecu_port_->counters().dropped > refused);
    to_world.insert(to_world.end(), sent.begin(), sent.end());
  }

  const FaultScript& script_;
  const RunOptions& options_;
  world::World world_;
  FaultyBus faults_;
  Judge judge_;
  Story story_;
  hal::sim::Bus bus_;
  hal::sim::Bus::Port* world_port_ = bus_.attach();
  hal::sim::Bus::Port* ecu_port_ = bus_.attach();
  lockstep::LockstepBus lockstep_{*ecu_port_};
  Witness witness_{script_.tick == TickSource::kTimer ? static_cast<hal::Can&>(*ecu_port_) : lockstep_,
                   judge_};
  hal::sim::NullCycleCounter cycles_;
  hal::sim::NullWatchdog watchdog_;
  std::unique_ptr<baselines::AnyEcu> ecu_ =
      baselines::make_ecu("s4tp", true, Parameters{}, {&witness_, &cycles_, &watchdog_, &story_}, nullptr);
  double speed_mps_ = 0.0;
  wire::Pose pose_;
};

}  // namespace

RunResult run_script(const Scenarios& scenarios, const FaultScript& script, const RunOptions& options) {
  const auto run = std::make_unique<Run>(scenarios.at(script.scenario), script, options);
  return run->run();
}

}  // namespace s4tp::faults
