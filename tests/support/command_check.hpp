#pragma once
/// Judges the commands on a bus from outside, frame by frame: a gate of its own sees what the ECU's gate saw
/// and must have nothing to change; modes change by the ECU's table only. A command is taken for the ECU's
/// if its CRC fits, it echoes a tick of late, and it does not stand between two that follow each other.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/ecu/modes.hpp"
#include "firmware/gate/command_gate.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::ecu {

class CommandCheck {
 public:
  /// Of every frame, in the order of the bus.
  void take(const wire::Frame& frame) {
    wire::Tick tick;
    wire::Command command;
    arrived_.push_back(frame);
    if (!wire::e2e_crc_fits(frame)) return;
    // An invented frame is nobody's tick; the world's numbers rise by one.
    if (wire::decode(frame, tick) && tick.tick == static_cast<std::uint16_t>(tick_ + 1)) {
      tick_ = tick.tick;
      ticks_.push_back({tick_, std::move(arrived_)});
      arrived_.clear();
    } else if (wire::decode(frame, command) && answers(command)) {
      hear({command, frame, tick_});
    }
  }
  /// After the last frame: the last command is judged, too.
  void end() {
    if (held_) judge(*held_);
    held_.reset();
  }

  [[nodiscard]] int ticks() const { return tick_; }
  [[nodiscard]] int commands() const { return commands_; }
  [[nodiscard]] int commands_in(Mode mode) const { return in_mode_[static_cast<int>(mode)]; }
  /// What was wrong, a line each.
  [[nodiscard]] const std::vector<std::string>& findings() const { return findings_; }

 private:
  // Half a step of the wire for each of two roundings, and a little.
  static constexpr float kAccelerationTolerance = 0.006F;
  static constexpr float kSteeringTolerance = 0.00025F;

  static constexpr unsigned kOldestEcho = 10;  // others are not the ECU's

  struct Heard {
    wire::Command command;
    wire::Frame frame;
    std::uint16_t tick;  ///< the last one before it
  };

  [[nodiscard]] bool answers(const wire::Command& command) const {
    return tick_ > 0 && ((static_cast<unsigned>(tick_) - command.tick) & 0xFFFU) <= kOldestEcho;
  }

  /// What came up to the tick that is answered is what the ECU knew; in real time others may have begun.
  void begin_ticks_up_to(unsigned echo) {
    while (!ticks_.empty() && ((echo - ticks_.front().number) & 0xFFFU) <= 0x7FFU) {
      for (const wire::Frame& frame : ticks_.front().frames) {
        gate_.observe(frame);
        wire::Steering steering;
        if (wire::e2e_crc_fits(frame) && wire::decode(frame, steering)) steering_rad_ = steering.steering_rad;
      }
      ticks_.pop_front();
    }
  }

  /// The one before is judged now: its successor tells whether it was the ECU's.
  void hear(const Heard& heard) {
    wire::E2eReceiver without_held = protection_;
    const bool forged = without_held.check(heard.frame) == wire::E2eState::kOk;
    if (held_ && !forged) judge(*held_);
    held_ = heard;
  }

  void judge(const Heard& heard) {
    const wire::Command& command = heard.command;
    static_cast<void>(protection_.check(heard.frame));
    begin_ticks_up_to(commands_ == 0 ? 1 : command.tick);
    ++commands_;
    const auto mode = static_cast<Mode>(command.mode);
    ++in_mode_[command.mode];
    if (mode != mode_ && !in_table(mode_, mode)) find(heard, "mode", static_cast<float>(mode_), command.mode);
    const bool begins = may_command(mode) && !may_command(mode_);
    if (begins || !may_command(mode)) gate_.reset(steering_rad_);
    mode_ = mode;
    gate::Command allowed{command.acceleration_mps2, command.steering_rad};
    static_cast<void>(gate_.apply(true, allowed));
    if (std::abs(allowed.acceleration_mps2 - command.acceleration_mps2) > kAccelerationTolerance &&
        may_command(mode))
      find(heard, "acceleration", allowed.acceleration_mps2, command.acceleration_mps2);
    if (std::abs(allowed.steering_rad - command.steering_rad) > kSteeringTolerance && may_command(mode))
      find(heard, "steering", allowed.steering_rad, command.steering_rad);
  }

  [[nodiscard]] static bool in_table(Mode from, Mode to) {
    for (int i = 0; i < kTransitionCount; ++i) {
      if (transition(i).from == from && transition(i).to == to) return true;
    }
    return false;
  }

  void find(const Heard& heard, const char* what, float allowed, float found) {
    char text[120];
    std::snprintf(text, sizeof text, "tick %d: %s %g where %g is allowed", static_cast<int>(heard.tick), what,
                  static_cast<double>(found), static_cast<double>(allowed));
    findings_.emplace_back(text);
  }

  gate::CommandGate gate_{gate::Limits{}};
  struct Tick {
    std::uint16_t number;
    std::vector<wire::Frame> frames;
  };
  std::deque<Tick> ticks_;  ///< not answered yet
  std::vector<wire::Frame> arrived_;
  std::uint16_t tick_ = 0;
  wire::E2eReceiver protection_;  ///< has seen the commands judged
  std::optional<Heard> held_;     ///< the command that is to be judged next
  float steering_rad_ = 0.0F;
  Mode mode_ = Mode::kStandby;
  int commands_ = 0;
  int in_mode_[8] = {};
  std::vector<std::string> findings_;
};

}  // namespace s4tp::ecu
