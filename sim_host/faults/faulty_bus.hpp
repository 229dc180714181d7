#pragma once
/// Applies a fault script to the frames between world and ECU. Lists that are too long, and senders that lie
/// in other ways, seal what they say: end-to-end protection does not find them out.

#include <cstdint>
#include <map>
#include <vector>

#include "firmware/wire/frame.hpp"
#include "hal/can.hpp"
#include "sim_host/faults/list_sealer.hpp"
#include "sim_host/faults/script.hpp"

namespace s4tp::faults {

class FaultyBus {
 public:
  explicit FaultyBus(const FaultScript& script);

  /// FAULT-003 What becomes of one tick's frames on their way, fault by fault in the script's order. The
  /// choices of a fault depend on its dice, the tick and the frame's place only.
  [[nodiscard]] std::vector<wire::Frame> to_ecu(int tick, std::vector<wire::Frame> frames);
  [[nodiscard]] std::vector<wire::Frame> to_world(int tick, std::vector<wire::Frame> frames);

  /// Of the ECU's controller.
  [[nodiscard]] hal::CanState controller(int tick) const;
  /// Whether a boundary in this tick is to find the planner busy.
  [[nodiscard]] bool plan_late(int tick) const;
  /// Nothing of the script is active in this tick, nor on its way, nor will be.
  [[nodiscard]] bool over(int tick) const;

 private:
  using Frames = std::vector<wire::Frame>;
  struct Delayed {
    int due_tick;
    wire::Frame frame;
  };
  /// A fault and what it remembers.
  struct Source {
    Fault fault;
    std::vector<Delayed> delayed_to_ecu;
    std::vector<Delayed> delayed_to_world;
    std::map<std::uint32_t, wire::Frame> held;  ///< by message and, of list members, index
  };

  static void apply(Source& source, int tick, Frames& frames, std::vector<Delayed>& delayed);
  static void delay(const Fault& fault, int tick, Frames& frames, std::vector<Delayed>& delayed);

  std::vector<Source> sources_;
  ListSealer sealer_;
  int last_tick_ = 0;  ///< with a fault
};

}  // namespace s4tp::faults
