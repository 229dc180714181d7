#pragma once
/// What the size full has beyond the table that all sizes share (satp::layer_info): a second channel of the map, for
/// crosswalks and sidewalks, and a head for our own motion. Both are the training's alone.

#include <torch/types.h>

#include <string>
#include <vector>

#include "algo/satp/network_shape.hpp"

namespace s4tp::train {

/// Layers of full, numbered on from those of the table.
enum FullLayer : int {
  /// The layers of the map channel once more, in their order: satp::kMapPoint1 to the end of satp::kRoute.
  kCrosswalkChannel = satp::kLayerCount,
  kCrosswalkState = kCrosswalkChannel + satp::kRoute + satp::kBlockLayers - satp::kMapPoint1,
  kEgoHead1,
  kEgoHead2,
  kFullLayerCount,
};

struct FullLayerInfo {
  std::string name;
  satp::LayerKind kind;
  int rows;
  int columns;
};
/// From kCrosswalkChannel on; of every other size none.
[[nodiscard]] std::vector<FullLayerInfo> full_layers(const satp::NetworkShape& shape);

inline constexpr float kMostAccelerationMps2 = 8.0F;  ///< of the ego head, either way
inline constexpr float kMostSteeringRad = 0.6F;

/// The ego head's roll-out by the kinematic bicycle model, from its own frame's origin straight ahead; who has come to
/// rest does not drive backwards.
/// \param acceleration_mps2, steering_rad  [B, T] in each step of kStepS \param speed_mps  [B] at the begin
/// \return [B, T, 3] x, y, heading of our box centre at each step's end
[[nodiscard]] torch::Tensor roll_out(const torch::Tensor& acceleration_mps2,
                                     const torch::Tensor& steering_rad, const torch::Tensor& speed_mps);

/// The same of the head's output. \param output [B, 2 T], not bounded yet
[[nodiscard]] torch::Tensor ego_poses(const torch::Tensor& output, const torch::Tensor& speed_mps);

}  // namespace s4tp::train
