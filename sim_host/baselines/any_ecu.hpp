#pragma once
/// An ECU whose planner is chosen by name, on whatever ports it is given.

#include <memory>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "algo/planner/probe.hpp"
#include "firmware/ecu/ecu_core.hpp"

namespace s4tp::baselines {

/// ecu::Ecu without its type; the same two contexts.
class AnyEcu {
 public:
  virtual ~AnyEcu() = default;
  virtual void control_tick() = 0;
  [[nodiscard]] virtual bool planning_due() const = 0;
  virtual void planning_cycle() = 0;
  virtual void inject_deadline_miss() = 0;
  [[nodiscard]] virtual const ecu::EcuCore& core() const = 0;
};

/// Names make_ecu() accepts, s4tp first (planner_registry.hpp).
[[nodiscard]] std::vector<std::string> planner_names();

/// \param guarded  with the guard behind the planner, and the last fail-safe where nothing passes
/// \param probe    may be null; not every planner has something to tell it
/// \throws std::invalid_argument naming the planners there are, or the first bad parameter
[[nodiscard]] std::unique_ptr<AnyEcu> make_ecu(const std::string& planner, bool guarded,
                                               const Parameters& parameters, const ecu::Ports& ports,
                                               planner::Probe* probe);

}  // namespace s4tp::baselines
