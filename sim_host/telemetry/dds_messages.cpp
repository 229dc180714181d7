#include "sim_host/telemetry/dds_messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim_host/telemetry/dds_header.hpp"

namespace s4tp::telemetry {
namespace {

using DdsPose = geometry_msgs_msg_dds__Pose_;
using Object = autoware_perception_msgs_msg_dds__TrackedObject_;
using Shape = autoware_perception_msgs_msg_dds__Shape_;
using Classification = autoware_perception_msgs_msg_dds__ObjectClassification_;

constexpr const char* kOdom = "odom";
constexpr const char* kBase = "base_link";
constexpr double kVehicleHeightM = 1.5;
constexpr std::uint8_t kOrientationAvailable = 2;
constexpr float kRestMps = 0.1F;

DdsPose pose(const Pose& at, double z_m = 0.0) {
  DdsPose result{};
  result.position = {at.x_m, at.y_m, z_m};
  result.orientation.z = std::sin(0.5 * static_cast<double>(at.heading_rad));
  result.orientation.w = std::cos(0.5 * static_cast<double>(at.heading_rad));
  return result;
}

/// By size: the planner knows nothing else. CAR 1, TRUCK 2, MOTORCYCLE 5.
std::uint8_t label_of(const Track& track) {
  if (track.length_m >= 9.0F) return 2;
  return track.width_m < 1.2F ? 5 : 1;
}

template <class Sequence>
void classify(const Track& track, Sequence& sequence, Arena& arena) {
  Classification* const one = arena.sequence(sequence, 1);
  one->label = label_of(track);
  one->probability = 1.0F;
}

Shape shape(const Track& track) {
  Shape result{};
  result.dimensions = {track.length_m, track.width_m, kVehicleHeightM};
  return result;
}

geometry_msgs_msg_dds__Point_ point(const Pose& at) {
  return {at.x_m, at.y_m, 0.0};
}

std_msgs_msg_dds__ColorRGBA_ grey(float alpha) {
  return {0.5F, 0.5F, 0.5F, alpha};
}

visualization_msgs_msg_dds__Marker_ marker(const Header& stamp, const char* group, int id, int type,
                                           double width_m, Arena& arena) {
  visualization_msgs_msg_dds__Marker_ result{};
  result.header = stamp;
  result.ns = arena.text(group);
  result.id = id;
  result.type = type;
  result.pose.orientation.w = 1.0;
  result.scale = {width_m, width_m, width_m};
  char* const empty = arena.text("");
  result.texture_resource = result.text = result.mesh_resource = empty;
  result.texture.header.frame_id = result.texture.format = result.mesh_file.filename = empty;
  return result;
}

constexpr int kLineStrip = 4;
constexpr int kTextFacing = 9;
constexpr int kDeleteAll = 3;

/// The first marker of an array: what was shown before goes.
visualization_msgs_msg_dds__Marker_ clear_all(const Header& stamp, Arena& arena) {
  auto result = marker(stamp, "", 0, 0, 1.0, arena);
  result.action = kDeleteAll;
  return result;
}

}  // namespace

char* Arena::text(const std::string& text) {
  char* const copy = take<char>(text.size() + 1);
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

TrackedObjects tracked_objects(const CycleRecord& cycle, Arena& arena) {
  TrackedObjects result{};
  result.header = header(cycle.scene.time_ms, kOdom, arena);
  auto* object = arena.sequence(result.objects, static_cast<std::size_t>(cycle.scene.agents.size()));
  for (const scene::Agent& agent : cycle.scene.agents) {
    const Track& track = agent.track;
    object->object_id.uuid[15] = track.id;
    object->existence_probability = 1.0F;
    classify(track, object->classification, arena);
    auto& kinematics = object->kinematics;
    kinematics.pose_with_covariance.pose = pose(track.centre, 0.5 * kVehicleHeightM);
    kinematics.twist_with_covariance.twist.linear.x = track.speed_mps;
    kinematics.twist_with_covariance.twist.angular.z = track.yaw_rate_radps;
    kinematics.acceleration_with_covariance.accel.linear.x = track.acceleration_mps2;
    kinematics.orientation_availability = kOrientationAvailable;
    kinematics.is_stationary = track.speed_mps < kRestMps;
    object->shape = shape(track);
    ++object;
  }
  return result;
}

PredictedObjects predicted_objects(const ecu::PlanRecord& plan, const CycleRecord& cycle, Arena& arena) {
  PredictedObjects result{};
  result.header = header(plan.plan.start_ms, kOdom, arena);
  auto* object = arena.sequence(result.objects, static_cast<std::size_t>(cycle.prediction.agents.size()));
  for (const satp::AgentPrediction& agent : cycle.prediction.agents) {
    const Track& track = cycle.scene.agents[agent.agent].track;
    object->object_id.uuid[15] = track.id;
    object->existence_probability = 1.0F;
    classify(track, object->classification, arena);
    auto& kinematics = object->kinematics;
    kinematics.initial_pose_with_covariance.pose = pose(track.centre, 0.5 * kVehicleHeightM);
    kinematics.initial_twist_with_covariance.twist.linear.x = track.speed_mps;
    kinematics.initial_twist_with_covariance.twist.angular.z = track.yaw_rate_radps;
    kinematics.initial_acceleration_with_covariance.accel.linear.x = track.acceleration_mps2;
    auto* future = arena.sequence(kinematics.predicted_paths, static_cast<std::size_t>(agent.modes.size()));
    for (const satp::Mode& mode : agent.modes) {
      auto* step = arena.sequence(future->path, kHorizonSteps);
      for (const Pose& at : mode.steps) *step++ = pose(at, 0.5 * kVehicleHeightM);
      future->time_step.nanosec = static_cast<std::uint32_t>(kStepMs) * 1'000'000U;
      future->confidence = mode.probability;
      ++future;
    }
    object->shape = shape(track);
    ++object;
  }
  return result;
}

TrajectoryMessage trajectory(const Plan& plan, float wheelbase_m, Arena& arena) {
  TrajectoryMessage result{};
  result.header = header(plan.start_ms, kOdom, arena);
  const std::size_t count = plan.kind == PlanKind::kNone ? 0 : kTrajectoryPoints;
  auto* to = arena.sequence(result.points, count);
  for (std::size_t i = 0; i < count; ++i, ++to) {
    const TrajectoryPoint& from = plan.trajectory.points[i];
    const auto after_ms = static_cast<std::uint32_t>(i) * static_cast<std::uint32_t>(kStepMs);
    to->time_from_start.sec = static_cast<std::int32_t>(after_ms / 1000U);
    to->time_from_start.nanosec = after_ms % 1000U * 1'000'000U;
    to->pose = pose(from.rear_axle);
    to->longitudinal_velocity_mps = from.speed_mps;
    to->acceleration_mps2 = from.acceleration_mps2;
    to->heading_rate_rps = from.speed_mps * from.curvature_1pm;
    to->front_wheel_angle_rad = std::atan(wheelbase_m * from.curvature_1pm);
  }
  return result;
}

MarkerArray candidate_markers(const ecu::PlanRecord& plan, const std::vector<RolledOut>& candidates,
                              Arena& arena) {
  const Header stamp = header(plan.plan.start_ms, kOdom, arena);
  const auto [least, most] = cost_range(candidates);
  MarkerArray result{};
  auto* to = arena.sequence(result.markers, 1 + 2 * candidates.size());
  *to++ = clear_all(stamp, arena);
  result.markers._length = 1;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const RolledOut& one = candidates[i];
    *to = marker(stamp, "candidates", static_cast<int>(i), kLineStrip, one.chosen ? 0.4 : 0.15, arena);
    const float part = most > least ? (one.cost.total() - least) / (most - least) : 0.0F;
    to->color = one.costed ? std_msgs_msg_dds__ColorRGBA_{part, 1.0F - part, 0.1F, 0.9F} : grey(0.5F);
    auto* vertex = arena.sequence(to->points, kTrajectoryPoints);
    for (const TrajectoryPoint& from : one.trajectory.points) *vertex++ = point(from.rear_axle);
    ++to;
    ++result.markers._length;
    if (!one.costed) continue;
    *to = marker(stamp, "costs", static_cast<int>(i), kTextFacing, 0.8, arena);
    to->color = {1.0F, 1.0F, 1.0F, 1.0F};
    to->pose = pose(one.trajectory.points[kHorizonSteps].rear_axle);
    char cost[32];
    std::snprintf(cost, sizeof cost, "%.1f", static_cast<double>(one.cost.total()));
    to->text = arena.text(cost);
    ++to;
    ++result.markers._length;
  }
  return result;
}

ControlMessage control(const ecu::ControlRecord& record) {
  ControlMessage result{};
  set_time(result.stamp, record.time_ms);
  result.control_time = result.lateral.stamp = result.lateral.control_time = result.stamp;
  result.longitudinal.stamp = result.longitudinal.control_time = result.stamp;
  result.lateral.steering_tire_angle = record.sent.steering_rad;
  result.longitudinal.acceleration = record.sent.acceleration_mps2;
  result.longitudinal.is_defined_acceleration = true;
  return result;
}

OccupancyGrid risk_grid(const sadrf::HeatMap& map, const CycleRecord& cycle, Arena& arena) {
  OccupancyGrid result{};
  result.header = header(cycle.scene.time_ms, kBase, arena);
  result.info.map_load_time = result.header.stamp;
  result.info.resolution = 1.0F;
  result.info.width = sadrf::kHeatColumns;
  result.info.height = sadrf::kHeatRows;
  result.info.origin.position = {-static_cast<double>(sadrf::kHeatBehind), -0.5 * sadrf::kHeatRows, 0.0};
  result.info.origin.orientation.w = 1.0;
  auto* to = arena.sequence(result.data, static_cast<std::size_t>(sadrf::kHeatRows) * sadrf::kHeatColumns);
  for (const auto& row : map.cells) {
    for (const std::uint8_t level : row) {
      int value = level * 99 / sadrf::kHeatHighest;
      if (level == sadrf::kHeatOffRoad) value = -1;
      if (level == sadrf::kHeatOpposite) value = 0;
      if (level == sadrf::kHeatVehicle) value = 100;
      *to++ = static_cast<std::int8_t>(value);
    }
  }
  return result;
}

PathMessage path(const Plan& plan, Arena& arena) {
  PathMessage result{};
  result.header = header(plan.start_ms, kOdom, arena);
  auto* to = arena.sequence(result.poses, plan.kind == PlanKind::kNone ? 0 : kTrajectoryPoints);
  for (std::uint32_t i = 0; i < result.poses._length; ++i, ++to) {
    to->header = header(plan.start_ms + i * static_cast<std::uint32_t>(kStepMs), kOdom, arena);
    to->pose = pose(plan.trajectory.points[i].rear_axle);
  }
  return result;
}

MarkerArray lane_markers(const CycleRecord& cycle, Arena& arena) {
  static constexpr const char* kKinds[] = {"ours", "opposite", "shoulder"};
  const Header stamp = header(cycle.scene.time_ms, kOdom, arena);
  MarkerArray result{};
  auto* to = arena.sequence(result.markers, 1 + kMaxLanes);
  *to++ = clear_all(stamp, arena);
  result.markers._length = 1;
  for (int i = 0; cycle.has_map && i < kMaxLanes; ++i) {
    const Lane& lane = cycle.map.lanes[i];
    if (!lane.present) continue;
    *to = marker(stamp, kKinds[static_cast<int>(lane.kind)], i, kLineStrip, 0.12, arena);
    to->color = lane.on_route ? std_msgs_msg_dds__ColorRGBA_{0.2F, 0.6F, 1.0F, 1.0F} : grey(0.8F);
    auto* vertex = arena.sequence(to->points, lane.point_count);
    for (int k = 0; k < lane.point_count; ++k) *vertex++ = {lane.points[k].x_m, lane.points[k].y_m, 0.0};
    ++to;
    ++result.markers._length;
  }
  return result;
}

TransformMessage transform(const CycleRecord& cycle, Arena& arena) {
  TransformMessage result{};
  auto* one = arena.sequence(result.transforms, 1);
  one->header = header(cycle.scene.time_ms, kOdom, arena);
  one->child_frame_id = arena.text(kBase);
  const DdsPose at = pose(cycle.scene.ego.rear_axle);
  one->transform.translation = {at.position.x, at.position.y, 0.0};
  one->transform.rotation = at.orientation;
  return result;
}

}  // namespace s4tp::telemetry
