#pragma once
/// Masked multi-head attention with what follows it in a block: residual, LayerNorm, feed-forward, residual,
/// LayerNorm (docs/satp.md). Internal: for algo/satp's own sources.

#include <cstdint>

#include "algo/satp/kernels.hpp"
#include "algo/satp/linear.hpp"
#include "algo/satp/weight_image.hpp"

namespace s4tp::satp {

/// One block's layers.
struct Attention {
  Linear query, key, value, output, expand, contract;
  Norm norm_1, norm_2;
  std::int32_t score;         ///< multipliers
  std::int32_t add_1, add_2;  ///<
};

/// Room for one call of attend.
struct AttentionScratch {
  alignas(4) std::int8_t asked[kMaxBatch][kMcuShape.width];
  alignas(4) std::int8_t middle[kMaxBatch][kMcuShape.width];
  alignas(4) std::int8_t inner[kMaxBatch][kMcuShape.feed_forward];
  std::int16_t added[kMaxBatch][kMcuShape.width];
};

/// \param first  kEgoAttention, kAgent1, ...
[[nodiscard]] Attention attention_at(const Weights& weights, int first);

/// Keys and values of what can be looked at.
void project(const Attention& block, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> keys,
             Rows<std::int8_t> values);

/// Queries as the heads ask them.
void ask(const Attention& block, Rows<const std::int8_t> queries, int count, Rows<std::int8_t> asked);

/// What one query sees: means of the values, weighted by the softmax of query times key, head by head.
/// SATP-025 A key that is masked changes nothing, whatever it holds; with none left it sees 0.
/// \param mask  bit j: key j is there
void look(const Attention& block, const std::int8_t* asked, Rows<const std::int8_t> keys,
          Rows<const std::int8_t> values, int key_count, std::uint32_t mask, std::int8_t* seen);

/// The rest of the block. \param rows  what the queries saw; becomes the block's output
void finish(const Attention& block, Rows<const std::int8_t> queries, int count, AttentionScratch& scratch,
            Rows<std::int8_t> rows);

/// The whole block. \param queries  `count` of them, each looks at the same keys
/// \param outputs  may not be the queries
void attend(const Attention& block, Rows<const std::int8_t> queries, int count, Rows<const std::int8_t> keys,
            Rows<const std::int8_t> values, int key_count, std::uint32_t mask, AttentionScratch& scratch,
            Rows<std::int8_t> outputs);

}  // namespace s4tp::satp
