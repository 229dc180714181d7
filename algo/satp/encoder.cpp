#include "algo/satp/encoder.hpp"

#include <cstring>

#include "algo/satp/activation.hpp"
#include "algo/satp/attention.hpp"
#include "algo/satp/embedding.hpp"
#include "algo/satp/linear.hpp"
#include "algo/satp/requantize.hpp"
#include "algo/satp/softmax.hpp"

namespace s4tp::satp {
namespace {

constexpr int kWidth = kMcuShape.width;
constexpr int kAgents = EncoderScratch::kAgents;
constexpr int kScene = 3 * kWidth;
static_assert(kLanePoints <= kMaxKeys && kHistorySamples <= kLanePoints && kAgents <= kMaxKeys,
              "all are keys");

Rows<const std::int8_t> read(const std::int8_t (*rows)[kWidth]) {
  return {rows[0], kWidth};
}
Rows<std::int8_t> write(std::int8_t (*rows)[kWidth]) {
  return {rows[0], kWidth};
}

// 64 units of a sum are one of an int8 activation.
std::int8_t narrow(std::int32_t sum) {
  return static_cast<std::int8_t>(saturate8((sum + 32) >> 6));
}

// What a vehicle's samples say of it, as it is now. \param now  the newest sample's row
void look_back(const Weights& weights, int first, const Attention& block,
               const float (&history)[kHistorySamples][kHistoryFeatures], std::uint16_t valid,
               EncoderScratch& scratch, std::int8_t* now, std::int8_t* seen) {
  static_assert(padded(kHistoryFeatures) <= kMaxFeatures);
  for (int j = 0; j < kHistorySamples; ++j) embed_features(history[j], kHistoryUnit, scratch.features[j]);
  linear_relu(weights.linear(first), {scratch.features[0], kMaxFeatures}, kHistorySamples,
              write(scratch.inner));
  linear_by_row(weights.linear(first + 1), read(scratch.inner), kHistorySamples, write(scratch.seen));
  auto& values = scratch.inner;  // it has served
  project(block, read(scratch.seen), kHistorySamples, write(scratch.keys), write(values));
  std::memcpy(now, scratch.seen[kHistorySamples - 1], kWidth);
  alignas(4) std::int8_t asked[kWidth];
  ask(block, {now, kWidth}, 1, {asked, kWidth});
  look(block, asked, read(scratch.keys), read(values), kHistorySamples, valid, seen);
}

// Each vehicle's past; ours has weights of its own.
void encode_histories(const Weights& weights, const NetworkInput& input, EncoderScratch& scratch) {
  auto& now = scratch.second;  // not needed yet
  auto& histories = scratch.histories;
  const Attention ours = attention_at(weights, kEgoAttention);
  look_back(weights, kEgoEmbed1, ours, input.ego_history, input.ego_history_valid, scratch, now[0],
            histories[0]);
  finish(ours, read(now), 1, scratch.attention, write(histories));
  const Attention theirs = attention_at(weights, kHdvAttention);
  for (int i = 0; i < input.hdvs; ++i) {
    look_back(weights, kHdvEmbed1, theirs, input.history[i], input.history_valid[i], scratch, now[1 + i],
              histories[1 + i]);
  }
  finish(theirs, read(now + 1), input.hdvs, scratch.attention, write(histories + 1));
}

// Who is where around us enters here: histories are told in frames of their own.
void add_places(const Weights& weights, const NetworkInput& input, int agents, EncoderScratch& scratch) {
  static_assert(padded(kPlaceFeatures) <= kMaxFeatures);
  for (int a = 0; a < agents; ++a) embed_features(input.place[a], kPlaceUnit, scratch.features[a]);
  linear(weights.linear(kPlaceEmbed), {scratch.features[0], kMaxFeatures}, agents,
         Rows<std::int16_t>{scratch.places[0], kWidth});
  const std::int32_t multiplier = weights.words(kTokenAdd)[0];
  for (int a = 0; a < agents; ++a) {
    for (int c = 0; c < kWidth; ++c) {
      const std::int32_t history = requantize(scratch.histories[a][c], multiplier);
      scratch.tokens[a][c] = narrow(history + scratch.places[a][c]);
    }
  }
}

void look_around(const Attention& block, int agents, const EncoderScratch::Features& tokens,
                 EncoderScratch& scratch, EncoderScratch::Features& outputs) {
  project(block, read(tokens), agents, write(scratch.agent_keys), write(scratch.agent_values));
  attend(block, read(tokens), agents, read(scratch.agent_keys), read(scratch.agent_values), agents,
         (1U << agents) - 1U, scratch.attention, write(outputs));
}

// Agents look at each other twice; the second time at what the first look added to them.
void mix_agents(const Weights& weights, int agents, EncoderScratch& scratch) {
  look_around(attention_at(weights, kAgent1), agents, scratch.tokens, scratch, scratch.second);
  const std::int32_t* multipliers = weights.words(kAgent2Input);
  for (int a = 0; a < agents; ++a) {
    for (int c = 0; c < kWidth; ++c) {
      scratch.second[a][c] = narrow(requantize(scratch.tokens[a][c], multipliers[0]) +
                                    requantize(scratch.second[a][c], multipliers[1]));
    }
  }
  look_around(attention_at(weights, kAgent2), agents, scratch.second, scratch, scratch.mixed);
}

// One lane path as its vehicle sees it, before the rest of the block.
void attend_lanes(const Weights& weights, const Attention& block,
                  const float (&points)[kLanePoints][kLaneFeatures], int count, const std::int8_t* asked,
                  EncoderScratch& scratch, std::int8_t* seen) {
  static_assert(padded(kLaneFeatures) <= kMaxFeatures);
  for (int p = 0; p < count; ++p) embed_features(points[p], kLaneUnit, scratch.features[p]);
  linear_relu(weights.linear(kMapPoint1), {scratch.features[0], kMaxFeatures}, count, write(scratch.inner));
  linear_relu(weights.linear(kMapPoint2), read(scratch.inner), count, write(scratch.seen));
  auto& values = scratch.inner;
  project(block, read(scratch.seen), count, write(scratch.keys), write(values));
  look(block, asked, read(scratch.keys), read(values), count, (1U << count) - 1U, seen);
}

// The lane paths each vehicle may take, weighed against each other. \param outputs  a row each
void encode_maps(const Weights& weights, const NetworkInput& input, EncoderScratch& scratch,
                 std::int8_t (*outputs)[kWidth]) {
  const Attention lane = attention_at(weights, kLane);
  const Attention route = attention_at(weights, kRoute);
  const auto* vehicles = scratch.mixed + 1;
  auto& asked_of_lanes = scratch.agent_keys;  // these two have served
  auto& asked_of_routes = scratch.agent_values;
  ask(lane, read(vehicles), input.hdvs, write(asked_of_lanes));
  ask(route, read(vehicles), input.hdvs, write(asked_of_routes));
  for (int i = 0; i < input.hdvs; ++i) {
    std::uint32_t mask = 0;
    for (int k = 0; k < kPathsPerAgent; ++k) {
      const int count = input.lane_points[i][k];
      if (count == 0) continue;
      mask |= 1U << k;
      attend_lanes(weights, lane, input.lane[i][k], count, asked_of_lanes[i], scratch, scratch.lanes[k]);
    }
    finish(lane, {vehicles[i], 0}, kPathsPerAgent, scratch.attention, write(scratch.lanes));
    for (int k = 0; k < kPathsPerAgent; ++k) {
      if ((mask >> k & 1U) == 0U) std::memset(scratch.lanes[k], 0, kWidth);
    }
    auto& values = scratch.inner;
    project(route, read(scratch.lanes), kPathsPerAgent, write(scratch.keys), write(values));
    look(route, asked_of_routes[i], read(scratch.keys), read(values), kPathsPerAgent, mask, outputs[i]);
  }
  finish(route, read(vehicles), input.hdvs, scratch.attention, write(outputs));
}

// How at most kMaxBatch vehicles and we stand to each other. \param pairs  NetworkInput::pair
void encode_pairs(const Weights& weights, const float (*pairs)[kPairFeatures], int count,
                  std::int8_t (*outputs)[kWidth]) {
  alignas(4) std::int16_t features[kMaxBatch][kPairFeatures];
  alignas(4) std::int8_t inner[kMaxBatch][kWidth];
  for (int i = 0; i < count; ++i) embed_features(pairs[i], kPairUnit, features[i]);
  linear_relu(weights.linear(kPair1), {features[0], kPairFeatures}, count, write(inner));
  linear_relu(weights.linear(kPair2), read(inner), count, write(outputs));
}

// Three parts side by side.
void join(const std::int8_t* first, const std::int8_t* second, const std::int8_t* third,
          std::int8_t* output) {
  std::memcpy(output, first, kWidth);
  std::memcpy(output + kWidth, second, kWidth);
  std::memcpy(output + 2 * kWidth, third, kWidth);
}

// How strongly our plan enters the vehicles' futures. \param inputs  our history, theirs, pair \param shares
// NetworkInput::paths_meet
void interaction_gates(const Weights& weights, Rows<const std::int8_t> inputs, const std::uint8_t* shares,
                       int count, std::int16_t* gates) {
  alignas(4) std::int8_t inner[kMaxBatch][kWidth];
  linear_relu(weights.linear(kGate1), inputs, count, write(inner));
  linear(weights.linear(kGate2), read(inner), count, Rows<std::int16_t>{gates, 1});
  for (int i = 0; i < count; ++i) gates[i] = shares[i] != 0 ? sigmoid_q15(gates[i]) : std::int16_t{0};
}

// States and gates of at most kMaxBatch vehicles, from `first` on.
void start(const Weights& weights, const NetworkInput& input, int first, int count,
           const std::int8_t (*maps)[kWidth], const EncoderScratch& scratch, Encoded& encoded) {
  alignas(4) std::int8_t pairs[kMaxBatch][kWidth];
  alignas(4) std::int8_t joined[kMaxBatch][kScene];
  const Rows<const std::int8_t> scenes{joined[0], kScene};
  encode_pairs(weights, input.pair + first, count, pairs);
  for (int i = 0; i < count; ++i)
    join(scratch.histories[0], scratch.histories[1 + first + i], pairs[i], joined[i]);
  interaction_gates(weights, scenes, input.paths_meet + first, count, encoded.gate + first);
  for (int i = 0; i < count; ++i) join(scratch.mixed[1 + first + i], maps[first + i], pairs[i], joined[i]);
  auto& states = encoded.start[first];
  constexpr int kStates = kMcuShape.modes * kMcuShape.hidden;
  linear_by_bias(weights.linear(kStart), scenes, count, kMcuShape.modes,
                 Rows<std::int16_t>{states[0], kMcuShape.hidden});
  tanh_q15(states[0], count * kStates);
}

}  // namespace

void encode(const Weights& weights, const NetworkInput& input, EncoderScratch& scratch, Encoded& encoded) {
  const int agents = 1 + input.hdvs;
  encode_histories(weights, input, scratch);
  add_places(weights, input, agents, scratch);
  mix_agents(weights, agents, scratch);

  auto& maps = scratch.tokens;  // they have served
  encode_maps(weights, input, scratch, maps);

  encoded.hdvs = input.hdvs;
  for (int i = 0; i < input.hdvs; i += kMaxBatch) {
    const int count = input.hdvs - i < kMaxBatch ? input.hdvs - i : kMaxBatch;
    start(weights, input, i, count, maps, scratch, encoded);
  }
  for (int i = 0; i < input.hdvs; ++i) {
    encoded.speed_mps[i] = input.speed_mps[i];
    encoded.anchor[i] = input.anchor[i];
    std::memcpy(encoded.pair[i], input.pair[i], sizeof encoded.pair[i]);
  }
}

}  // namespace s4tp::satp
