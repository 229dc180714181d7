#pragma once
/// A node that tells objects and lane maps over DDS, and the messages of a list and a map of the wire.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim_host/telemetry/dds_input_values.hpp"
#include "sim_host/telemetry/dds_messages.hpp"
#include "sim_host/telemetry/dds_publisher.hpp"
#include "tests/dds/wait_for.hpp"

namespace s4tp::tests {

using telemetry::Arena;
using telemetry::LaneMapMessage;
using telemetry::TrackedObjects;

/// A node that tells objects and maps, on loopback.
class Publisher {
 public:
  Publisher() {
    domain_ = dds_create_domain(free_domain(), telemetry::dds_configuration("").c_str());
    participant_ = dds_create_participant(free_domain(), nullptr, nullptr);
    objects_ =
        writer(autoware_perception_msgs_msg_dds__TrackedObjects__desc, "rt/s4tp/input/tracked_objects");
    maps_ = writer(s4tp_msgs_msg_dds__LaneMap__desc, "rt/s4tp/input/lane_map");
  }
  ~Publisher() {
    dds_delete(participant_);
    dds_delete(domain_);
  }
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  [[nodiscard]] dds_entity_t participant() const { return participant_; }
  [[nodiscard]] bool heard() const { return matched(objects_) && matched(maps_); }
  void tell(const TrackedObjects& objects) { EXPECT_EQ(dds_write(objects_, &objects), DDS_RETCODE_OK); }
  void tell(const LaneMapMessage& map) { EXPECT_EQ(dds_write(maps_, &map), DDS_RETCODE_OK); }

 private:
  dds_entity_t writer(const dds_topic_descriptor_t& type, const char* name) {
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(5));
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    const dds_entity_t topic = dds_create_topic(participant_, &type, name, nullptr, nullptr);
    const dds_entity_t result = dds_create_writer(participant_, topic, qos, nullptr);
    dds_delete_qos(qos);
    EXPECT_GT(result, 0);
    return result;
  }
  static bool matched(dds_entity_t writer) {
    dds_publication_matched_status_t status{};
    return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK && status.current_count > 0;
  }

  dds_entity_t domain_ = 0;
  dds_entity_t participant_ = 0;
  dds_entity_t objects_ = 0;
  dds_entity_t maps_ = 0;
};

inline TrackedObjects message_of(const wire::Tracks& tracks, Arena& arena) {
  TrackedObjects message{};
  message.header.frame_id = arena.text("odom");
  message.header.stamp.sec = tracks.vehicle_time_ms / 1000;
  message.header.stamp.nanosec = static_cast<std::uint32_t>(tracks.vehicle_time_ms % 1000) * 1'000'000U;
  auto* to = arena.sequence(message.objects, tracks.count);
  for (int i = 0; i < tracks.count; ++i, ++to) {
    const wire::Track& from = tracks.items[i];
    to->object_id.uuid[15] = from.id;
    auto& pose = to->kinematics.pose_with_covariance.pose;
    pose.position = {from.x_m, from.y_m, 0.75};
    pose.orientation.z = std::sin(0.5 * static_cast<double>(from.heading_rad));
    pose.orientation.w = std::cos(0.5 * static_cast<double>(from.heading_rad));
    to->kinematics.twist_with_covariance.twist.linear.x = from.speed_mps;
    to->kinematics.twist_with_covariance.twist.angular.z = from.yaw_rate_radps;
    to->kinematics.acceleration_with_covariance.accel.linear.x = from.acceleration_mps2;
    to->shape.dimensions = {from.length_m, from.width_m, 1.5};
  }
  return message;
}

inline LaneMapMessage message_of(const wire::Map& map, Arena& arena) {
  LaneMapMessage message{};
  message.header.frame_id = arena.text("odom");
  message.lanes_left_out = map.lanes_left_out;
  auto* lane = arena.sequence(message.lanes, wire::kMaxLanes);
  message.lanes._length = 0;
  for (int slot = 0; slot < wire::kMaxLanes; ++slot) {
    const wire::Lane& from = map.lanes[slot];
    if (!from.present) continue;
    *lane = s4tp_msgs_msg_dds__Lane_{};
    lane->slot = static_cast<std::uint8_t>(slot);
    lane->kind = from.kind;
    lane->in_junction = from.in_junction;
    lane->on_route = from.on_route;
    lane->changes_needed = from.changes_needed;
    lane->speed_limit_mps = from.speed_limit_mps;
    lane->width_m = from.width_m;
    lane->stop_line_m = from.stop_line_m;
    lane->route_remaining_m = from.route_remaining_m;
    lane->goal_distance_m = from.goal_distance_m;
    std::copy(std::begin(from.successors), std::end(from.successors), lane->successors);
    lane->left = from.left;
    lane->right = from.right;
    auto* point = arena.sequence(lane->points, from.point_count);
    for (int i = 0; i < from.point_count; ++i) *point++ = {from.x_m[i], from.y_m[i], 0.0F};
    ++lane;
    ++message.lanes._length;
  }
  auto* conflict = arena.sequence(message.conflicts, wire::kMaxConflicts);
  message.conflicts._length = 0;
  for (int slot = 0; slot < wire::kMaxConflicts; ++slot) {
    const wire::Conflict& from = map.conflicts[slot];
    if (!from.present) continue;
    *conflict++ = {static_cast<std::uint8_t>(slot),
                   from.first,
                   from.second,
                   from.priority,
                   from.first_entry_m,
                   from.first_exit_m,
                   from.second_entry_m,
                   from.second_exit_m};
    ++message.conflicts._length;
  }
  return message;
}

}  // namespace s4tp::tests
