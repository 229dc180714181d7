#include "algo/satp/attention.hpp"

#include "algo/satp/lanes.hpp"
#include "algo/satp/layer_norm.hpp"
#include "algo/satp/softmax.hpp"

namespace s4tp::satp {
namespace {

constexpr int kWidth = kMcuShape.width;
constexpr int kHeads = kMcuShape.heads;
constexpr int kInner = kMcuShape.feed_forward;

// To the nearest, halves away from zero.
std::int32_t quotient(std::int32_t dividend, std::int32_t divisor) {
  const std::int32_t half = divisor / 2;
  return (dividend < 0 ? dividend - half : dividend + half) / divisor;
}

// The sum of a layer's output and what it goes around, normalized.
void add_and_norm(const std::int8_t* residual, std::int32_t multiplier, const std::int16_t* addend,
                  const Norm& norm, std::int8_t* output) {
  std::int32_t sums[kWidth];
  lanes::add_rescaled(residual, multiplier, addend, kWidth, sums);
  layer_norm(norm, sums, output);
}

}  // namespace

Attention attention_at(const Weights& weights, int first) {
  return {weights.linear(first + kQuery),  weights.linear(first + kKey),    weights.linear(first + kValue),
          weights.linear(first + kOutput), weights.linear(first + kExpand), weights.linear(first + kContract),
          weights.norm(first + kNorm1),    weights.norm(first + kNorm2),    weights.words(first + kScore)[0],
          weights.words(first + kAdd1)[0], weights.words(first + kAdd2)[0]};
}

void project(const Attention& block, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> keys,
             Rows<std::int8_t> values) {
  linear(block.key, inputs, count, keys);
  linear(block.value, inputs, count, values);
}

void ask(const Attention& block, Rows<const std::int8_t> queries, int count, Rows<std::int8_t> asked) {
  linear(block.query, queries, count, asked);
}

void look(const Attention& block, const std::int8_t* asked, Rows<const std::int8_t> keys,
          Rows<const std::int8_t> values, int key_count, std::uint32_t mask, std::int8_t* seen) {
  for (int head = 0; head < kHeads; ++head) {
    const int from = head * kHeadWidth;
    std::int32_t scores[kMaxKeys];
    lanes::score(asked + from, {keys.data + from, keys.stride}, key_count, scores);
    std::int32_t weights[kMaxKeys];
    const std::int32_t sum = softmax(scores, key_count, mask, block.score, weights);
    std::int32_t sums[kHeadWidth];
    lanes::weigh(weights, {values.data + from, values.stride}, key_count, sums);
    for (int c = 0; c < kHeadWidth; ++c)
      seen[from + c] = sum == 0 ? std::int8_t{0} : static_cast<std::int8_t>(quotient(sums[c], sum));
  }
}

void finish(const Attention& block, Rows<const std::int8_t> queries, int count, AttentionScratch& scratch,
            Rows<std::int8_t> rows) {
  auto& [asked, middle, inner, added] = scratch;
  for (int done = 0; done < count; done += kMaxBatch) {
    const int batch = count - done < kMaxBatch ? count - done : kMaxBatch;
    const Rows<std::int8_t> these{rows[done], rows.stride};
    linear(block.output, {these.data, these.stride}, batch, Rows<std::int16_t>{added[0], kWidth});
    for (int b = 0; b < batch; ++b)
      add_and_norm(queries[done + b], block.add_1, added[b], block.norm_1, middle[b]);
    linear_relu(block.expand, {middle[0], kWidth}, batch, {inner[0], kInner});
    linear(block.contract, {inner[0], kInner}, batch, Rows<std::int16_t>{added[0], kWidth});
    for (int b = 0; b < batch; ++b) add_and_norm(middle[b], block.add_2, added[b], block.norm_2, these[b]);
  }
}

void attend(const Attention& block, Rows<const std::int8_t> queries, int count, Rows<const std::int8_t> keys,
            Rows<const std::int8_t> values, int key_count, std::uint32_t mask, AttentionScratch& scratch,
            Rows<std::int8_t> outputs) {
  for (int done = 0; done < count; done += kMaxBatch) {
    const int batch = count - done < kMaxBatch ? count - done : kMaxBatch;
    ask(block, {queries[done], queries.stride}, batch, {scratch.asked[0], kWidth});
    for (int b = 0; b < batch; ++b)
      look(block, scratch.asked[b], keys, values, key_count, mask, outputs[done + b]);
  }
  finish(block, queries, count, scratch, outputs);
}

}  // namespace s4tp::satp
