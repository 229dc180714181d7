#include "sim_host/train/network.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sim_host/train/full_size.hpp"
#include "sim_host/train/running_sum.hpp"

namespace s4tp::train {
namespace {

using satp::LayerInfo;
using satp::LayerKind;
using torch::Tensor;

// Names of torch's parameters have no dots.
std::string parameter_name(std::string name, const char* what) {
  std::replace(name.begin(), name.end(), '.', '/');
  return name + "/" + what;
}

// Position j of the history: sin and cos of j / 10000^(2 i / d) in turn (Vaswani et al. 2017).
Tensor sinusoids(int samples, int width) {
  Tensor table = torch::zeros({samples, width});
  auto value = table.accessor<float, 2>();
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < width; ++i) {
      const double angle = j / std::pow(10000.0, (i / 2 * 2) / static_cast<double>(width));
      value[j][i] = static_cast<float>(i % 2 == 0 ? std::sin(angle) : std::cos(angle));
    }
  }
  return table;
}

Tensor heads_of_features(int width, int heads) {
  Tensor table = torch::zeros({width, heads});
  for (int i = 0; i < width; ++i) table[i][i / (width / heads)] = 1.0F;
  return table;
}

// Units as a row on the device of `like`: made once for all steps, as a GPU is waited for each time.
template <int kColumns>
Tensor units_on(const float (&unit)[kColumns], const Tensor& like) {
  return torch::tensor(std::vector<float>(std::begin(unit), std::end(unit))).to(like.device());
}

Tensor in_units(const std::vector<Tensor>& columns, const Tensor& units) {
  return (torch::stack(columns, 1) / units).clamp(-satp::kInputRange, satp::kInputRange);
}

// Where the decoding of each future stands: [R] each.
struct Front {
  Tensor x, y, heading, velocity_x, velocity_y;
};

Tensor own_features(const Front& front, const Tensor& speed_mps, float time_s, const Tensor& units) {
  const Tensor time = torch::full_like(speed_mps, time_s);
  return in_units({front.x, front.y, front.heading.sin(), front.heading.cos(), front.velocity_x,
                   front.velocity_y, speed_mps, time},
                  units);
}

// \param plan [R, values] \param rule [R, 3]
Tensor plan_features(const Front& front, const Tensor& plan, const Tensor& rule, const Tensor& units) {
  const Tensor cos = front.heading.cos();
  const Tensor sin = front.heading.sin();
  const auto value = plan.unbind(1);
  const auto ahead = [&](int column) {
    return (value[column] - front.x) * cos + (value[column + 1] - front.y) * sin;
  };
  const auto left = [&](int column) {
    return (value[column + 1] - front.y) * cos - (value[column] - front.x) * sin;
  };
  const Tensor turn = value[5] - front.heading;
  return in_units({ahead(0), left(0), ahead(3), left(3), turn.sin(), turn.cos(), value[6], value[7], value[8],
                   rule.select(1, 0), rule.select(1, 1), rule.select(1, 2)},
                  units);
}

}  // namespace

Network::Network(const satp::NetworkShape& shape) : shape_(shape) {
  for (int layer = 0; layer < satp::kLayerCount; ++layer) {
    const LayerInfo info = satp::layer_info(shape, layer);
    // The network begins near constant velocity.
    add_layer(info.name, info.kind, info.rows, info.columns, layer == satp::kIncrements ? 0.1F : 1.0F);
  }
  mode_ = register_parameter("start/mode", torch::randn({shape.modes, shape.hidden}).mul(0.3F));
  position_ = register_buffer("position", sinusoids(kHistorySamples, shape.width));
  head_of_ = register_buffer("head_of", heads_of_features(shape.width, shape.heads));
  for (const FullLayerInfo& info : full_layers(shape))
    add_layer(info.name, info.kind, info.rows, info.columns, 1.0F);
}

