#include "algo/satp/decoder.hpp"

#include <cstring>

#include "algo/core/inline.hpp"
#include "algo/satp/embedding.hpp"
#include "algo/satp/gru_cell.hpp"
#include "algo/satp/kernels.hpp"
#include "algo/satp/lanes.hpp"
#include "algo/satp/linear.hpp"
#include "algo/satp/step_features.hpp"

namespace s4tp::satp {
namespace {

constexpr int kModes = kMcuShape.modes;
constexpr int kHeads = 2;  // score, log-odds of yielding
constexpr int kIncrementRows = 3 * kStepsPerDecode;
constexpr float kStepOfDecodeS = kStepS * static_cast<float>(kStepsPerDecode);
constexpr float kFarthestM = 250.0F;  // no vehicle comes this far in 3 s
static_assert(kModes <= kMaxBatch, "the modes of a vehicle go through the kernels together");

// GRU input of every mode: where it has come to, and our plan as far as the gate lets it in.
void mix_inputs(const Weights& weights, const Encoded& encoded, int hdv, const float (*plan)[kPlanValues],
                int step, const StepState (&states)[kModes], DecoderScratch& scratch) {
  auto& own_rows = scratch.own_rows;
  auto& plan_rows = scratch.plan_rows;
  auto& own = scratch.own;
  auto& ours = scratch.ours;
  for (int k = 0; k < kModes; ++k) {
    float features[kOwnFeatures];
    own_features(states[k], encoded.speed_mps[hdv], step, features);
    embed_features(features, kOwnUnit, own_rows[k]);
    if (plan == nullptr) continue;
    float seen[kPlanFeatures];
    plan_features(states[k], plan[step], encoded.pair[hdv], seen);
    embed_features(seen, kPlanUnit, plan_rows[k]);
  }
  linear_relu(weights.linear(kOwnEmbed), {own_rows[0], kOwnFeatures}, kModes,
              Rows<std::int16_t>{own[0], kEmbed});
  if (plan != nullptr) {
    linear_relu(weights.linear(kPlanEmbed), {plan_rows[0], kPlanFeatures}, kModes,
                Rows<std::int16_t>{ours[0], kEmbed});
  } else {
    const std::int32_t* null_plan = weights.words(kNullPlan);
    for (std::int16_t(&row)[kEmbed] : ours) {
      for (int c = 0; c < kEmbed; ++c) row[c] = static_cast<std::int16_t>(null_plan[c]);
    }
  }
  const std::int32_t multiplier = weights.words(kGruMix)[0];
  const std::int32_t gate = encoded.gate[hdv];
  for (int k = 0; k < kModes; ++k) lanes::mix(own[k], ours[k], gate, multiplier, kEmbed, scratch.inputs[k]);
}

// Increments are what the vehicle does beyond keeping its speed.
void advance(const float* increments, float speed_mps, StepState& state, Pose* poses) {
  const Pose before = state.last;
  for (int i = 0; i < kStepsPerDecode; ++i) {
    const float* increment = increments + 3 * i;
    state.last.x_m = clamp(state.last.x_m + (speed_mps * kStepS + increment[0]), -kFarthestM, kFarthestM);
    state.last.y_m = clamp(state.last.y_m + increment[1], -kFarthestM, kFarthestM);
    state.last.heading_rad = wrap_angle(state.last.heading_rad + clamp(increment[2], -1.0F, 1.0F));
    poses[i] = state.last;
  }
  state.velocity_x_mps = (state.last.x_m - before.x_m) / kStepOfDecodeS;
  state.velocity_y_mps = (state.last.y_m - before.y_m) / kStepOfDecodeS;
}

// Softmax over the modes' scores, the logistic function of their log-odds.
void weigh(const float (&heads)[kModes][kHeads], float temperature, Futures& futures) {
  float largest = heads[0][0];
  for (const float(&head)[kHeads] : heads) largest = max(largest, head[0]);
  float sum = 0.0F;
  for (int k = 0; k < kModes; ++k) {
    futures.probability[k] = exp((heads[k][0] - largest) / temperature);
    futures.yields[k] = 1.0F / (1.0F + exp(-heads[k][1]));
    sum += futures.probability[k];
  }
  for (float& value : futures.probability) value = value / sum;
}

}  // namespace

void decode(const Weights& weights, const Encoded& encoded, int hdv, const float (*plan)[kPlanValues],
            DecoderScratch& scratch, Futures& futures) {
  const GruCell cell = gru_at(weights);
  const Linear head = weights.linear(kIncrements);
  auto& states = scratch.states;
  auto& increments = scratch.increments;
  StepState steps[kModes];
  std::memcpy(states, encoded.start[hdv], sizeof states);
  for (StepState& step : steps) step.velocity_x_mps = encoded.speed_mps[hdv];
  for (int s = 0; s < kDecoderSteps; ++s) {
    mix_inputs(weights, encoded, hdv, plan, s, steps, scratch);
    gru_step(cell, scratch.inputs, kModes, scratch.gru, states);
    linear(head, {states[0], kHidden}, kModes, Rows<float>{increments[0], kIncrementRows});
    for (int k = 0; k < kModes; ++k)
      advance(increments[k], encoded.speed_mps[hdv], steps[k], &futures.poses[k][s * kStepsPerDecode]);
  }

  auto& ends = scratch.ends;
  float heads[kModes][kHeads];
  for (int k = 0; k < kModes; ++k) {
    std::memcpy(ends[k], encoded.start[hdv][k], sizeof states[k]);
    std::memcpy(ends[k] + kHidden, states[k], sizeof states[k]);
  }
  linear(weights.linear(kHeadModes), {ends[0], 2 * kHidden}, kModes, Rows<float>{heads[0], kHeads});
  weigh(heads, weights.header().temperature, futures);
}

}  // namespace s4tp::satp
