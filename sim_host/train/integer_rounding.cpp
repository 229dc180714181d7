#include "sim_host/train/integer_rounding.hpp"

#include <torch/torch.h>

#include <string>
#include <utility>

namespace s4tp::train {
namespace {

using satp::Format;
using satp::LayerInfo;
using satp::LayerKind;
using torch::Tensor;

constexpr double kLeast8 = -128.0;

// To whole steps between the least and the most that eight bits hold; the gradient passes the rounding as if it were
// not there, so that a step learns from what is rounded and what is cut off.
Tensor rounded(const Tensor& x, const Tensor& step, double zero) {
  const Tensor steps = (x / step).clamp(kLeast8 - zero, kMost8 - zero);
  return (steps + (steps.round() - steps).detach()) * step;
}

Scale output_of(const ActivationScales& scales, const LayerInfo& info) {
  const std::string name = info.name;
  if (name == "ego_history.attention.norm_2" || name == "hdv_history.attention.norm_2")
    return scales.history();
  if (info.output == Format::kInt8Relu) return scales.relu(name);
  if (info.output != Format::kInt8) return {};
  if (info.kind == LayerKind::kAdd) return {64.0 * scales.units(name), 0.0};
  return scales.int8(name);
}

// Both kinds of history go into the same sums: they have one range.
int source_of(int layer) {
  return layer == satp::kEgoAttention + satp::kNorm2 ? satp::kHdvAttention + satp::kNorm2 : layer;
}

Tensor columns_of(const ActivationScales& scales, const LayerInfo& info) {
  std::vector<float> columns;
  for (const Segment& segment : scales.inputs_of(info)) {
    columns.insert(columns.end(), static_cast<std::size_t>(segment.columns),
                   static_cast<float>(segment.scale.scale));
  }
  const Tensor all = torch::tensor(columns);
  return all / all.max();
}

}  // namespace

IntegerRounding::IntegerRounding(const satp::NetworkShape& shape, Ranges ranges, double largest_null_plan)
    : shape_(shape),
      calibrated_(std::move(ranges)),
      largest_null_plan_(largest_null_plan),
      log_stretch_(torch::zeros({satp::kLayerCount})),
      columns_(satp::kLayerCount),
      output_(satp::kLayerCount) {
  const ActivationScales scales(shape, calibrated_, largest_null_plan);
  for (int layer = 0; layer < satp::kLayerCount; ++layer) {
    output_[layer] = output_of(scales, satp::layer_info(shape, layer));
  }
}

Ranges IntegerRounding::ranges() const {
  const Tensor stretch = log_stretch_.detach().exp().to(torch::kCPU);
  Ranges ranges = calibrated_;
  for (int layer = 0; layer < satp::kLayerCount; ++layer) {
    const auto range = ranges.find(satp::layer_info(shape_, layer).name);
    if (range == ranges.end()) continue;
    const auto times = stretch[source_of(layer)].item<float>();
    range->second.low *= times;
    range->second.high *= times;
  }
  return ranges;
}

void IntegerRounding::fold() {
  const Ranges now = ranges();
  const ActivationScales scales(shape_, now, largest_null_plan_);
  for (int layer = 0; layer < satp::kLayerCount; ++layer) {
    const LayerInfo info = satp::layer_info(shape_, layer);
    if (info.kind == LayerKind::kLinear) columns_[layer] = columns_of(scales, info).to(log_stretch_.device());
  }
}

Tensor IntegerRounding::weight(int layer, const Tensor& weight) const {
  const Tensor folded = weight * columns_[layer];
  const Tensor scale = (folded.detach().abs().amax(1) / kMost8).clamp_min(1e-9);
  const Tensor zero = torch::zeros({scale.size(0)}, scale.options().dtype(torch::kInt32));
  return torch::fake_quantize_per_channel_affine(folded, scale, zero, 0, static_cast<std::int64_t>(kLeast8),
                                                 static_cast<std::int64_t>(kMost8)) /
         columns_[layer];
}

Tensor IntegerRounding::output(int layer, const Tensor& x) const {
  const Scale& scale = output_[layer];
  if (scale.scale == 0.0) return x;
  return rounded(x, scale.scale * log_stretch_[source_of(layer)].exp(), scale.zero);
}

Tensor IntegerRounding::state(const Tensor& x) {
  return rounded(x, torch::full({}, 1.0 / 128.0, x.options()), 0.0);
}

}  // namespace s4tp::train
