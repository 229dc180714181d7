#include "sim_host/campaign/trace.hpp"

#include <cstring>

namespace s4tp::campaign {
namespace {

template <typename RecordT>
RecordT copy_of(const void* record) {
  RecordT copy;
  std::memcpy(&copy, record, sizeof copy);
  return copy;
}

}  // namespace

void EcuState::change(const ecu::ModeRecord& record) {
  if (record.to == ecu::Mode::kMinimumRisk || record.to == ecu::Mode::kFault) stopped_for = record.faults;
  mode = record.to;
}

bool Trace::publish(std::uint16_t kind, const void* record, std::uint32_t size) {
  switch (static_cast<ecu::RecordKind>(kind)) {
    case ecu::RecordKind::kPlan:
      if (size != sizeof(ecu::PlanRecord)) return false;
      pending_.record = copy_of<ecu::PlanRecord>(record);
      pending_.ecu = ecu_;
      cycles.push_back(std::move(pending_));
      pending_ = CycleTrace{};
      return true;
    case ecu::RecordKind::kControl:
      if (size != sizeof(ecu::ControlRecord)) return false;
      controls.push_back(copy_of<ecu::ControlRecord>(record));
      return true;
    case ecu::RecordKind::kModeChange:
      if (size != sizeof(ecu::ModeRecord)) return false;
      modes.push_back(copy_of<ecu::ModeRecord>(record));
      ecu_.change(modes.back());
      return true;
  }
  return false;
}

void Trace::cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                       const sadrf::RiskProfile& risk) {
  pending_.tracks.clear();
  for (const scene::Agent& agent : scene.agents) pending_.tracks.push_back(agent.track);
  pending_.predictions.assign(prediction.agents.begin(), prediction.agents.end());
  pending_.risk = risk;
}

}  // namespace s4tp::campaign
