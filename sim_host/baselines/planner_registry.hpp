#pragma once
/// The planners there are. A planner is one file in sim_host/baselines that registers itself; nothing else
/// names it:
///
/// \code
///     const RegisterPlanner kMine{planner<MyPlanner>("mine", "what it is, in a line")};
/// \endcode
/// MyPlanner offers init() and plan() as s4tp::Planner does. It plans bare; the guard is put around it here
/// (sim_host/baselines/guard.hpp), unless its file says otherwise. The files are linked as objects: an
/// archive would leave out what nobody names.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/ecu/ecu.hpp"
#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/baselines/guard.hpp"

namespace s4tp::baselines {

using EcuFactory = std::unique_ptr<AnyEcu> (*)(const Parameters&, const ecu::Ports&, planner::Probe*);

struct PlannerEntry {
  std::string name;
  std::string meaning;  ///< one line, for help and reports
  EcuFactory bare;      ///< what it plans goes to the command gate as it is
  EcuFactory guarded;   ///< with the guard, and the last fail-safe where nothing passes
  /// Not a planner of ours but SUMO's own driver in the ego's place: no ECU, no factories, nothing to guard.
  bool drives_in_sumo = false;
};

/// \throws std::invalid_argument naming those there are
[[nodiscard]] const PlannerEntry& find_planner(const std::string& name);

/// In the order of names, s4tp first.
[[nodiscard]] const std::vector<PlannerEntry>& planners();

class RegisterPlanner {
 public:
  /// \throws std::logic_error when the name is taken
  explicit RegisterPlanner(const PlannerEntry& entry);
};

/// Planners that have a probe, or a planner inside that has one, tell it.
template <class PlannerT>
void set_probe(PlannerT& planner, planner::Probe* probe) {
  if constexpr (requires { planner.probe = probe; }) {
    planner.probe = probe;
  } else if constexpr (requires { planner.inner(); }) {
    set_probe(planner.inner(), probe);
  }
}

/// An ECU with a planner of that type. \throws std::invalid_argument when it refuses to start
template <class PlannerT>
std::unique_ptr<AnyEcu> ecu_with(const Parameters& parameters, const ecu::Ports& ports,
                                 planner::Probe* probe) {
  class EcuWith final : public AnyEcu {
   public:
    EcuWith(const Parameters& with_parameters, const ecu::Ports& with_ports, planner::Probe* with_probe) {
      if (const Status status = ecu_.init(with_parameters, with_ports); status != Status::kOk) {
        throw std::invalid_argument(std::string("the ECU refused to start: ") + status_name(status));
      }
      set_probe(ecu_.planner(), with_probe);
    }
    void control_tick() override { ecu_.control_tick(); }
    bool planning_due() const override { return ecu_.planning_due(); }
    void planning_cycle() override { ecu_.planning_cycle(); }
    void inject_deadline_miss() override { ecu_.inject_deadline_miss(); }
    const ecu::EcuCore& core() const override { return ecu_.core(); }

   private:
    ecu::Ecu<PlannerT> ecu_;
  };
  return std::make_unique<EcuWith>(parameters, ports, probe);
}

/// The entry of a planner that has no guard of its own.
template <class PlannerT>
PlannerEntry planner(const std::string& name, const std::string& meaning) {
  return {name, meaning, ecu_with<PlannerT>, ecu_with<Guarded<PlannerT>>};
}

}  // namespace s4tp::baselines
