#include "firmware/ecu/ecu_core.hpp"

#include "algo/core/check.hpp"
#include "firmware/can/frames.hpp"
#include "firmware/ecu/gate_limits.hpp"
#include "firmware/ecu/map_conversion.hpp"
#include "firmware/ecu/plan_digest.hpp"

namespace s4tp::ecu {
namespace {

constexpr std::uint32_t kPeriodMs = static_cast<std::uint32_t>(kStepMs);
constexpr std::uint32_t kWellTicks = 100;  // ECU-026
constexpr std::uint32_t kPlanTicks = 20;   // ECU-031: so long ago at most, the plan in force was asked for
constexpr float kRestMps = 0.02F;
constexpr std::uint32_t kStatusTicks = 10;
constexpr std::uint32_t kSlowTicks = 100;
// Slow frames in different ticks, away from the boundary's.
constexpr std::uint32_t kStatusPhase = 5;
constexpr std::uint32_t kStatisticsPhase = 33;
constexpr std::uint32_t kVersionPhase = 66;

bool refuses(Status status) {
  return status == Status::kNotInitialized || status == Status::kArithmetic ||
         status == Status::kInvalidParameter;
}

}  // namespace

void EcuCore::init(const Parameters& parameters, const Ports& ports, bool refused,
                   satp::WeightStatus weights) {
  ports_ = ports;
  refused_ = refused;
  weights_ = weights;
  int first_bad = 0;
  if (validate(parameters, first_bad) == Status::kOk) take_parameters(parameters, parameters_crc(parameters));
}

UpdateResult EcuCore::update_parameters(const Parameters& parameters, std::uint32_t crc) {
  int first_bad = 0;
  if (mode_ != Mode::kStandby) return UpdateResult::kNotNow;
  if (parameters_crc(parameters) != crc) return UpdateResult::kWrongCrc;
  if (validate(parameters, first_bad) != Status::kOk) return UpdateResult::kInvalid;
  take_parameters(parameters, crc);
  return UpdateResult::kTaken;
}

void EcuCore::take_parameters(const Parameters& parameters, std::uint32_t crc) {
  parameters_ = parameters;
  parameters_crc_ = crc;
  const bool taken = gate_.set_limits(gate_limits(parameters));
  S4TP_ASSERT(taken);  // its ranges are wider than those of the parameters
}

void EcuCore::control_tick() {
  take_frames();
  const bool passed = pass_time();
  if (passed) take_result();
  supervise();
  change_mode();
  if (passed) give_snapshot();

  ControlRecord record;
  record.asked = ask();
  gate::Command command = record.asked;
  if (!may_command(mode_)) gate_.reset(inputs_.ego().steering_rad);
  record.violations = gate_.apply(may_command(mode_), command);
  gate_denied_ = may_command(mode_) && (record.violations & (gate::kDenied | gate::kMotionStale)) != 0;
  commanded_ = {command, may_command(mode_)};
  report(command);
  ports_.watchdog->kick();

  record.time_ms = inputs_.now_ms();
  record.mode = mode_;
  record.faults = faults_;
  record.sent = command;
  record.cross_track_m = tracker_.error().cross_m;
  record.along_track_m = tracker_.error().along_m;
  publish(RecordKind::kControl, &record, sizeof(record));
  ++ticks_;
}

void EcuCore::take_frames() {
  hal::CanFrame received;
  for (int i = 0; i < kMaxFramesPerTick && ports_.can->receive(received); ++i) {
    const wire::Frame frame = to_wire(received);
    inputs_.accept(frame);
    gate_.observe(frame);
  }
  inputs_.close_tick();
  plausibility_.update(inputs_.measured(), commanded_, inputs_.map(), parameters_);
}

bool EcuCore::pass_time() {
  const std::uint32_t now_ms = inputs_.now_ms();
  plan_age_.pass(now_ms - last_ms_);
  last_ms_ = now_ms;
  if (!boundary_known_) boundary_ms_ = now_ms - now_ms % kPeriodMs;
  const std::uint32_t since_ms = now_ms - boundary_ms_;
  boundary_ms_ += since_ms - since_ms % kPeriodMs;
  const bool passed = boundary_known_ && since_ms >= kPeriodMs;
  boundary_known_ = inputs_.ego_known();
  return passed;
}

void EcuCore::take_result() {
  // Read once: whether this boundary finds the planner busy decides all that follows, and a log shows it.
  planning_idle_ = snapshots_.drained() && !miss_injected_;
  miss_injected_ = false;
  if (!planning_idle_) {
    ++statistics_.slips;
    plan_late_ = true;
    return;
  }
  if (!results_.refresh()) return;
  const CycleResult& result = results_.front();
  planner_status_ = result.status;
  refused_ = refuses(result.status);
  ++statistics_.count;
  statistics_.last = result.cycles;
  if (result.cycles > statistics_.maximum) statistics_.maximum = result.cycles;

  plan_late_ = result.start_ms != boundary_ms_;
  if (plan_late_) return;  // its instant has passed
  if (result.plan.kind == PlanKind::kNone || refused_ || !is_finite(result.plan)) return;
  if (!takes(result.plan.kind)) return;
  plan_ = result.plan;
  explanation_ = result.explanation;
  plan_age_.renew();
  ++plan_sequence_;
  PlanRecord record;
  record.computed_ms = result.computed_ms;
  record.plan = plan_;
  record.explanation = explanation_;
  record.digest = plan_digest(plan_);
  reporter_.plan(*ports_.can, plan_sequence_, record.digest, explanation_);
  publish(RecordKind::kPlan, &record, sizeof(record));
}

bool EcuCore::takes(PlanKind kind) const {
  if ((plausibility_.faults() & kLyingFaults) != 0) return false;
  if (mode_ != Mode::kMinimumRisk) return true;
  return drives_fail_safe() && kind == PlanKind::kMinimumRisk;
}

void EcuCore::supervise() {
  Observations observed;
  inputs_.observe(observed);
  observed.plan_age_ms = plan_age_.ms();
  observed.plan_late = plan_late_;
  observed.refused = refused_;
  observed.gate_denied = gate_denied_;
  observed.bus = ports_.can->state();
  observed.implausible = plausibility_.faults();
  observed.plan_distance_m = tracker_.error().distance_m;
  faults_ = find_faults(observed);
  const bool held = fail_safe_holds_ || mode_ != Mode::kMinimumRisk;
  fail_safe_holds_ = held && (faults_ & kEndingFaults & ~kUnseenFaults & ~kSilentFaults) == 0;
  well_ticks_ = faults_ == 0 ? well_ticks_ + 1 : 0;
}

void EcuCore::change_mode() {
  // After an override the switch counts only once it has been off.
  if (!inputs_.engage_switch()) engage_armed_ = true;
  if (inputs_.driver_override()) engage_armed_ = false;
  Situation situation;
  situation.faults = faults_;
  situation.version_known = inputs_.version_known();
  situation.plan_at_hand = plan_.kind != PlanKind::kNone && well_ticks_ >= kPlanTicks;
  situation.engage = inputs_.engage_switch() && engage_armed_;
  situation.engage_released = !inputs_.engage_switch();
  situation.at_rest = inputs_.ego().speed_mps < kRestMps && inputs_.motion_fresh();
  situation.well = well_ticks_ >= kWellTicks;
  const Transition* row = find_transition(mode_, situation);
  if (row == nullptr) return;
  const ModeRecord record{inputs_.now_ms(), mode_, row->to, row->id, faults_};
  publish(RecordKind::kModeChange, &record, sizeof(record));
  if (!may_command(mode_) && may_command(row->to)) {
    tracker_.reset(inputs_.ego().acceleration_mps2);
    gate_.reset(inputs_.ego().steering_rad);
  }
  mode_ = row->to;
}

void EcuCore::give_snapshot() {
  if (!planning_idle_ || !inputs_.ego_known()) return;
  Snapshot* snapshot = snapshots_.claim();
  if (snapshot == nullptr) return;
  planner::PlannerInput& input = snapshot->input;
  input.now_ms = inputs_.now_ms();
  input.start_ms = boundary_ms_ + kPeriodMs;
  input.ego = inputs_.ego();
  input.tracks = inputs_.tracks();
  input.tracks_ms = inputs_.tracks_ms();
  input.degraded = mode_ == Mode::kDegraded ? 1 : 0;
  input.map = nullptr;
  if (const wire::Map* map = inputs_.map(); map != nullptr) {
    if (snapshot->map_revision != inputs_.map_revision()) {
      convert(*map, snapshot->map);
      snapshot->map_revision = inputs_.map_revision();
    }
    input.map = &snapshot->map;
  }
  // Only a plan that is being driven is carried on; else the next one starts from the measured state.
  input.running = nullptr;
  if (following() && plan_.kind != PlanKind::kNone) {
    snapshot->running = plan_;
    input.running = &snapshot->running;
  }
  snapshot->parameters = parameters_;
  snapshot->parameters_crc = parameters_crc_;
  snapshots_.publish();
}

const Snapshot& EcuCore::begin_cycle(CycleResult*& result) {
  const Snapshot& snapshot = *snapshots_.front();
  result = &results_.back();
  result->computed_ms = snapshot.input.now_ms;
  result->start_ms = snapshot.input.start_ms;
  result->status = Status::kNotInitialized;
  result->plan = Plan{};
  result->explanation = planner::Explanation{};
  result->cycles = ports_.cycles->now();
  return snapshot;
}

void EcuCore::end_cycle() {
  CycleResult& result = results_.back();
  result.plan.start_ms = result.start_ms;
  result.cycles = ports_.cycles->now() - result.cycles;
  results_.publish();
  snapshots_.pop();
}

gate::Command EcuCore::ask() {
  const EgoState& ego = inputs_.ego();
  switch (mode_) {
    case Mode::kDriving:
    case Mode::kDegraded:
      return tracker_.follow(plan_, inputs_.now_ms(), ego, parameters_);
    case Mode::kMinimumRisk:
      if (drives_fail_safe()) return tracker_.drive_fail_safe(plan_, inputs_.now_ms(), ego, parameters_);
      return tracker_.stop(plan_, ego, parameters_);
    case Mode::kStopped:
      return tracker_.stop(plan_, ego, parameters_);
    default:
      tracker_.reset(ego.acceleration_mps2);
      return {0.0F, ego.steering_rad};
  }
}

void EcuCore::report(const gate::Command& command) {
  hal::Can& can = *ports_.can;
  if (ticks_ % kStatusTicks == kStatusPhase) {
    StatusReport status;
    status.mode = mode_;
    status.faults = faults_;
    status.planner = planner_status_;
    status.plan_kind = plan_.kind;
    status.plan_age_ms = plan_age_.ms();
    status.deadline_misses = statistics_.slips;
    status.rejected_frames = inputs_.rejected_frames();
    reporter_.status(can, status);
  }
  if (ticks_ % kSlowTicks == kStatisticsPhase) reporter_.statistics(can, statistics_);
  if (ticks_ % kSlowTicks == kVersionPhase) reporter_.version(can, weights_);
  // Last, as the tick's is: whoever sees it has seen all of this tick's frames.
  reporter_.command(can, command, mode_, inputs_.tick_number(), inputs_.accepted_frames());
}

void EcuCore::publish(RecordKind kind, const void* record, std::uint32_t size) const {
  if (ports_.telemetry == nullptr) return;
  static_cast<void>(ports_.telemetry->publish(static_cast<std::uint16_t>(kind), record, size));
}

}  // namespace s4tp::ecu
