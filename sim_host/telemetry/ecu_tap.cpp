#include "sim_host/telemetry/ecu_tap.hpp"

#include <time.h>

#include <algorithm>

namespace s4tp::telemetry {
namespace {

constexpr std::uint32_t kStatusTicks = 10;

std::uint64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // answered without the kernel
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(now.tv_nsec);
}

template <std::size_t N>
void keep(const std::string& text, char (&kept)[N]) {
  const std::size_t length = std::min(text.size(), N - 1);
  std::copy_n(text.begin(), length, kept);
  kept[length] = '\0';
}

}  // namespace

bool EcuTap::open(const std::string& name, const std::string& planner, const std::string& bus,
                  const Parameters& parameters, hal::linux_host::Reason& reason) {
  if (!memory_.create(name.c_str(), kLayout, reason)) return false;
  IdentityRecord identity;
  keep(planner, identity.planner);
  keep(bus, identity.bus);
  identity.parameters = parameters;
  memory_.write(kIdentity, &identity);
  return true;
}

void EcuTap::note_status(const ecu::EcuCore& core, const hal::Can& can) {
  if (!memory_.is_open() || ticks_++ % kStatusTicks != 0) return;
  StatusRecord status;
  status.time_ms = core.now_ms();
  status.cycles = core.statistics();
  status.accepted_frames = core.inputs().accepted_frames();
  status.rejected_frames = core.inputs().rejected_frames();
  status.bus = can.counters();
  status.bus_state = can.state();
  memory_.write(kStatus, &status);
}

bool EcuTap::publish(std::uint16_t kind, const void* record, std::uint32_t size) {
  const bool taken = next_ == nullptr || next_->publish(kind, record, size);
  switch (static_cast<ecu::RecordKind>(kind)) {
    case ecu::RecordKind::kPlan:
      memory_.write(kPlan, record);
      break;
    case ecu::RecordKind::kControl:
      memory_.write(kControl, record);
      break;
    case ecu::RecordKind::kModeChange:
      memory_.write(kModeChanges, record);
      break;
  }
  return taken;
}

void EcuTap::stage_begin(planner::Stage stage) {
  if (next_probe_ != nullptr) next_probe_->stage_begin(stage);
  stage_began_ns_ = now_ns();
}

void EcuTap::stage_end(planner::Stage stage) {
  cycle_.stage_ns[static_cast<int>(stage)] += static_cast<std::uint32_t>(now_ns() - stage_began_ns_);
  if (next_probe_ != nullptr) next_probe_->stage_end(stage);
}

void EcuTap::candidates_done(const planner::CandidatesView& view) {
  if (next_probe_ != nullptr) next_probe_->candidates_done(view);
  if (!memory_.is_open()) return;
  cycle_.has_candidates = true;
  cycle_.start = view.start;
  cycle_.running = view.running;
  std::copy(std::begin(view.lines), std::end(view.lines), std::begin(cycle_.lines));
  cycle_.candidates = view.candidates;
  std::copy(std::begin(view.costs), std::end(view.costs), std::begin(cycle_.costs));
}

void EcuTap::cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                        const sadrf::RiskProfile& risk) {
  if (next_probe_ != nullptr) next_probe_->cycle_done(scene, prediction, risk);
  if (memory_.is_open()) {
    cycle_.scene = scene;
    cycle_.scene.map = nullptr;
    cycle_.has_map = scene.map != nullptr;
    if (scene.map != nullptr) cycle_.map = *scene.map;
    cycle_.prediction = prediction;
    memory_.write(kCycle, &cycle_);
  }
  cycle_.has_candidates = false;
  std::fill(std::begin(cycle_.stage_ns), std::end(cycle_.stage_ns), 0U);
}

}  // namespace s4tp::telemetry
