#pragma once
/// Tracks and maps for tests of the wire, and whether two of them are the same. All values lie on the grid of
/// the wire (multiples of 0.5 are on every one), so that what was sent and what arrives can be compared
/// exactly.

#include <cstdint>
#include <vector>

#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/track_list.hpp"

namespace s4tp::wire {

inline bool operator==(const Track& a, const Track& b) {
  return a.id == b.id && a.x_m == b.x_m && a.y_m == b.y_m && a.heading_rad == b.heading_rad &&
         a.speed_mps == b.speed_mps && a.acceleration_mps2 == b.acceleration_mps2 &&
         a.yaw_rate_radps == b.yaw_rate_radps && a.length_m == b.length_m && a.width_m == b.width_m;
}

inline bool operator==(const Tracks& a, const Tracks& b) {
  if (a.vehicle_time_ms != b.vehicle_time_ms || a.count != b.count || a.left_out != b.left_out) return false;
  for (int i = 0; i < a.count; ++i) {
    if (!(a.items[i] == b.items[i])) return false;
  }
  return true;
}

inline bool operator==(const Lane& a, const Lane& b) {
  if (!a.present && !b.present) return true;
  for (int i = 0; i < 3; ++i) {
    if (a.successors[i] != b.successors[i]) return false;
  }
  for (int i = 0; i < a.point_count; ++i) {
    if (a.x_m[i] != b.x_m[i] || a.y_m[i] != b.y_m[i]) return false;
  }
  return a.present == b.present && a.kind == b.kind && a.in_junction == b.in_junction &&
         a.on_route == b.on_route && a.point_count == b.point_count && a.changes_needed == b.changes_needed &&
         a.speed_limit_mps == b.speed_limit_mps && a.width_m == b.width_m && a.stop_line_m == b.stop_line_m &&
         a.signal_state == b.signal_state && a.route_remaining_m == b.route_remaining_m &&
         a.goal_distance_m == b.goal_distance_m && a.left == b.left && a.right == b.right;
}

inline bool operator==(const Conflict& a, const Conflict& b) {
  if (!a.present && !b.present) return true;
  return a.present == b.present && a.first == b.first && a.second == b.second && a.priority == b.priority &&
         a.first_entry_m == b.first_entry_m && a.first_exit_m == b.first_exit_m &&
         a.second_entry_m == b.second_entry_m && a.second_exit_m == b.second_exit_m;
}

inline bool operator==(const Map& a, const Map& b) {
  for (int i = 0; i < kMaxLanes; ++i) {
    if (!(a.lanes[i] == b.lanes[i])) return false;
  }
  for (int i = 0; i < kMaxConflicts; ++i) {
    if (!(a.conflicts[i] == b.conflicts[i])) return false;
  }
  return a.lanes_left_out == b.lanes_left_out;
}

/// A list in which every value depends on `seed`, so that two lists differ in every frame.
inline Tracks sample_tracks(int count, int seed) {
  Tracks tracks;
  tracks.vehicle_time_ms = static_cast<std::uint16_t>(100 * seed);
  tracks.count = static_cast<std::uint8_t>(count);
  tracks.left_out = static_cast<std::uint8_t>(seed % 32);
  for (int i = 0; i < count; ++i) {
    Track& track = tracks.items[i];
    track.id = static_cast<std::uint8_t>(seed + i);
    track.x_m = 0.5F * static_cast<float>(seed % 500 + i);
    track.y_m = -0.5F * static_cast<float>(seed % 500 - i);
    track.speed_mps = 3.0F * static_cast<float>((seed + i) % 20);
    track.acceleration_mps2 = 0.5F * static_cast<float>(seed % 20 - 10);
    track.yaw_rate_radps = 0.5F;
    track.length_m = 4.0F + 0.5F * static_cast<float>(seed % 7);
    track.width_m = 2.0F;
  }
  return tracks;
}

/// A lane in which every frame depends on `seed`.
inline Lane sample_lane(int points, int seed) {
  Lane lane;
  lane.present = true;
  lane.kind = static_cast<std::uint8_t>(seed % 3);
  lane.in_junction = seed % 2 == 0;
  lane.on_route = seed % 5 == 0;
  lane.point_count = static_cast<std::uint8_t>(points);
  lane.changes_needed = static_cast<std::int8_t>(seed % 5 - 2);
  lane.speed_limit_mps = 0.5F * static_cast<float>(seed % 50);
  lane.width_m = 3.0F;
  lane.stop_line_m = seed % 4 == 0 ? -1.0F : 0.5F * static_cast<float>(seed % 100);
  lane.route_remaining_m = 0.5F * static_cast<float>(seed % 1000);
  lane.goal_distance_m = static_cast<float>(seed % 1000);
  for (int i = 0; i < points; ++i) {
    lane.x_m[i] = static_cast<float>(10 * i);
    lane.y_m[i] = 0.5F * static_cast<float>(seed % 1000 + i);
  }
  return lane;
}

inline Conflict sample_conflict(int first, int second, int seed) {
  Conflict conflict;
  conflict.present = true;
  conflict.first = static_cast<std::uint8_t>(first);
  conflict.second = static_cast<std::uint8_t>(second);
  conflict.priority = static_cast<std::uint8_t>(seed % 3);
  conflict.first_entry_m = 0.5F * static_cast<float>(seed % 100);
  conflict.first_exit_m = conflict.first_entry_m + 4.0F;
  conflict.second_entry_m = static_cast<float>(seed % 100);
  conflict.second_exit_m = conflict.second_entry_m;
  return conflict;
}

/// The first `lanes` slots and the first `conflicts` slots filled; neighbours linked.
inline Map sample_map(int lanes, int points, int conflicts, int seed = 0) {
  Map map;
  for (int i = 0; i < lanes; ++i) {
    map.lanes[i] = sample_lane(points, seed + i);
    if (i + 1 < lanes) map.lanes[i].left = static_cast<std::uint8_t>(i + 1);
    if (i > 0) map.lanes[i].right = static_cast<std::uint8_t>(i - 1);
    map.lanes[i].successors[0] = static_cast<std::uint8_t>((i + 2) % lanes);
  }
  for (int i = 0; i < conflicts; ++i)
    map.conflicts[i] = sample_conflict(i % lanes, (i + 1) % lanes, seed + i);
  return map;
}

/// All frames of a list.
inline std::vector<Frame> frames_of(TrackListSender& sender, const Tracks& tracks) {
  sender.start(tracks);
  std::vector<Frame> frames;
  for (Frame frame; sender.next(frame);) frames.push_back(frame);
  return frames;
}

/// Everything a map sender has to say in one 10 ms tick, at most `pace` frames.
inline std::vector<Frame> frames_of(MapSender& sender, std::uint32_t now_ms, int pace) {
  std::vector<Frame> frames;
  for (Frame frame; static_cast<int>(frames.size()) < pace && sender.next(now_ms, frame);)
    frames.push_back(frame);
  return frames;
}

}  // namespace s4tp::wire
