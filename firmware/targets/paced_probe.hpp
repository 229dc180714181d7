#pragma once
/// Planning stretched over its whole period, as the slowest processor that keeps up would need it: after each
/// stage it computes on, to no purpose, until that stage's share of the period's control ticks has
/// interrupted it. So all of them do, in every cycle, however fast the emulation and however slow the world
/// are.

#include <cstdint>

#include "algo/planner/probe.hpp"

namespace s4tp::targets {

class PacedProbe final : public planner::Probe {
 public:
  /// What the interrupts count; plain memory, so that the loop costs an emulator little.
  struct Counts {
    const volatile std::uint32_t& ticks;   ///< control ticks since the boundary
    const volatile std::uint32_t& timers;  ///< timer interrupts
  };
  /// \param measure  told of each stage, without the stretching
  PacedProbe(planner::Probe& measure, const Counts& counts) : measure_(measure), counts_(counts) {}

  void begin_cycle() { began_ = counts_.timers; }

  void stage_begin(planner::Stage stage) override { measure_.stage_begin(stage); }
  void stage_end(planner::Stage stage) override {
    measure_.stage_end(stage);
    const std::uint32_t share = kTicks * (static_cast<std::uint32_t>(stage) + 1U) / planner::kStageCount;
    while (counts_.ticks < share && counts_.timers - began_ < kPatience) {
    }
  }
  void cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                  const sadrf::RiskProfile& risk) override {
    measure_.cycle_done(scene, prediction, risk);
  }

 private:
  static constexpr std::uint32_t kTicks = 9;  ///< between two boundaries
  /// Timer interrupts, 1 ms of 64 ns an instruction each: a world that has ended is not waited for.
  static constexpr std::uint32_t kPatience = 20'000;

  planner::Probe& measure_;
  Counts counts_;
  std::uint32_t began_ = 0;
};

}  // namespace s4tp::targets
