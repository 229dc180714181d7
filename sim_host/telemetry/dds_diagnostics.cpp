/// Diagnostics: mode, faults, cycles, the bus, and what became of the input.

#include <cstdio>
#include <string>

#include "sim_host/campaign/fault_names.hpp"
#include "sim_host/telemetry/dds_header.hpp"
#include "sim_host/telemetry/dds_messages.hpp"

namespace s4tp::telemetry {
namespace {

template <class Sequence>
class Values {
 public:
  Values(Sequence& sequence, std::size_t most, Arena& arena)
      : sequence_(sequence), next_(arena.sequence(sequence, most)), arena_(arena) {
    sequence_._length = 0;
  }
  void add(const char* key, const std::string& value) {
    next_->key = arena_.text(key);
    next_->value = arena_.text(value);
    ++next_;
    ++sequence_._length;
  }
  void add(const char* key, double value, int digits = 0) {
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    add(key, text);
  }

 private:
  Sequence& sequence_;
  diagnostic_msgs_msg_dds__KeyValue_* next_;
  Arena& arena_;
};

constexpr std::uint8_t kFine = 0;
constexpr std::uint8_t kWarning = 1;
constexpr std::uint8_t kError = 2;

void describe(const InputReport& input, diagnostic_msgs_msg_dds__DiagnosticStatus_& status, Arena& arena) {
  const bool refused = input.objects.refused() + input.maps.refused() > 0;
  status.hardware_id = arena.text("s4tp");
  status.name = arena.text("s4tp: input over DDS");
  status.level = refused ? kWarning : kFine;
  status.message = arena.text(refused ? "messages refused" : "nothing refused");
  Values values(status.values, 2 * static_cast<std::size_t>(Refusal::kCount), arena);
  for (int i = 0; i < static_cast<int>(Refusal::kCount); ++i) {
    const std::string text = refusal_text(static_cast<Refusal>(i));
    values.add(("object lists: " + text).c_str(), static_cast<double>(input.objects.by[i]));
    values.add(("maps: " + text).c_str(), static_cast<double>(input.maps.by[i]));
  }
}

}  // namespace

DiagnosticArray diagnostics(const ecu::ControlRecord& control, const StatusRecord& status,
                            const CycleRecord* cycle, const InputReport* input, Arena& arena) {
  static constexpr const char* kStages[planner::kStageCount] = {
      "scene", "candidates", "predict", "rank", "exact risk", "optimize", "check", "explain"};
  static constexpr const char* kStates[] = {"error-active", "error-passive", "bus off", "down"};
  DiagnosticArray result{};
  result.header = header(control.time_ms, "", arena);
  auto* one = arena.sequence(result.status, input != nullptr ? 4 : 3);
  if (input != nullptr) describe(*input, one[3], arena);
  for (int i = 0; i < 3; ++i) one[i].hardware_id = arena.text("s4tp");

  const std::string faults = campaign::fault_names(control.faults);
  one[0].name = arena.text("s4tp: mode");
  one[0].message = arena.text(ecu::mode_name(control.mode));
  const bool ended = control.mode == ecu::Mode::kMinimumRisk || control.mode == ecu::Mode::kFault;
  one[0].level = ended ? kError : control.faults != 0 ? kWarning : kFine;
  Values mode(one[0].values, 2, arena);
  mode.add("faults", faults.empty() ? "none" : faults);
  mode.add("violations of the gate's limits", control.violations);

  one[1].name = arena.text("s4tp: planning");
  one[1].level = status.cycles.slips > 0 ? kWarning : kFine;
  one[1].message = arena.text(status.cycles.slips > 0 ? "deadlines missed" : "in time");
  Values planning(one[1].values, 2 + planner::kStageCount, arena);
  planning.add("cycles", status.cycles.count);
  planning.add("deadlines missed", status.cycles.slips);
  for (int i = 0; cycle != nullptr && i < planner::kStageCount; ++i)
    planning.add(kStages[i], 0.001 * cycle->stage_ns[i], 1);  // us

  one[2].name = arena.text("s4tp: bus");
  one[2].message = arena.text(kStates[static_cast<int>(status.bus_state)]);
  one[2].level = status.bus_state == hal::CanState::kActive ? kFine : kError;
  Values bus(one[2].values, 6, arena);
  bus.add("frames taken", status.accepted_frames);
  bus.add("frames not believed", status.rejected_frames);
  bus.add("sent", status.bus.sent);
  bus.add("received", status.bus.received);
  bus.add("dropped", status.bus.dropped);
  bus.add("errors", status.bus.errors);
  return result;
}

DiagnosticArray diagnostics(const InputReport& input, Arena& arena) {
  DiagnosticArray result{};
  result.header = header(0, "", arena);
  describe(input, *arena.sequence(result.status, 1), arena);
  return result;
}

}  // namespace s4tp::telemetry
