#pragma once
/// A world made of nothing but frames, around an Ecu with a planner a test can script, or any other.

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/ecu/ecu.hpp"
#include "firmware/wire/version.hpp"
#include "hal/sim/bus.hpp"
#include "hal/sim/null_devices.hpp"

namespace s4tp::ecu {

/// Drives what a test tells it to; by default straight on at the present speed.
struct FakePlanner {
  Status init_answer = Status::kOk;
  Status plan_answer = Status::kOk;
  std::function<void(const planner::PlannerInput&, Plan&)> make;
  int inits = 0;
  int cycles = 0;
  planner::PlannerInput seen;
  bool had_map = false;
  bool had_running = false;

  Status init(const Parameters&) {
    ++inits;
    return init_answer;
  }
  Status plan(const planner::PlannerInput& input, Plan& plan, planner::Explanation& explanation) {
    ++cycles;
    seen = input;
    had_map = input.map != nullptr;
    had_running = input.running != nullptr;
    explanation.status = plan_answer;
    if (plan_answer != Status::kOk && plan_answer != Status::kNoSafePlan) return plan_answer;
    plan.kind = PlanKind::kDrive;
    plan.start_ms = input.start_ms;
    if (make) {
      make(input, plan);
    } else {
      const float lead_s = static_cast<float>(input.start_ms - input.now_ms) / 1000.0F;
      for (int i = 0; i < kTrajectoryPoints; ++i) {
        TrajectoryPoint& point = plan.trajectory.points[i];
        const float way_m = input.ego.speed_mps * (lead_s + static_cast<float>(i) * kStepS);
        point.rear_axle = shift_ahead(input.ego.rear_axle, way_m);
        point.speed_mps = input.ego.speed_mps;
      }
    }
    return plan_answer;
  }
};

/// Rear-axle bicycle behind first-order actuators, 1 ms steps.
struct Plant {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double speed_mps = 0.0;
  double drive_mps2 = 0.0;
  double steering_rad = 0.0;
  double drive_lag_s = 0.15;
  double steering_lag_s = 0.08;
  double drag_mps2 = 0.0;            ///< a slope the controller does not know of
  double steering_offset_rad = 0.0;  ///< nor of this
  double rear_slip = 0.0;            ///< rad per m/s^2 of lateral acceleration
  double acceleration_mps2 = 0.0;
  double yaw_rate_radps = 0.0;

  void step(const gate::Command& command) {
    for (int i = 0; i < 10; ++i) {
      drive_mps2 += 0.001 * (command.acceleration_mps2 - drive_mps2) / drive_lag_s;
      steering_rad += 0.001 * (command.steering_rad - steering_rad) / steering_lag_s;
      const double net_mps2 = drive_mps2 - (speed_mps > 0.0 ? drag_mps2 : 0.0);
      const double before_mps = speed_mps;
      speed_mps = std::max(0.0, speed_mps + 0.001 * net_mps2);
      acceleration_mps2 = (speed_mps - before_mps) / 0.001;
      yaw_rate_radps = speed_mps * std::tan(steering_rad + steering_offset_rad) / 2.9;
      heading_rad = std::remainder(heading_rad + 0.001 * yaw_rate_radps, 6.283185307179586);
      const double course_rad = heading_rad - rear_slip * speed_mps * yaw_rate_radps;
      x_m += 0.001 * speed_mps * std::cos(course_rad);
      y_m += 0.001 * speed_mps * std::sin(course_rad);
    }
  }
};

/// One straight lane of 300 m in slot 5.
inline wire::Map straight_map() {
  wire::Map map;
  wire::Lane& lane = map.lanes[5];
  lane.present = true;
  lane.on_route = true;
  lane.point_count = 4;
  lane.speed_limit_mps = 13.75F;
  lane.width_m = 3.2F;
  lane.route_remaining_m = 300.0F;
  lane.goal_distance_m = 300.0F;
  for (int i = 0; i < 4; ++i) lane.x_m[i] = 100.0F * static_cast<float>(i) - 20.0F;
  return map;
}

struct Records final : hal::Telemetry {
  std::vector<PlanRecord> plans;
  std::vector<ControlRecord> controls;
  std::vector<ModeRecord> modes;

  bool publish(std::uint16_t kind, const void* record, std::uint32_t) override {
    switch (static_cast<RecordKind>(kind)) {
      case RecordKind::kPlan:
        plans.push_back(*static_cast<const PlanRecord*>(record));
        break;
      case RecordKind::kControl:
        controls.push_back(*static_cast<const ControlRecord*>(record));
        break;
      case RecordKind::kModeChange:
        modes.push_back(*static_cast<const ModeRecord*>(record));
        break;
    }
    return true;
  }
};

template <class PlannerT>
class BasicRig {
 public:
  BasicRig() { map_sender.update(straight_map()); }

  Status start(const Parameters& parameters = {}, const hal::FlashBank* weights = nullptr) {
    return ecu.init(parameters, {ecu_port, &cycles, &watchdog, &records, weights});
  }

