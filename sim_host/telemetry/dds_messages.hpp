#pragma once
/// Records as ROS 2 and Autoware messages. Frame "odom" is the ECU's odometry frame, "base_link" our rear
/// axle; stamps are vehicle time. What the planner does not know (height, covariance) is zero; a vehicle is
/// 1.5 m high.

#include <autoware_msgs.h>
#include <nav_msgs.h>
#include <visualization_msgs.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim_host/telemetry/derive.hpp"
#include "sim_host/telemetry/input_report.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::telemetry {

/// What a message points to, for as long as it is needed.
class Arena {
 public:
  /// `count` values, all bits zero.
  template <class Value>
  Value* take(std::size_t count) {
    // Bytes: of a struct of the same size new zeroes the members and not the padding.
    blocks_.push_back(std::make_unique<std::byte[]>(count * sizeof(Value) + 1));
    return reinterpret_cast<Value*>(blocks_.back().get());
  }
  char* text(const std::string& text);
  /// Fills in a sequence of `count` zero values. \return the first
  template <class Sequence>
  auto* sequence(Sequence& sequence, std::size_t count) {
    using Value = std::remove_pointer_t<decltype(sequence._buffer)>;
    sequence._length = sequence._maximum = static_cast<std::uint32_t>(count);
    sequence._buffer = take<Value>(count);
    sequence._release = false;
    return sequence._buffer;
  }

 private:
  std::vector<std::unique_ptr<std::byte[]>> blocks_;
};

using TrackedObjects = autoware_perception_msgs_msg_dds__TrackedObjects_;
using PredictedObjects = autoware_perception_msgs_msg_dds__PredictedObjects_;
using TrajectoryMessage = autoware_planning_msgs_msg_dds__Trajectory_;
using ControlMessage = autoware_control_msgs_msg_dds__Control_;
using OccupancyGrid = nav_msgs_msg_dds__OccupancyGrid_;
using PathMessage = nav_msgs_msg_dds__Path_;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;
using TransformMessage = tf2_msgs_msg_dds__TFMessage_;
using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;

/// TELE-020 Every vehicle of the scene; its uuid is 15 zeros and the track id.
[[nodiscard]] TrackedObjects tracked_objects(const CycleRecord& cycle, Arena& arena);
/// TELE-021 The watched ones, a path a mode with its probability, every 0.1 s from plan start + 0.1 s on.
[[nodiscard]] PredictedObjects predicted_objects(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                                 Arena& arena);
/// TELE-022 31 points of the rear axle. \param wheelbase_m  for the steering angle
[[nodiscard]] TrajectoryMessage trajectory(const Plan& plan, float wheelbase_m, Arena& arena);
/// TELE-023 The candidates as lines, green to red by cost, grey where they were rejected; the cost as text.
[[nodiscard]] MarkerArray candidate_markers(const ecu::PlanRecord& plan,
                                            const std::vector<RolledOut>& candidates, Arena& arena);
/// TELE-024 What reached the actuators.
[[nodiscard]] ControlMessage control(const ecu::ControlRecord& record);
/// TELE-025 128 x 64 cells of 1 m around base_link: risk 0 .. 99 of 239 levels, 100 a vehicle, -1 off road.
[[nodiscard]] OccupancyGrid risk_grid(const sadrf::HeatMap& map, const CycleRecord& cycle, Arena& arena);
/// TELE-026 The way of the rear axle.
[[nodiscard]] PathMessage path(const Plan& plan, Arena& arena);
/// TELE-027 Centre lines of all lanes, by kind, and the conflicts between them.
[[nodiscard]] MarkerArray lane_markers(const CycleRecord& cycle, Arena& arena);
/// TELE-028 Mode, faults, cycles and their stages, frames and the bus; level by what they mean.
/// \param input  of the input topics what was taken and what was refused; null: there are none
[[nodiscard]] DiagnosticArray diagnostics(const ecu::ControlRecord& control, const StatusRecord& status,
                                          const CycleRecord* cycle, const InputReport* input, Arena& arena);
/// The same where no ECU is to be seen: what became of its input.
[[nodiscard]] DiagnosticArray diagnostics(const InputReport& input, Arena& arena);
/// TELE-029 odom to base_link.
[[nodiscard]] TransformMessage transform(const CycleRecord& cycle, Arena& arena);

}  // namespace s4tp::telemetry
