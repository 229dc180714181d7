#include "sim_host/train/full_size.hpp"

#include "algo/core/parameters.hpp"
#include "sim_host/train/running_sum.hpp"

namespace s4tp::train {
namespace {

using satp::LayerInfo;
using satp::LayerKind;
using torch::Tensor;

constexpr int kEgoInner = 64;

}  // namespace

std::vector<FullLayerInfo> full_layers(const satp::NetworkShape& shape) {
  if (shape.id != satp::kFullShape.id) return {};
  std::vector<FullLayerInfo> layers;
  for (int layer = satp::kMapPoint1; layer < satp::kRoute + satp::kBlockLayers; ++layer) {
    const LayerInfo info = satp::layer_info(shape, layer);
    layers.push_back({std::string("crosswalk.") + info.name, info.kind, info.rows, info.columns});
  }
  layers.push_back({"crosswalk.state", LayerKind::kLinear, shape.hidden, shape.width});
  layers.push_back({"ego.head_1", LayerKind::kLinear, kEgoInner, shape.width});
  layers.push_back({"ego.head_2", LayerKind::kLinear, 2 * kHorizonSteps, kEgoInner});
  return layers;
}

Tensor roll_out(const Tensor& acceleration_mps2, const Tensor& steering_rad, const Tensor& speed_mps) {
  const auto& vehicle = Parameters{}.vehicle;
  const float to_centre_m = 0.5F * vehicle.length_m - vehicle.rear_overhang_m;
  Tensor speed = speed_mps;
  std::vector<Tensor> mean;
  for (const Tensor& acceleration : acceleration_mps2.unbind(1)) {
    const Tensor next = torch::relu(speed + kStepS * acceleration);
    mean.push_back(0.5F * (speed + next));
    speed = next;
  }
  const Tensor way = kStepS * torch::stack(mean, 1);
  const Tensor turn = way * steering_rad.tan() / vehicle.wheelbase_m;
  const Tensor heading = running_sum(turn);
  const Tensor halfway = heading - 0.5F * turn;  // a step's chord points where the car does in its middle
  const Tensor x = running_sum(way * halfway.cos()) + to_centre_m * (heading.cos() - 1.0F);
  const Tensor y = running_sum(way * halfway.sin()) + to_centre_m * heading.sin();
  return torch::stack({x, y, heading}, 2);
}

Tensor ego_poses(const Tensor& output, const Tensor& speed_mps) {
  const auto bounded = torch::tanh(output).view({-1, kHorizonSteps, 2}).unbind(2);
  return roll_out(kMostAccelerationMps2 * bounded[0], kMostSteeringRad * bounded[1], speed_mps);
}

}  // namespace s4tp::train
