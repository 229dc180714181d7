#pragma once
/// The ECU application: frames in, frames out, two contexts.
///
///   control_tick()    100 Hz: takes frames, supervises, tracks the plan, gates, sends the command
///   planning_cycle()  background: snapshot -> PlannerT::plan -> plan for the next 100 ms boundary
///
/// \code
///   vehicle time    k*100              (k+1)*100            (k+2)*100
///   control      ---| snapshot k |------| plan k in force |---| ...
///   planning           [ plan() ......]
/// \endcode
/// ECU-075 A plan takes effect exactly at the boundary after its snapshot, whatever its computation took.
/// ECU-076 A boundary that finds the planner still busy keeps the old plan, counts a deadline miss and gives
/// no snapshot; what the planner then finishes is thrown away. So the only thing the contexts' speed can
/// change is that one bit a boundary, and a replay that injects it gives the same commands.
/// ECU-077 What is on the bus before a boundary is in the commands 200 ms later at most.
///
/// The contexts share one snapshot slot (an EventRing of one: a busy planner's next snapshot is dropped) and
/// the triple buffer of results. PlannerT offers init() and plan() as s4tp::Planner does, so other planners
/// drive the same car.

#include <cstdint>

#include "firmware/ecu/ecu_core.hpp"
#include "firmware/ecu/planner_weights.hpp"

namespace s4tp::ecu {

template <class PlannerT>
class Ecu {
 public:
  /// Once, before either context runs. \return what the planner's init() says; kInvalidInput without can,
  /// cycles or watchdog. ECU-078 After a refusal control runs on: it says kFault and drives nothing.
  /// ECU-102 A planner that predicts with a network takes its weights from ports.weights, where something is
  /// written there. Are they refused, it drives with the kinematic model, and the bus is told why (ECU-103).
  [[nodiscard]] Status init(const Parameters& parameters, const Ports& ports) {
    if (ports.can == nullptr || ports.cycles == nullptr || ports.watchdog == nullptr) {
      return Status::kInvalidInput;
    }
    if (ports.weights != nullptr) PlannerWeights<PlannerT>::take(planner_, *ports.weights);
    planner_ready_ = planner_.init(parameters);
    planner_crc_ = parameters_crc(parameters);
    core_.init(parameters, ports, planner_ready_ != Status::kOk, PlannerWeights<PlannerT>::status(planner_));
    return planner_ready_;
  }

  /// Control context, between ticks. \param crc  parameters_crc() as the sender computed it
  [[nodiscard]] UpdateResult update_parameters(const Parameters& parameters, std::uint32_t crc) {
    return core_.update_parameters(parameters, crc);
  }

  /// Control context, once a tick.
  void control_tick() { core_.control_tick(); }
  /// Planning context: a boundary passed.
  [[nodiscard]] bool planning_due() const { return core_.planning_due(); }
  /// Planning context: one cycle, when one is due.
  void planning_cycle() {
    if (!core_.planning_due()) return;
    CycleResult* result = nullptr;
    const Snapshot& snapshot = core_.begin_cycle(result);
    if (snapshot.parameters_crc != planner_crc_) {
      planner_ready_ = planner_.init(snapshot.parameters);
      planner_crc_ = snapshot.parameters_crc;
    }
    result->status = planner_ready_;
    if (planner_ready_ == Status::kOk) {
      result->status = planner_.plan(snapshot.input, result->plan, result->explanation);
    }
    core_.end_cycle();
  }
  /// Control context (replay and tests): the next boundary finds the planner still busy.
  void inject_deadline_miss() { core_.inject_deadline_miss(); }

  [[nodiscard]] Mode mode() const { return core_.mode(); }
  [[nodiscard]] Faults faults() const { return core_.faults(); }
  /// The plan in force; control context.
  [[nodiscard]] const Plan& plan() const { return core_.plan(); }
  [[nodiscard]] const EcuCore& core() const { return core_; }
  /// For probe and allowance, before driving.
  [[nodiscard]] PlannerT& planner() { return planner_; }

 private:
  EcuCore core_;
  PlannerT planner_;
  Status planner_ready_ = Status::kNotInitialized;  ///< answer of its last init(); planning context
  std::uint32_t planner_crc_ = 0;                   ///< of the parameters it has; planning context
};

/// All static memory but the planner: 128 KiB less planner 64, heat map 8, bus buffers 4 (docs/budget.md).
static_assert(sizeof(EcuCore) <= 52 * 1024, "the ECU's share of static memory is used up");

}  // namespace s4tp::ecu
