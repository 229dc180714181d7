#include "firmware/ecu/reports.hpp"

#include "algo/core/check.hpp"
#include "algo/core/versions.hpp"
#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/version.hpp"

namespace s4tp::ecu {
namespace {

template <class Message>
void send(hal::Can& can, const Message& message, wire::E2eSender& sender) {
  wire::Frame frame;
  const bool encoded = wire::encode(message, frame);
  S4TP_ASSERT(encoded);  // every value below is brought into its range
  sender.protect(frame);
  static_cast<void>(can.send(to_hal(frame)));
}

template <class Integer>
Integer at_most(std::uint32_t value, std::uint32_t bound) {
  return static_cast<Integer>(value < bound ? value : bound);
}

}  // namespace

void Reporter::command(hal::Can& can, const gate::Command& command, Mode mode, std::uint32_t tick,
                       std::uint32_t accepted) {
  wire::Command message;
  message.acceleration_mps2 = command.acceleration_mps2;
  message.steering_rad = command.steering_rad;
  message.mode = static_cast<std::uint8_t>(mode);
  message.tick = static_cast<std::uint16_t>(tick & 0xFFFU);
  message.accepted = static_cast<std::uint16_t>(accepted & 0xFFFU);
  send(can, message, command_);
}

void Reporter::status(hal::Can& can, const StatusReport& report) {
  wire::EcuStatus message;
  message.mode = static_cast<std::uint8_t>(report.mode);
  message.planner_status = static_cast<std::uint8_t>(report.planner);
  message.faults = report.faults;
  message.plan_kind = static_cast<std::uint8_t>(report.plan_kind);
  message.plan_age_10ms = at_most<std::uint8_t>(report.plan_age_ms / 10U, 255);
  message.deadline_misses = static_cast<std::uint8_t>(report.deadline_misses & 0xFFU);
  message.rejected_frames = static_cast<std::uint8_t>(report.rejected_frames & 0xFFU);
  send(can, message, status_);
}

void Reporter::statistics(hal::Can& can, const CycleStatistics& cycles) {
  constexpr std::uint32_t kMaxKcycles = 0xFFFFF;
  wire::CycleStatistics message;
  message.last_kcycles = at_most<std::uint32_t>(cycles.last / 1000U, kMaxKcycles);
  message.maximum_kcycles = at_most<std::uint32_t>(cycles.maximum / 1000U, kMaxKcycles);
  message.slips = at_most<std::uint16_t>(cycles.slips, 0xFFF);
  send(can, message, statistics_);
}

void Reporter::version(hal::Can& can, satp::WeightStatus weights) {
  wire::VersionEcu message;
  message.wire_version = wire::wire_version();
  message.layout_hash = wire::layout_hash();
  message.api_version = kApiVersion;
  message.weights = static_cast<std::uint8_t>(weights);
  send(can, message, version_);
}

void Reporter::plan(hal::Can& can, std::uint32_t sequence, std::uint32_t digest,
                    const planner::Explanation& explanation) {
  wire::PlanDigest plan;
  plan.sequence = static_cast<std::uint16_t>(sequence & 0xFFFFU);
  plan.digest = digest;
  send(can, plan, digest_);

  std::uint32_t rejected = 0;
  for (const trajectory::Rejection rejection : explanation.rejections) {
    if (rejection != trajectory::Rejection::kNone) ++rejected;
  }
  wire::PlanReason reason;
  reason.path = at_most<std::uint8_t>(explanation.chosen.path, 3);
  reason.intent = at_most<std::uint8_t>(static_cast<std::uint32_t>(explanation.chosen.intent), 3);
  reason.candidates = at_most<std::uint8_t>(explanation.candidate_count, 31);
  reason.rejected = at_most<std::uint8_t>(rejected, 31);
  reason.left_out = at_most<std::uint8_t>(explanation.left_out, 31);
  reason.check = at_most<std::uint8_t>(static_cast<std::uint32_t>(explanation.blocking.verdict.cause), 7);
  reason.dominating_track = explanation.dominating_track;
  reason.dominating_step = at_most<std::uint8_t>(explanation.dominating_step, 31);
  reason.id_clashes = at_most<std::uint8_t>(explanation.id_clashes, 31);
  reason.tracks_left_out = at_most<std::uint8_t>(explanation.tracks_left_out, 31);
  reason.lanes_left_out = at_most<std::uint8_t>(explanation.lanes_left_out, 31);
  reason.learned = explanation.learned ? 1 : 0;
  reason.unseen = explanation.blocking.unseen() ? 1 : 0;
  send(can, reason, reason_);
}

}  // namespace s4tp::ecu
