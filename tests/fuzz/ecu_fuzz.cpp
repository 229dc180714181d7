// The ECU behind its bus: a world whose senders say what the fuzzer wants, all of it protected as theirs is, and other frames
// among it. Every command that leaves is inside the gate's limits; modes change by their table; nobody falls silent.

#include <cstdio>
#include <memory>
#include <string>

#include "algo/core/math.hpp"
#include "tests/fuzz/frames.hpp"
#include "tests/support/command_check.hpp"
#include "tests/support/ecu_rig.hpp"

using namespace s4tp;
using ecu::CommandCheck;
using ecu::Rig;
using fuzz::expect;
using fuzz::Input;

namespace {

/// A plan as a planner may give it: in range, and no better than that.
void any_plan(Input& input, const planner::PlannerInput& world, Plan& plan) {
  const float speed_mps = input.real(0.0F, 60.0F);
  const float curvature_1pm = input.real(-2.0F, 2.0F);
  const float acceleration_mps2 = input.real(-13.0F, 13.0F);
  const float left_m = input.real(-20.0F, 20.0F);
  Pose pose = shift_ahead(world.ego.rear_axle, input.real(-20.0F, 20.0F));
  pose.y_m += left_m;
  for (TrajectoryPoint& point : plan.trajectory.points) {
    point = {pose, speed_mps, acceleration_mps2, curvature_1pm};
    pose = shift_ahead(pose, speed_mps * kStepS);
    pose.heading_rad = wrap_angle(pose.heading_rad + curvature_1pm * speed_mps * kStepS);
  }
  plan.fail_safe.branch_s = input.real(0.0F, 3.0F);
  plan.fail_safe.braking_mps2 = input.real(0.0F, 13.0F);
  if (input.below(4) == 1) plan.kind = PlanKind::kMinimumRisk;
}

void change_map(Input& input, wire::MapSender& sender) {
  wire::Map map = ecu::straight_map();
  for (int lanes = input.below(4); lanes > 0; --lanes) {
    wire::Lane& lane = map.lanes[input.below(wire::kMaxLanes)];
    lane = map.lanes[5];
    lane.point_count = static_cast<std::uint8_t>(input.below(wire::kMaxLanePoints + 1));
    lane.width_m = input.real(0.0F, 6.3F);
    lane.speed_limit_mps = input.real(0.0F, 63.0F);
    lane.left = static_cast<std::uint8_t>(input.below(wire::kMaxLanes));
    for (int i = 0; i < lane.point_count; ++i) lane.x_m[i] = input.real(-2000.0F, 2000.0F);
  }
  wire::Conflict& conflict = map.conflicts[input.below(wire::kMaxConflicts)];
  conflict.present = input.below(2) != 0;
  conflict.first = 5;
  conflict.second = static_cast<std::uint8_t>(input.below(wire::kMaxLanes));
  conflict.first_exit_m = input.real(0.0F, 1600.0F);
  sender.update(map);
}

/// What one of the world's senders says or leaves out from now on.
void change_world(Input& input, Rig& rig) {
  switch (input.below(14)) {
    case 0:
      rig.plant.speed_mps = input.real(0.0F, 81.0F);
      break;
    case 1:
      rig.plant.steering_rad = input.real(-3.2F, 3.2F);
      break;
    case 2:
      rig.plant.x_m = input.real(-1310.0F, 1310.0F);
      rig.plant.y_m = input.real(-1310.0F, 1310.0F);
      break;
    case 3:
      rig.plant.heading_rad = input.real(-3.14F, 3.14F);
      break;
    case 4:
      rig.plant.drag_mps2 = input.real(-10.0F, 10.0F);
      break;
    case 5:
      rig.plant.steering_offset_rad = input.real(-0.5F, 0.5F);
      break;
    case 6:
      rig.interval_ms = input.below(2) == 0 ? std::uint16_t{10} : input.take<std::uint16_t>();
      break;
    case 7:
      rig.engage = !rig.engage;
      break;
    case 8:
      rig.driver_override = !rig.driver_override;
      break;
    case 9: {
      const int silent = input.byte();
      rig.motion = (silent & 1) == 0;
      rig.steering = (silent & 2) == 0;
      rig.pose = (silent & 4) == 0;
      rig.tracks = (silent & 8) == 0;
      rig.map = (silent & 16) == 0;
      rig.version = (silent & 32) == 0;
      break;
    }
    case 10:
      rig.layout_hash ^= input.byte();
      break;
    case 11:
      take_tracks(input, rig.track_list);
      break;
    case 12:
      change_map(input, rig.map_sender);
      break;
    default:
      rig.ecu.inject_deadline_miss();
  }
}

/// Of a message that only the ECU sends, or by which commands are judged, there is none but the true one.
bool may_be_added(const wire::Frame& frame) {
  return frame.id != wire::kCommandId && frame.id != wire::kTickId && frame.id != wire::kMotionId &&
         frame.id != wire::kSteeringId;
}

/// A listener's end of the bus, and what is made of it.
class Watch {
 public:
  explicit Watch(hal::sim::Bus& bus) : port_(bus.attach()) {}

  void tick() {
    int commands = 0;
    for (hal::CanFrame can; port_->receive(can);) {
      const wire::Frame frame = to_wire(can);
      commands += frame.id == wire::kCommandId ? 1 : 0;
      check_.take(frame);
    }
    expect(commands == 1, "a command a tick");
  }
  void end() {
    check_.end();
    for (const std::string& finding : check_.findings()) std::fprintf(stderr, "fuzz: %s\n", finding.c_str());
    expect(check_.findings().empty(), "commands are inside the limits, modes change by their table");
  }

 private:
  hal::sim::Bus::Port* port_;
  CommandCheck check_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const auto rig = std::make_unique<Rig>();
  Watch watch(rig->bus);
  expect(rig->start() == Status::kOk, "the ECU starts");
  rig->plant.speed_mps = input.real(0.0F, 20.0F);
  int calm = input.below(256) - 64;  // ticks without surprises; most inputs let the ECU get ready
  fuzz::Counters counters;
  for (int tick = 0; tick < 500; ++tick) {
    if (rig->ecu.mode() == ecu::Mode::kReady && !rig->ecu.planner().make) {
      rig->ecu.planner().make = [&](const planner::PlannerInput& world, Plan& plan) {
        any_plan(input, world, plan);
      };
      rig->plant.steering_rad = input.real(-0.5F, 0.5F);
      rig->engage = true;
      calm = input.below(16);
    }
    if (calm > 0) {
      --calm;
    } else if (input.empty()) {
      break;
    } else {
      for (int changes = input.below(3); changes > 0; --changes) change_world(input, *rig);
      for (int added = input.below(8) - 4; added > 0; --added) {
        const wire::Frame frame = fuzz::take_frame(input, counters);
        if (may_be_added(frame)) rig->send(frame);
      }
      if (input.below(16) == 15) calm = input.below(64);
    }
    rig->tick();
    watch.tick();
    rig->records = {};
  }
  watch.end();
  return 0;
}