// \param share  of the range a linear layer's numbers are drawn from
void Network::add_layer(const std::string& name, LayerKind kind, int rows, int columns, float share) {
  const auto even = [&](std::vector<std::int64_t> sizes) {
    const float bound = share * (1.0F / std::sqrt(static_cast<float>(columns)));
    return torch::rand(sizes).mul(2.0F * bound).sub(bound);
  };
  Tensor weight, bias;
  switch (kind) {
    case LayerKind::kLinear:
      weight = register_parameter(parameter_name(name, "weight"), even({rows, columns}));
      bias = register_parameter(parameter_name(name, "bias"), even({rows}));
      break;
    case LayerKind::kLayerNorm:
      weight = register_parameter(parameter_name(name, "gain"), torch::ones({rows}));
      bias = register_parameter(parameter_name(name, "bias"), torch::zeros({rows}));
      break;
    case LayerKind::kVector:
      weight = register_parameter(parameter_name(name, "vector"), torch::rand({rows}));
      break;
    case LayerKind::kAdd:
    case LayerKind::kScores:
      break;
  }
  weight_.push_back(weight);
  bias_.push_back(bias);
}

void Network::round_as_integers(Ranges ranges) {
  const double largest_null_plan = torch::relu(weight_[satp::kNullPlan]).max().item<double>();
  rounding_.emplace(shape_, std::move(ranges), largest_null_plan);
  register_parameter("integers/log_stretch", rounding_->log_stretch());
}

Tensor Network::linear(int layer, const Tensor& x) const {
  return torch::linear(x, rounding_ ? rounding_->weight(layer, weight_[layer]) : weight_[layer],
                       bias_[layer]);
}

Tensor Network::kept(int layer, const Tensor& x) const {
  return rounding_ ? rounding_->output(layer, x) : x;
}

Tensor Network::relu(int layer, const Tensor& x) const {
  return kept(layer, torch::relu(linear(layer, x)));
}

Tensor Network::normalize(int layer, const Tensor& x) const {
  return kept(layer, torch::layer_norm(x, {shape_.width}, weight_[layer], bias_[layer], 1e-5));
}

Tensor Network::attend(int block, const Tensor& query, const Tensor& keys, const Tensor& mask,
                       Tensor* weights) const {
  const auto asked = [&](int layer, const Tensor& x) {
    return kept(block + layer, linear(block + layer, x));
  };
  const Tensor q = asked(satp::kQuery, query).unsqueeze(2);
  const Tensor k = asked(satp::kKey, keys).unsqueeze(1);
  const Tensor v = asked(satp::kValue, keys).unsqueeze(1);
  const float scale = 1.0F / std::sqrt(static_cast<float>(shape_.width / shape_.heads));
  const Tensor score = torch::matmul(q * k, head_of_) * scale;  // [R, Q, N, heads]
  const Tensor there = mask.unsqueeze(1).unsqueeze(3);
  const Tensor share = torch::softmax(score + (there - 1.0F) * 1e9F, 2) * there;
  if (weights != nullptr) *weights = share.mean(3);
  const Tensor o = kept(block + satp::kValue, (torch::matmul(share, head_of_.t()) * v).sum(2));
  const Tensor y = normalize(block + satp::kNorm1, query + linear(block + satp::kOutput, o));
  const Tensor inner = relu(block + satp::kExpand, y);
  return normalize(block + satp::kNorm2, y + linear(block + satp::kContract, inner));
}

Tensor Network::history(int embed, int block, const Tensor& samples, const Tensor& mask) const {
  const Tensor features = kept(embed + 1, linear(embed + 1, relu(embed, samples)) + position_);
  const Tensor present = features.slice(1, kHistorySamples - 1, kHistorySamples);
  return attend(block, present, features, mask).squeeze(1);
}

