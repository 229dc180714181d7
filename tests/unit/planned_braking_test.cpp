// What a plan says of braking and its release is what the virtual vehicle does.

#include <gtest/gtest.h>

#include <vector>

#include "algo/trajectory/candidates.hpp"
#include "firmware/ecu/gate_limits.hpp"
#include "firmware/ecu/tracker.hpp"
#include "firmware/wire/codec.hpp"
#include "sim_host/world/nodes/append_frame.hpp"
#include "sim_host/world/nodes/vehicle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

constexpr float kSpeedMps = 8.0F;

/// A cycle after the other on a straight lane: candidate, tracker, gate and vehicle, as in the ECU.
class Drive {
 public:
  Drive() {
    test::add_ego_path(scene_, map_, test::path_of(map_, {0}));
    trajectory::build_reference(map_, scene_.ego_paths[0].path, 0.0F, kSpeedMps, parameters_, line_);
    vehicle_.place({50.0, 0.0}, 0.0, static_cast<double>(kSpeedMps));
    running_.kind = PlanKind::kDrive;
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      running_.trajectory.points[i].rear_axle = {
          ego().rear_axle.x_m + kSpeedMps * kStepS * static_cast<float>(i), 0.0F, 0.0F};
      running_.trajectory.points[i].speed_mps = kSpeedMps;
    }
  }

  /// Plans that acceleration for the next boundary and drives there. \return how much faster than planned it is
  float cycle(float acceleration_mps2) {
    trajectory::Candidate candidate;
    candidate.acceleration_mps2 = acceleration_mps2;
    const std::uint32_t start_ms = now_ms_ + kStepMs;
    const TrajectoryPoint start = trajectory::plan_start(ego(), now_ms_, running_, start_ms, parameters_);
    candidate.start_s_m = start.rear_axle.x_m;
    Plan next;
    next.kind = PlanKind::kDrive;
    next.start_ms = start_ms;
    trajectory::roll_out(line_, candidate, start, running_, start_ms, parameters_, next.trajectory);
    for (; now_ms_ < start_ms; now_ms_ += 10) {
      gate_.observe(motion_frame());
      gate::Command command = tracker_.follow(running_, now_ms_, ego(), parameters_);
      (void)gate_.apply(true, command);
      for (int i = 0; i < 10; ++i)
        vehicle_.step(static_cast<double>(command.acceleration_mps2),
                      static_cast<double>(command.steering_rad));
    }
    const float faster_mps = ego().speed_mps - sample(running_, now_ms_).speed_mps;
    running_ = next;
    return faster_mps;
  }

 private:
  [[nodiscard]] EgoState ego() const {
    EgoState ego;
    ego.rear_axle = {static_cast<float>(vehicle_.rear_axle().x), static_cast<float>(vehicle_.rear_axle().y),
                     static_cast<float>(vehicle_.heading_rad())};
    ego.speed_mps = static_cast<float>(vehicle_.speed_mps());
    ego.acceleration_mps2 = static_cast<float>(vehicle_.acceleration_mps2());
    return ego;
  }
  wire::Frame motion_frame() {
    wire::Motion motion;
    motion.speed_mps = ego().speed_mps;
    motion.acceleration_mps2 = ego().acceleration_mps2;
    std::vector<wire::Frame> frames;
    nodes::append(motion, sender_, frames);
    return frames[0];
  }

  Parameters parameters_;
  LaneMap map_ = test::straight_road(1, 300.0F);
  scene::Scene scene_;
  trajectory::ReferenceLine line_;
  nodes::Vehicle vehicle_;
  ecu::Tracker tracker_;
  gate::CommandGate gate_{ecu::gate_limits(Parameters{})};
  wire::E2eSender sender_;
  Plan running_;
  std::uint32_t now_ms_ = 0;
};

// ECU-050: after one to four cycles of braking, gentle or hard, and then away again, the vehicle is at no boundary over
// 0.7 m/s slower than its plans say, nor over 0.4 m/s faster. (It was 1.6 m/s slower after a single cycle.)
TEST(PlannedBraking, IsWhatTheVehicleDoes) {
  for (const float braking_mps2 : {-1.0F, -3.0F, -6.0F}) {
    for (int cycles = 1; cycles <= 4; ++cycles) {
      Drive drive;
      for (int i = 0; i < 20; ++i) {
        const float faster_mps = drive.cycle(i < cycles ? braking_mps2 : 2.0F);
        EXPECT_GE(faster_mps, -0.7F) << braking_mps2 << " for " << cycles << ", cycle " << i;
        EXPECT_LE(faster_mps, 0.4F) << braking_mps2 << " for " << cycles << ", cycle " << i;
      }
    }
  }
}

}  // namespace
}  // namespace s4tp
