#pragma once
/// Recorded drivers: short clips of real traffic to measure predictors on (docs/recorded_clips.md).

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim_host/world/map/polyline.hpp"

namespace s4tp::clips {

/// A recorded vehicle at one instant; the clip's own frame.
struct ClipState {
  map::Vec2 centre;
  double heading_rad = 0.0;
  double speed_mps = 0.0;
};

struct ClipVehicle {
  std::string id;
  bool motor = true;  ///< car, truck, bus, motorcycle
  double length_m = 4.5;
  double width_m = 1.8;
  std::map<int, ClipState> states;  ///< by step
  /// Whether every step from `first` to `last` was seen.
  [[nodiscard]] bool seen(int first, int last) const;
};

/// A lane of the road: between its bounds, driven along its points.
struct ClipLane {
  map::Polyline centre;
  double width_m = 3.5;
  double speed_limit_mps = 13.89;  ///< of a lane without one
  std::vector<int> successors;     ///< indices
  int left = -1;                   ///< of the same direction
  int right = -1;
};

struct Clip {
  std::string id;
  double dt_s = 0.1;
  std::vector<ClipLane> lanes;
  std::vector<ClipVehicle> vehicles;
};

/// Reads ID.json or ID.json.gz. CLIP-001 What is not as docs/recorded_clips.md says, or beyond its limits, is
/// refused, never guessed. \throws std::runtime_error naming the file and what was wrong
[[nodiscard]] Clip load_clip(const std::filesystem::path& file);

/// The clips in a folder, by name. \throws std::runtime_error when there is none
[[nodiscard]] std::vector<std::filesystem::path> clip_files(const std::filesystem::path& folder);

/// Whose traffic a clip shows, by its id (docs/recorded_clips.md); of an unknown recording the id up to the
/// first digit.
[[nodiscard]] std::string family_of(const std::string& clip_id);

}  // namespace s4tp::clips