Tensor Network::map_channel(int begin, const Tensor& agent, const MapChannel& map, Tensor* weights) const {
  const auto layer = [begin](int of_lanes) { return begin + of_lanes - satp::kMapPoint1; };
  const Tensor point = relu(layer(satp::kMapPoint2), relu(layer(satp::kMapPoint1), map.point));
  const Tensor driver = agent.index_select(0, map.vehicle).unsqueeze(1);
  const Tensor path = attend(layer(satp::kLane), driver, point, map.point_mask).squeeze(1);
  const std::int64_t vehicles = map.path_mask.size(0);
  const std::int64_t paths = map.path_mask.size(1);
  const Tensor no_path = torch::zeros({vehicles * paths, shape_.width}, agent.options());
  const Tensor paths_of = no_path.index_copy(0, map.slot, path).view({vehicles, paths, shape_.width});
  return attend(layer(satp::kRoute), agent.unsqueeze(1), paths_of, map.path_mask, weights).squeeze(1);
}

Encoded Network::encode(const Batch& batch) {
  if (rounding_) rounding_->fold();
  const std::int64_t scenes = batch.place.size(0);
  const std::int64_t agents = batch.place.size(1);
  const std::int64_t width = shape_.width;
  const Tensor ego =
      history(satp::kEgoEmbed1, satp::kEgoAttention, batch.ego_history, batch.ego_history_mask);
  const Tensor hdv = history(satp::kHdvEmbed1, satp::kHdvAttention, batch.history, batch.history_mask);
  const Tensor all = torch::zeros({scenes * agents, width}, ego.options());
  const Tensor ego_slot = torch::arange(scenes, batch.slot.options()) * agents;
  const Tensor slots = torch::cat({ego_slot, batch.slot});
  const Tensor read = all.index_copy(0, slots, torch::cat({ego, hdv})).view({scenes, agents, width});
  const Tensor token = kept(satp::kTokenAdd, read + linear(satp::kPlaceEmbed, batch.place));
  const Tensor first = attend(satp::kAgent1, token, token, batch.present);
  const Tensor both = kept(satp::kAgent2Input, token + first);
  const Tensor second = attend(satp::kAgent2, both, both, batch.present);
  const Tensor agent = second.reshape({scenes * agents, width}).index_select(0, batch.slot);

  Encoded encoded;
  const Tensor map = map_channel(satp::kMapPoint1, agent, batch.lanes, &encoded.route);
  encoded.route = encoded.route.squeeze(1);

  const Tensor pair = relu(satp::kPair2, relu(satp::kPair1, batch.pair));
  const Tensor gate_input = torch::cat({ego.index_select(0, batch.scene), hdv, pair}, 1);
  encoded.gate =
      torch::sigmoid(linear(satp::kGate2, relu(satp::kGate1, gate_input))) * batch.paths_meet.unsqueeze(1);
  Tensor state = linear(satp::kStart, torch::cat({agent, map, pair}, 1));
  if (full() && batch.crosswalks.point.defined()) {
    const Tensor seen = map_channel(kCrosswalkChannel, agent, batch.crosswalks);
    state = state + linear(kCrosswalkState, seen) * batch.crosswalks.path_mask.amax(1, true);
  }
  if (full()) {
    const Tensor speed_mps = batch.place.select(1, 0).select(1, 4) * satp::kPlaceUnit[4];
    encoded.ego = ego_poses(linear(kEgoHead2, relu(kEgoHead1, second.select(1, 0))), speed_mps);
  }
  encoded.start = torch::tanh(state.unsqueeze(1) + mode_);
  return encoded;
}

