#include "sim_host/train/float_network.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "algo/satp/step_features.hpp"

namespace s4tp::train {
namespace {

using Vector = std::vector<float>;

template <std::size_t N>
Vector normalized(const float (&features)[N], const float (&units)[N]) {
  Vector result(N);
  for (std::size_t c = 0; c < N; ++c)
    result[c] = std::clamp(features[c] / units[c], -satp::kInputRange, satp::kInputRange);
  return result;
}

Vector sum(Vector a, const Vector& b) {
  for (std::size_t c = 0; c < a.size(); ++c) a[c] += b[c];
  return a;
}

Vector joined(std::initializer_list<const Vector*> parts) {
  Vector result;
  for (const Vector* part : parts) result.insert(result.end(), part->begin(), part->end());
  return result;
}

float sigmoid(float x) {
  return 1.0F / (1.0F + std::exp(-x));
}

float wrapped(float angle_rad) {
  return std::remainder(angle_rad, 2.0F * std::numbers::pi_v<float>);
}

}  // namespace

float Range::magnitude() const {
  return std::max(std::fabs(low), std::fabs(high));
}

std::map<std::string, int> tensor_sizes(const satp::NetworkShape& shape) {
  std::map<std::string, int> sizes;
  for (int i = 0; i < satp::kLayerCount; ++i) {
    const satp::LayerInfo info = satp::layer_info(shape, i);
    const std::string name = info.name;
    if (info.kind == satp::LayerKind::kLinear) {
      sizes[name + ".weight"] = info.rows * info.columns;
      sizes[name + ".bias"] = info.rows;
    } else if (info.kind == satp::LayerKind::kLayerNorm) {
      sizes[name + ".gain"] = info.rows;
      sizes[name + ".bias"] = info.rows;
    } else if (info.kind == satp::LayerKind::kVector) {
      sizes[name] = info.rows;
    }
  }
  sizes["start.mode"] = shape.modes * shape.hidden;
  return sizes;
}

float position_encoding(const satp::NetworkShape& shape, int t, int c) {
  const int even = c / 2 * 2;
  const double angle = t * std::pow(10000.0, -static_cast<double>(even) / shape.width);
  return static_cast<float>(c % 2 == 0 ? std::sin(angle) : std::cos(angle));
}

FloatNetwork::FloatNetwork(const satp::NetworkShape& shape, Tensors tensors)
    : shape_(shape), tensors_(std::move(tensors)) {
  if (shape.lane_points != satp::kLanePoints || shape.decoder_steps != satp::kDecoderSteps)
    throw std::runtime_error("the float network computes the sizes that share NetworkInput");
  for (const auto& [name, size] : tensor_sizes(shape)) {
    const auto found = tensors_.find(name);
    if (found == tensors_.end()) throw std::runtime_error("tensor " + name + " is missing");
    if (static_cast<int>(found->second.size()) != size)
      throw std::runtime_error("tensor " + name + " has " + std::to_string(found->second.size()) +
                               " numbers, not " + std::to_string(size));
  }
}

const Vector& FloatNetwork::record(const std::string& name, const Vector& values) {
  Range& range = ranges_[name];
  for (const float value : values) {
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return values;
}

Vector FloatNetwork::linear(const std::string& name, const Vector& input) {
  const Vector& weight = tensors_.at(name + ".weight");
  Vector result = tensors_.at(name + ".bias");
  if (weight.size() != result.size() * input.size()) throw std::logic_error(name + ": input of a wrong size");
  for (std::size_t o = 0; o < result.size(); ++o) {
    for (std::size_t j = 0; j < input.size(); ++j) result[o] += weight[o * input.size() + j] * input[j];
  }
  record(name, result);
  return result;
}

Vector FloatNetwork::relu(const std::string& name, const Vector& input) {
  Vector result = linear(name, input);
  for (float& value : result) value = std::max(value, 0.0F);
  return result;
}

Vector FloatNetwork::norm(const std::string& name, const Vector& input) {
  constexpr float kEpsilon = 1e-5F;
  const Vector& gain = tensors_.at(name + ".gain");
  const Vector& bias = tensors_.at(name + ".bias");
  const float count = static_cast<float>(input.size());
  float mean = 0.0F;
  for (const float value : input) mean += value / count;
  float variance = 0.0F;
  for (const float value : input) variance += (value - mean) * (value - mean) / count;
  Vector result(input.size());
  for (std::size_t c = 0; c < input.size(); ++c)
    result[c] = gain[c] * (input[c] - mean) / std::sqrt(variance + kEpsilon) + bias[c];
  record(name, result);
  return result;
}

Vector FloatNetwork::attend(const std::string& name, const Vector& query, const std::vector<Vector>& keys,
                            unsigned mask, float* mean_weights) {
  const Vector asked = linear(name + ".query", query);
  std::vector<Vector> key;
  std::vector<Vector> value;
  for (const Vector& seen : keys) {
    key.push_back(linear(name + ".key", seen));
    value.push_back(linear(name + ".value", seen));
  }
  const int head_width = shape_.width / shape_.heads;
  Vector mixed(asked.size(), 0.0F);
  for (int head = 0; head < shape_.heads; ++head) {
    const int from = head * head_width;
    Vector score(keys.size(), 0.0F);
    float largest = -1e30F;
    for (std::size_t j = 0; j < keys.size(); ++j) {
      if ((mask >> j & 1U) == 0U) continue;
      for (int c = from; c < from + head_width; ++c) score[j] += asked[c] * key[j][c];
      score[j] /= std::sqrt(static_cast<float>(head_width));
      largest = std::max(largest, score[j]);
    }
    float total = 0.0F;
    for (std::size_t j = 0; j < keys.size(); ++j) {
      score[j] = (mask >> j & 1U) == 0U ? 0.0F : std::exp(score[j] - largest);
      total += score[j];
    }
    if (total == 0.0F) continue;
    for (std::size_t j = 0; j < keys.size(); ++j) {
      if (mean_weights != nullptr) mean_weights[j] += score[j] / total / static_cast<float>(shape_.heads);
      for (int c = from; c < from + head_width; ++c) mixed[c] += score[j] / total * value[j][c];
    }
  }
  const Vector first = record(name + ".add_1", sum(query, linear(name + ".output", mixed)));
  const Vector middle = norm(name + ".norm_1", first);
  const Vector second =
      record(name + ".add_2", sum(middle, linear(name + ".contract", relu(name + ".expand", middle))));
  return norm(name + ".norm_2", second);
}

Vector FloatNetwork::history(const std::string& name,
                             const float (&rows)[kHistorySamples][satp::kHistoryFeatures], unsigned valid) {
  std::vector<Vector> tokens;
  for (int t = 0; t < kHistorySamples; ++t) {
    const Vector inner = relu(name + ".embed_1", normalized(rows[t], satp::kHistoryUnit));
    Vector token = linear(name + ".embed_2", inner);
    for (int c = 0; c < shape_.width; ++c) token[c] += position_encoding(shape_, t, c);
    tokens.push_back(record(name + ".embed_2", token));
  }
  return attend(name + ".attention", tokens.back(), tokens, valid);
}

FloatEncoded FloatNetwork::encode(const satp::NetworkInput& input) {
  std::vector<Vector> histories = {history("ego_history", input.ego_history, input.ego_history_valid)};
  for (int i = 0; i < input.hdvs; ++i)
    histories.push_back(history("hdv_history", input.history[i], input.history_valid[i]));
  std::vector<Vector> tokens;
  for (std::size_t a = 0; a < histories.size(); ++a) {
    const Vector place = linear("place.embed", normalized(input.place[a], satp::kPlaceUnit));
    tokens.push_back(record("token.add", sum(histories[a], place)));
  }
  const unsigned all = (1U << tokens.size()) - 1U;
  std::vector<Vector> second;
  for (const Vector& token : tokens)
    second.push_back(record("agent_2.input", sum(token, attend("agent_1", token, tokens, all))));

  FloatEncoded encoded;
  for (int i = 0; i < input.hdvs; ++i) {
    const Vector agent = attend("agent_2", second[1 + i], second, all);
    std::vector<Vector> lanes(kPathsPerAgent, Vector(shape_.width, 0.0F));
    unsigned mask = 0;
    for (int k = 0; k < kPathsPerAgent; ++k) {
      const int count = input.lane_points[i][k];
      if (count == 0) continue;
      mask |= 1U << k;
      std::vector<Vector> points;
      for (int p = 0; p < count; ++p) {
        const Vector inner = relu("map.point_1", normalized(input.lane[i][k][p], satp::kLaneUnit));
        points.push_back(relu("map.point_2", inner));
      }
      lanes[k] = attend("lane", agent, points, (1U << count) - 1U);
    }
    const Vector map = attend("route", agent, lanes, mask, encoded.route[i]);
    const Vector pair = relu("pair.pair_2", relu("pair.pair_1", normalized(input.pair[i], satp::kPairUnit)));
    const Vector inner = relu("gate.gate_1", joined({&histories[0], &histories[1 + i], &pair}));
    encoded.gate[i] = sigmoid(linear("gate.gate_2", inner)[0]) * static_cast<float>(input.paths_meet[i]);
    const Vector state = linear("start.state", joined({&agent, &map, &pair}));
    for (int k = 0; k < shape_.modes; ++k) {
      for (int c = 0; c < shape_.hidden; ++c)
        encoded.start[i].push_back(std::tanh(state[c] + tensors_.at("start.mode")[k * shape_.hidden + c]));
    }
  }
  return encoded;
}

FloatFutures FloatNetwork::decode(const FloatEncoded& encoded, const satp::NetworkInput& input, int hdv,
                                  const satp::PlanInput* plan, float temperature) {
  FloatFutures futures;
  const float speed_mps = input.speed_mps[hdv];
  for (int k = 0; k < shape_.modes; ++k) {
    const auto from = encoded.start[hdv].begin() + static_cast<std::ptrdiff_t>(k) * shape_.hidden;
    const Vector start(from, from + shape_.hidden);
    Vector state = start;
    satp::StepState at;
    at.velocity_x_mps = speed_mps;
    for (int s = 0; s < shape_.decoder_steps; ++s) {
      float own[satp::kOwnFeatures];
      own_features(at, speed_mps, s, own);
      Vector x = relu("own.embed", normalized(own, satp::kOwnUnit));
      Vector ours = tensors_.at("null_plan");
      if (plan != nullptr) {
        float seen[satp::kPlanFeatures];
        plan_features(at, plan->step[hdv][s], input.pair[hdv], seen);
        ours = relu("plan.embed", normalized(seen, satp::kPlanUnit));
      }
      for (std::size_t c = 0; c < x.size(); ++c) x[c] += encoded.gate[hdv] * ours[c];
      record("gru.mix", x);
      const Vector gates = linear("gru.gates", joined({&x, &state}));
      const Vector from_input = linear("gru.input", x);
      const Vector from_state = linear("gru.state", state);
      for (int c = 0; c < shape_.hidden; ++c) {
        const float keep = sigmoid(gates[shape_.hidden + c]);
        const float candidate = std::tanh(from_input[c] + sigmoid(gates[c]) * from_state[c]);
        state[c] = (1.0F - keep) * candidate + keep * state[c];
      }
      const Vector increments = linear("head.increments", state);
      const Pose before = at.last;
      for (int i = 0; i < shape_.steps_per_decode; ++i) {
        at.last.x_m += speed_mps * kStepS + increments[3 * i] * satp::kIncrementUnit[0];
        at.last.y_m += increments[3 * i + 1] * satp::kIncrementUnit[1];
        at.last.heading_rad = wrapped(at.last.heading_rad + increments[3 * i + 2] * satp::kIncrementUnit[2]);
        float(&pose)[3] = futures.pose[k][s * shape_.steps_per_decode + i];
        pose[0] = at.last.x_m;
        pose[1] = at.last.y_m;
        pose[2] = at.last.heading_rad;
      }
      const float seconds = kStepS * static_cast<float>(shape_.steps_per_decode);
      at.velocity_x_mps = (at.last.x_m - before.x_m) / seconds;
      at.velocity_y_mps = (at.last.y_m - before.y_m) / seconds;
    }
    const Vector head = linear("head.modes", joined({&start, &state}));
    futures.score[k] = head[0];
    futures.yields[k] = sigmoid(head[1]);
  }
  const float largest = *std::max_element(futures.score, futures.score + shape_.modes);
  float total = 0.0F;
  for (int k = 0; k < shape_.modes; ++k) {
    futures.probability[k] = std::exp((futures.score[k] - largest) / temperature);
    total += futures.probability[k];
  }
  for (int k = 0; k < shape_.modes; ++k) futures.probability[k] /= total;
  return futures;
}

}  // namespace s4tp::train
