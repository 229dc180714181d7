#pragma once
/// The ECU application: frames in, frames out, two contexts.
///
///   control_tick()    100 Hz: takes frames, supervises, tracks the plan, gates, sends the command
///   planning_cycle()  background: snapshot -> PlannerT::plan -> plan for the next 100 ms boundary
///
/// They share only triple buffers (newest wins) and bounded event rings. PlannerT offers init() and plan() as
/// s4tp::Planner does, so other planners drive the same car.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/planner/planner.hpp"
#include "firmware/ecu/modes.hpp"
#include "firmware/ecu/records.hpp"
#include "hal/can.hpp"
#include "hal/clock.hpp"
#include "hal/cycle_counter.hpp"
#include "hal/telemetry.hpp"
#include "hal/watchdog.hpp"

namespace s4tp::ecu {

/// What the ECU stands on. Telemetry may be null.
struct Ports {
  hal::Can* can = nullptr;
  hal::Clock* clock = nullptr;
  hal::CycleCounter* cycles = nullptr;
  hal::Watchdog* watchdog = nullptr;
  hal::Telemetry* telemetry = nullptr;
};

// The class template Ecu<PlannerT> is written by the ecu room:
//
//   template <class PlannerT> class Ecu {
//    public:
//     [[nodiscard]] Status init(const Parameters& parameters, const Ports& ports);
//     void control_tick();                  // control context
//     [[nodiscard]] bool planning_due();    // planning context: a boundary passed
//     void planning_cycle();                // planning context
//     void inject_deadline_miss();          // replay and tests: the cycle running now is too late
//     [[nodiscard]] Mode mode() const;
//     [[nodiscard]] std::uint16_t faults() const;
//     PlannerT& planner();                  // for probe and allowance, before driving
//   };

}  // namespace s4tp::ecu
