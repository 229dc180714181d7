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

// What a vehicle's past says of it, as of now. \param first  kEgoEmbed1 or kHdvEmbed1
void encode_history(const Weights& weights, int first,
                    const float (&history)[kHistorySamples][kHistoryFeatures], std::uint16_t valid,
                    EncoderScratch& scratch, std::int8_t* output) {
  static_assert(padded(kHistoryFeatures) <= kMaxFeatures);
  constexpr int kNow = kHistorySamples - 1;
  for (int j = 0; j < kHistorySamples; ++j) embed_features(history[j], kHistoryUnit, scratch.features[j]);
  linear_relu(weights.linear(first), {scratch.features[0], kMaxFeatures}, kHistorySamples,
              write(scratch.inner));
  linear_by_row(weights.linear(first + 1), read(scratch.inner), kHistorySamples, write(scratch.seen));
  const Attention block = attention_at(weights, first + 2);
  auto& values = scratch.inner;  // it has served
  project(block, read(scratch.seen), kHistorySamples, write(scratch.keys), write(values));
  attend(block, read(&scratch.seen[kNow]), 1, read(scratch.keys), read(values), kHistorySamples, valid,
         scratch.attention, {output, kWidth});
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

// One lane path as its vehicle sees it.
void encode_lane(const Weights& weights, const Attention& block,
                 const float (&points)[kLanePoints][kLaneFeatures], int count, const std::int8_t* query,
                 EncoderScratch& scratch, std::int8_t* output) {
  static_assert(padded(kLaneFeatures) <= kMaxFeatures);
  for (int p = 0; p < count; ++p) embed_features(points[p], kLaneUnit, scratch.features[p]);
  linear_relu(weights.linear(kMapPoint1), {scratch.features[0], kMaxFeatures}, count, write(scratch.inner));
  linear_relu(weights.linear(kMapPoint2), read(scratch.inner), count, write(scratch.seen));
  auto& values = scratch.inner;
  project(block, read(scratch.seen), count, write(scratch.keys), write(values));
  attend(block, {query, kWidth}, 1, read(scratch.keys), read(values), count, (1U << count) - 1U,
         scratch.attention, {output, kWidth});
}

// The lane paths a vehicle may take, weighed against each other.
void encode_map(const Weights& weights, const NetworkInput& input, int hdv, const std::int8_t* query,
                EncoderScratch& scratch, std::int8_t* output) {
  const Attention block = attention_at(weights, kLane);
  std::memset(scratch.lanes, 0, sizeof scratch.lanes);
  std::uint32_t mask = 0;
  for (int k = 0; k < kPathsPerAgent; ++k) {
    const int count = input.lane_points[hdv][k];
    if (count == 0) continue;
    mask |= 1U << k;
    encode_lane(weights, block, input.lane[hdv][k], count, query, scratch, scratch.lanes[k]);
  }
  const Attention route = attention_at(weights, kRoute);
  auto& values = scratch.inner;
  project(route, read(scratch.lanes), kPathsPerAgent, write(scratch.keys), write(values));
  attend(route, {query, kWidth}, 1, read(scratch.keys), read(values), kPathsPerAgent, mask, scratch.attention,
         {output, kWidth});
}

void encode_pair(const Weights& weights, const float (&pair)[kPairFeatures], std::int8_t* output) {
  alignas(4) std::int16_t features[kPairFeatures];
  alignas(4) std::int8_t inner[kWidth];
  embed_features(pair, kPairUnit, features);
  linear_relu(weights.linear(kPair1), {features, kPairFeatures}, 1, {inner, kWidth});
  linear_relu(weights.linear(kPair2), {inner, kWidth}, 1, Rows<std::int8_t>{output, kWidth});
}

// How strongly our plan enters the vehicle's futures.
std::int16_t interaction_gate(const Weights& weights, const std::int8_t* ours, const std::int8_t* theirs,
                              const std::int8_t* pair) {
  alignas(4) std::int8_t input[kScene];
  alignas(4) std::int8_t inner[kWidth];
  std::int16_t argument = 0;
  std::memcpy(input, ours, kWidth);
  std::memcpy(input + kWidth, theirs, kWidth);
  std::memcpy(input + 2 * kWidth, pair, kWidth);
  linear_relu(weights.linear(kGate1), {input, kScene}, 1, {inner, kWidth});
  linear(weights.linear(kGate2), {inner, kWidth}, 1, Rows<std::int16_t>{&argument, 1});
  return sigmoid_q15(argument);
}

}  // namespace

void encode(const Weights& weights, const NetworkInput& input, EncoderScratch& scratch, Encoded& encoded) {
  const int agents = 1 + input.hdvs;
  encode_history(weights, kEgoEmbed1, input.ego_history, input.ego_history_valid, scratch,
                 scratch.histories[0]);
  for (int i = 0; i < input.hdvs; ++i) {
    encode_history(weights, kHdvEmbed1, input.history[i], input.history_valid[i], scratch,
                   scratch.histories[1 + i]);
  }
  add_places(weights, input, agents, scratch);
  mix_agents(weights, agents, scratch);

  encoded.hdvs = input.hdvs;
  for (int i = 0; i < input.hdvs; ++i) {
    alignas(4) std::int8_t scene[kScene];
    const std::int8_t* mixed = scratch.mixed[1 + i];
    std::memcpy(scene, mixed, kWidth);
    encode_map(weights, input, i, mixed, scratch, scene + kWidth);
    encode_pair(weights, input.pair[i], scene + 2 * kWidth);
    encoded.gate[i] =
        interaction_gate(weights, scratch.histories[0], scratch.histories[1 + i], scene + 2 * kWidth);
    linear_by_bias(weights.linear(kStart), scene, kMcuShape.modes,
                   Rows<std::int16_t>{encoded.start[i][0], kMcuShape.hidden});
    for (std::int16_t(&start)[kMcuShape.hidden] : encoded.start[i]) tanh_q15(start, kMcuShape.hidden);
    encoded.speed_mps[i] = input.speed_mps[i];
    encoded.anchor[i] = input.anchor[i];
    std::memcpy(encoded.pair[i], input.pair[i], sizeof encoded.pair[i]);
  }
}

}  // namespace s4tp::satp
