#pragma once
/// What a stage of the planner's cycle tells of itself: to the probe when it begins and ends, to the
/// explanation its work.

#include "algo/planner/probe.hpp"

namespace s4tp::planner {

/// Tells the probe about one stage, from construction to the end of the scope.
class StageScope {
 public:
  StageScope(Probe* probe, Stage stage) : probe_(probe), stage_(stage) {
    if (probe_ != nullptr) probe_->stage_begin(stage_);
  }
  ~StageScope() {
    if (probe_ != nullptr) probe_->stage_end(stage_);
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  Probe* probe_;
  Stage stage_;
};

/// A stage in the midst of another one, which rests meanwhile.
class InnerStageScope {
 public:
  InnerStageScope(Probe* probe, Stage outer, Stage inner) : probe_(probe), outer_(outer), inner_(inner) {
    if (probe_ == nullptr) return;
    probe_->stage_end(outer_);
    probe_->stage_begin(inner_);
  }
  ~InnerStageScope() {
    if (probe_ == nullptr) return;
    probe_->stage_end(inner_);
    probe_->stage_begin(outer_);
  }
  InnerStageScope(const InnerStageScope&) = delete;
  InnerStageScope& operator=(const InnerStageScope&) = delete;

 private:
  Probe* probe_;
  Stage outer_;
  Stage inner_;
};

inline void count(Explanation& explanation, Stage stage, int work) {
  std::uint16_t& total = explanation.work[static_cast<int>(stage)];
  total = static_cast<std::uint16_t>(total + work);
}

}  // namespace s4tp::planner