  /// One tick: the world's frames, TICK last, the control tick, a planning cycle if due.
  void tick() {
    ++number;
    stamp_ms = static_cast<std::uint16_t>(stamp_ms + interval_ms);
    publish();
    const bool was_driving = may_command(ecu.mode());
    ecu.control_tick();
    if (run_planner && ecu.planning_due()) ecu.planning_cycle();
    collect();
    if (was_driving || may_command(ecu.mode())) {
      plant.step(last_command());
    } else {
      plant.step({0.0F, 0.0F});
    }
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  void seconds(double duration_s) { ticks(static_cast<int>(duration_s * 100.0 + 0.5)); }

  /// Until the mode is `wanted`; \return ticks it took, -1 after `limit`
  int until(Mode wanted, int limit = 600) {
    for (int i = 0; i < limit; ++i) {
      if (ecu.mode() == wanted) return i;
      tick();
    }
    return -1;
  }

  /// Ready, engaged, driving.
  bool drive() {
    engage = false;
    if (until(Mode::kReady) < 0) return false;
    engage = true;
    return until(Mode::kDriving, 5) >= 0;
  }

  [[nodiscard]] bool fault(FaultBit wanted) const { return (ecu.faults() & bit(wanted)) != 0; }
  [[nodiscard]] gate::Command last_command() const {
    return {command.acceleration_mps2, command.steering_rad};
  }

  void send(wire::Frame frame) { (void)world->send(to_hal(frame)); }

  hal::sim::Bus bus;
  hal::sim::Bus::Port* world = bus.attach();
  hal::sim::Bus::Port* ecu_port = bus.attach();
  hal::sim::NullCycleCounter cycles;
  hal::sim::NullWatchdog watchdog;
  Records records;
  Ecu<PlannerT> ecu;
  Plant plant;

  bool motion = true;
  bool steering = true;
  bool pose = true;
  bool tracks = true;
  bool map = true;
  bool version = true;
  bool run_planner = true;
  bool engage = false;
  bool driver_override = false;
  std::optional<float> steering_told_rad;  ///< a lie, sealed as the truth is
  std::uint32_t layout_hash = wire::layout_hash();
  std::uint16_t interval_ms = 10;
  std::uint16_t stamp_ms = 0;
  int number = 0;
  wire::Tracks track_list;

  std::vector<wire::Frame> from_ecu;  ///< of the last tick
  wire::Command command;
  std::optional<wire::EcuStatus> status;
  int digests = 0;
  std::uint32_t digest = 0;
  wire::MapSender map_sender;

 private:
  template <class Message>
  void put(const Message& message, wire::E2eSender& sender) {
    wire::Frame frame;
    if (!wire::encode(message, frame)) return;
    sender.protect(frame);
    send(frame);
  }

  void publish() {
    if (motion) {
      wire::Motion message;
      message.vehicle_time_ms = stamp_ms;
      message.speed_mps = static_cast<float>(plant.speed_mps);
      message.acceleration_mps2 = static_cast<float>(plant.acceleration_mps2);
      message.yaw_rate_radps = static_cast<float>(plant.yaw_rate_radps);
      put(message, motion_sender_);
    }
    if (steering) {
      wire::Steering message;
      message.steering_rad = steering_told_rad.value_or(static_cast<float>(plant.steering_rad));
      message.engage = engage ? 1 : 0;
      message.driver_override = driver_override ? 1 : 0;
      put(message, steering_sender_);
    }
    if (pose && number % 2 == 0) {
      wire::Pose message;
      message.x_m = static_cast<float>(plant.x_m);
      message.y_m = static_cast<float>(plant.y_m);
      message.heading_rad = static_cast<float>(std::clamp(plant.heading_rad, -3.1412, 3.1412));
      put(message, pose_sender_);
    }
    if (tracks && number % 10 == 4) {
      track_list.vehicle_time_ms = stamp_ms;
      track_sender_.start(track_list);
      wire::Frame frame;
      while (track_sender_.next(frame)) send(frame);
    }
    if (map) {
      wire::Frame frame;
      for (int i = 0; i < 10 && map_sender.next(static_cast<std::uint32_t>(number) * 10U, frame); ++i)
        send(frame);
    }
    if (version && number % 100 == 7) {
      wire::VersionWorld message;
      message.wire_version = wire::wire_version();
      message.layout_hash = layout_hash;
      put(message, version_sender_);
    }
    wire::Tick message;
    message.tick = static_cast<std::uint16_t>(number);
    put(message, tick_sender_);
  }

  void collect() {
    from_ecu.clear();
    hal::CanFrame can;
    while (world->receive(can)) {
      const wire::Frame frame = to_wire(can);
      from_ecu.push_back(frame);
      (void)wire::decode(frame, command);
      wire::EcuStatus message;
      if (wire::decode(frame, message)) status = message;
      wire::PlanDigest plan;
      if (wire::decode(frame, plan)) {
        ++digests;
        digest = plan.digest;
      }
    }
  }

  wire::E2eSender motion_sender_;
  wire::E2eSender steering_sender_;
  wire::E2eSender pose_sender_;
  wire::E2eSender version_sender_;
  wire::E2eSender tick_sender_;
  wire::TrackListSender track_sender_;
};

using Rig = BasicRig<FakePlanner>;

inline bool took(const Rig& rig, TransitionId id) {
  for (const ModeRecord& record : rig.records.modes) {
    if (record.reason == id) return true;
  }
  return false;
}

}  // namespace s4tp::ecu