Decoded Network::decode(const Batch& batch, const Encoded& encoded, const Tensor& has_plan) {
  const std::int64_t vehicles = batch.vehicles();
  const std::int64_t modes = shape_.modes;
  const std::int64_t increments = shape_.steps_per_decode;
  const auto per_mode = [&](const Tensor& x) { return x.repeat_interleave(modes, 0); };
  const Tensor gate = per_mode(encoded.gate);
  const Tensor planned = per_mode(has_plan.unsqueeze(1));
  const Tensor plan = per_mode(batch.plan);
  const Tensor rule = per_mode(batch.rule);
  const Tensor speed = per_mode(batch.speed_mps);
  const Tensor null_plan = torch::relu(weight_[satp::kNullPlan]);
  const Tensor unit = units_on(satp::kIncrementUnit, speed);
  const Tensor own_unit = units_on(satp::kOwnUnit, speed);
  const Tensor plan_unit = units_on(satp::kPlanUnit, speed);
  const float duration_s = kStepS * static_cast<float>(increments);
  const Tensor start = encoded.start.reshape({vehicles * modes, shape_.hidden});
  const Tensor zero = torch::zeros_like(speed);
  Front front{zero, zero, zero, speed, zero};
  Tensor last = torch::zeros({vehicles * modes, 1, 3}, speed.options());
  Tensor hidden = start;
  std::vector<Tensor> poses;
  for (int step = 0; step < shape_.decoder_steps; ++step) {
    const float time_s = kStepS * static_cast<float>(step * shape_.steps_per_decode);
    const Tensor own = relu(satp::kOwnEmbed, own_features(front, speed, time_s, own_unit));
    const Tensor ego = relu(satp::kPlanEmbed, plan_features(front, plan.select(1, step), rule, plan_unit));
    const Tensor x = kept(satp::kGruMix, own + gate * (planned * ego + (1.0F - planned) * null_plan));
    const Tensor read = rounding_ ? IntegerRounding::state(hidden) : hidden;
    const auto gates = torch::sigmoid(linear(satp::kGruGates, torch::cat({x, read}, 1))).chunk(2, 1);
    const Tensor news =
        torch::tanh(linear(satp::kGruFromInput, x) + gates[0] * linear(satp::kGruState, read));
    hidden = (1.0F - gates[1]) * news + gates[1] * hidden;
    const Tensor moved = linear(satp::kIncrements, hidden).view({-1, increments, 3}) * unit;
    const Tensor steady = torch::stack({speed * kStepS, zero, zero}, 1).unsqueeze(1);
    const Tensor pose = last + running_sum(moved + steady);
    last = pose.slice(1, increments - 1, increments);
    // What is predicted adds up, but what the next step sees of it is taken as given: with gradients through the
    // features of six steps in a row the training was unsteady (docs/training.md).
    const auto end = last.detach().squeeze(1).unbind(1);
    front = {end[0], end[1], end[2], (end[0] - front.x) / duration_s, (end[1] - front.y) / duration_s};
    poses.push_back(pose);
  }
  Decoded decoded;
  decoded.pose = torch::cat(poses, 1).view({vehicles, modes, -1, 3});
  const auto heads =
      linear(satp::kHeadModes, torch::cat({start, hidden}, 1)).view({vehicles, modes, 2}).unbind(2);
  decoded.score = heads[0];
  decoded.yields = heads[1];
  return decoded;
}

void Network::rescale_yields(double scale, double shift) {
  const torch::NoGradGuard no_gradient;
  weight_[satp::kHeadModes][1].mul_(scale);
  bias_[satp::kHeadModes][1].mul_(scale).add_(shift);
}

std::int64_t Network::size() const {
  std::int64_t count = 0;
  for (const Tensor& parameter : parameters()) count += parameter.numel();
  return count;
}

std::map<std::string, std::vector<float>> Network::arrays() const {
  std::map<std::string, std::vector<float>> result;
  const auto keep = [&](const std::string& name, const Tensor& tensor) {
    const Tensor values = tensor.detach().to(torch::kCPU).contiguous();
    result[name].assign(values.data_ptr<float>(), values.data_ptr<float>() + values.numel());
  };
  for (int layer = 0; layer < satp::kLayerCount; ++layer) {
    const LayerInfo info = satp::layer_info(shape_, layer);
    const std::string name = info.name;
    if (info.kind == LayerKind::kVector) keep(name, torch::relu(weight_[layer]));
    if (info.kind == LayerKind::kLinear) keep(name + ".weight", weight_[layer]);
    if (info.kind == LayerKind::kLayerNorm) keep(name + ".gain", weight_[layer]);
    if (bias_[layer].defined()) keep(name + ".bias", bias_[layer]);
  }
  keep("start.mode", mode_);
  return result;
}

}  // namespace s4tp::train
