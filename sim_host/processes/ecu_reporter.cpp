#include "sim_host/processes/ecu_reporter.hpp"

#include <cstdio>

#include "firmware/ecu/modes.hpp"

namespace s4tp::processes {
namespace {

void print_change(std::ostream& out, const ecu::ModeRecord& change) {
  char text[80];
  std::snprintf(text, sizeof text, "ECU %8.2f s  %s -> %s", change.time_ms / 1000.0,
                ecu::mode_name(change.from), ecu::mode_name(change.to));
  out << text;
  for (int bit = 0; bit < ecu::kFaultCount; ++bit) {
    if ((change.faults >> bit & 1) != 0) out << ", fault ECU-0" << ecu::fault_requirement(bit);
  }
  out << std::endl;
}

}  // namespace

bool EcuReporter::publish(std::uint16_t kind, const void* record, std::uint32_t) {
  switch (static_cast<ecu::RecordKind>(kind)) {
    case ecu::RecordKind::kModeChange:
      if (ecu::ModeRecord* slot = modes_.claim(); slot != nullptr) {
        *slot = *static_cast<const ecu::ModeRecord*>(record);
        modes_.publish();
      }
      break;
    case ecu::RecordKind::kPlan:
      ++plans_;
      break;
    case ecu::RecordKind::kControl:
      break;
  }
  return true;
}

void EcuReporter::note_news(hal::linux_host::LinkNews news) {
  hal::linux_host::LinkNews* slot = news_.claim();
  if (slot == nullptr) return;
  *slot = news;
  news_.publish();
}

void EcuReporter::print(std::ostream& out, const std::string& bus) {
  for (; news_.front() != nullptr; news_.pop())
    out << bus << ": " << hal::linux_host::link_news_text(*news_.front()) << std::endl;
  for (; modes_.front() != nullptr; modes_.pop()) print_change(out, *modes_.front());
}

}  // namespace s4tp::processes
