#pragma once
/// Every tensor of the network in one table, for all its sizes (docs/satp.md has the equations).
///
/// Names are those of the training's modules; the order is that of the weight image.

#include <cstdint>

#include "algo/satp/network_input.hpp"

namespace s4tp::satp {

/// One size of the network.
struct NetworkShape {
  std::uint8_t id;            ///< in the weight image
  std::int16_t width;         ///< d, of every feature
  std::int16_t heads;         ///< of every attention; divides the width
  std::int16_t feed_forward;  ///< inner width of an attention block's second half
  std::int16_t hidden;        ///< of the GRU
  std::int16_t embed;         ///< of its input
  std::int16_t modes;         ///< K
  std::int16_t lane_points;   ///< of one lane path
  std::int16_t decoder_steps;
  std::int16_t steps_per_decode;  ///< pose increments a decoder step emits
};

inline constexpr NetworkShape kMcuShape = {1,  32,        4,           128,           48,
                                           32, kMaxModes, kLanePoints, kDecoderSteps, kStepsPerDecode};
inline constexpr NetworkShape kTeacherShape = {2,  64,        8,           256,           96,
                                               64, kMaxModes, kLanePoints, kDecoderSteps, kStepsPerDecode};
/// The published size; its crosswalk channel and ego head are the trainer's and never leave the host.
inline constexpr NetworkShape kFullShape = {3, 128, 8, 512, 128, 128, kMaxModes, 51, kHorizonSteps, 1};

/// How a layer's numbers are kept.
enum class LayerKind : std::uint8_t {
  kLinear,     ///< bias int32 [bias_rows][rows], multiplier int32 or scale float [rows], weights int8
               ///< [rows][stride]
  kLayerNorm,  ///< bias int32 [rows], gain int32 [rows]
  kAdd,        ///< multiplier int32 of each addend that needs one [rows]
  kScores,     ///< multiplier int32 [1] from a product of query and key to the softmax's argument
  kVector,     ///< int32 [rows]
};

/// How values stand between layers.
enum class Format : std::uint8_t {
  kNone,
  kInt8,       ///< symmetric
  kInt8Relu,   ///< never negative: value = scale * (q + 128)
  kInt16,      ///< symmetric, scale of the image's own choice
  kInt16Relu,  ///< the same, never negative
  kQ12,        ///< int16 in 2^-12: argument of a sigmoid or tanh
  kQ13,        ///< int16 in 2^-13: an input divided by its unit
  kQ15,        ///< int16 in 2^-15: hidden states
  kReal,       ///< float
};

struct LayerInfo {
  const char* name;
  LayerKind kind;
  std::int16_t rows;       ///< outputs
  std::int16_t columns;    ///< inputs
  std::int16_t bias_rows;  ///< > 1: position or mode, chosen by the caller
  Format input;
  Format output;
};

/// Rows of the table. An attention block is kBlockLayers of them from its first on.
enum Layer : std::uint8_t {
  kQuery = 0,  // offsets within a block
  kKey,
  kValue,
  kScore,
  kOutput,
  kAdd1,
  kNorm1,
  kExpand,
  kContract,
  kAdd2,
  kNorm2,
  kBlockLayers,

  kEgoEmbed1 = 0,
  kEgoEmbed2,
  kEgoAttention,
  kHdvEmbed1 = kEgoAttention + kBlockLayers,
  kHdvEmbed2,
  kHdvAttention,
  kPlaceEmbed = kHdvAttention + kBlockLayers,
  kTokenAdd,
  kAgent1,
  kAgent2Input = kAgent1 + kBlockLayers,
  kAgent2,
  kMapPoint1 = kAgent2 + kBlockLayers,
  kMapPoint2,
  kLane,
  kRoute = kLane + kBlockLayers,
  kPair1 = kRoute + kBlockLayers,
  kPair2,
  kGate1,
  kGate2,
  kStart,
  kOwnEmbed,
  kPlanEmbed,
  kNullPlan,
  kGruMix,
  kGruGates,
  kGruFromInput,
  kGruState,
  kIncrements,
  kHeadModes,
  kLayerCount,
};

/// \pre 0 <= index < kLayerCount
[[nodiscard]] constexpr LayerInfo layer_info(const NetworkShape& shape, int index);

/// Bytes between rows of a linear layer's weights: columns, filled up with zeros to a multiple of 4.
[[nodiscard]] constexpr int row_stride(const LayerInfo& info) {
  return (info.columns + 3) / 4 * 4;
}

/// Bytes of a layer in the image, a multiple of 4.
[[nodiscard]] constexpr int layer_bytes(const LayerInfo& info) {
  switch (info.kind) {
    case LayerKind::kLinear:
      return 4 * info.rows * (info.bias_rows + 1) + info.rows * row_stride(info);
    case LayerKind::kLayerNorm:
      return 8 * info.rows;
    case LayerKind::kVector:
    case LayerKind::kAdd:
    case LayerKind::kScores:
      break;
  }
  return 4 * info.rows;
}

/// Where a layer begins in the payload.
[[nodiscard]] constexpr int layer_offset(const NetworkShape& shape, int index) {
  int offset = 0;
  for (int i = 0; i < index; ++i) offset += layer_bytes(layer_info(shape, i));
  return offset;
}

[[nodiscard]] constexpr int payload_bytes(const NetworkShape& shape) {
  return layer_offset(shape, kLayerCount);
}

namespace detail {

// Sizes a row of the table is made of.
enum class Size : std::uint8_t {
  kOne,
  kTwo,
  kWidth,
  kThreeWidths,
  kFeedForward,
  kHidden,
  kTwoHidden,
  kEmbed,
  kGateInput,
  kModes,
  kIncrements,
  kHistory,
  kSamples,
  kPlace,
  kPoint,
  kPair,
  kOwn,
  kPlan
};

constexpr int size_of(const NetworkShape& shape, Size size) {
  switch (size) {
    case Size::kOne:
      return 1;
    case Size::kTwo:
      return 2;
    case Size::kWidth:
      return shape.width;
    case Size::kThreeWidths:
      return 3 * shape.width;
    case Size::kFeedForward:
      return shape.feed_forward;
    case Size::kHidden:
      return shape.hidden;
    case Size::kTwoHidden:
      return 2 * shape.hidden;
    case Size::kEmbed:
      return shape.embed;
    case Size::kGateInput:
      return shape.embed + shape.hidden;
    case Size::kModes:
      return shape.modes;
    case Size::kIncrements:
      return 3 * shape.steps_per_decode;
    case Size::kHistory:
      return kHistoryFeatures;
    case Size::kSamples:
      return kHistorySamples;
    case Size::kPlace:
      return kPlaceFeatures;
    case Size::kPoint:
      return kLaneFeatures;
    case Size::kPair:
      return kPairFeatures;
    case Size::kOwn:
      return kOwnFeatures;
    case Size::kPlan:
      break;
  }
  return kPlanFeatures;
}

struct Row {
  const char* name;
  LayerKind kind;
  Size rows;
  Size columns;
  Size bias_rows;
  Format input;
  Format output;
};

#define S4TP_LINEAR(name, rows, columns, input, output) \
  { name, LayerKind::kLinear, Size::rows, Size::columns, Size::kOne, Format::input, Format::output }
#define S4TP_OTHER(name, kind, rows, output) \
  { name, LayerKind::kind, Size::rows, Size::kOne, Size::kOne, Format::kNone, Format::output }
#define S4TP_BLOCK(name)                                                                                    \
  S4TP_LINEAR(name ".query", kWidth, kWidth, kInt8, kInt8),                                                 \
      S4TP_LINEAR(name ".key", kWidth, kWidth, kInt8, kInt8),                                               \
      S4TP_LINEAR(name ".value", kWidth, kWidth, kInt8, kInt8),                                             \
      S4TP_OTHER(name ".score", kScores, kOne, kNone),                                                      \
      S4TP_LINEAR(name ".output", kWidth, kWidth, kInt8, kInt16),                                           \
      S4TP_OTHER(name ".add_1", kAdd, kOne, kInt16), S4TP_OTHER(name ".norm_1", kLayerNorm, kWidth, kInt8), \
      S4TP_LINEAR(name ".expand", kFeedForward, kWidth, kInt8, kInt8Relu),                                  \
      S4TP_LINEAR(name ".contract", kWidth, kFeedForward, kInt8Relu, kInt16),                               \
      S4TP_OTHER(name ".add_2", kAdd, kOne, kInt16), S4TP_OTHER(name ".norm_2", kLayerNorm, kWidth, kInt8)

inline constexpr Row kRows[] = {
    S4TP_LINEAR("ego_history.embed_1", kWidth, kHistory, kQ13, kInt8Relu),
    {"ego_history.embed_2", LayerKind::kLinear, Size::kWidth, Size::kWidth, Size::kSamples, Format::kInt8Relu,
     Format::kInt8},
    S4TP_BLOCK("ego_history.attention"),
    S4TP_LINEAR("hdv_history.embed_1", kWidth, kHistory, kQ13, kInt8Relu),
    {"hdv_history.embed_2", LayerKind::kLinear, Size::kWidth, Size::kWidth, Size::kSamples, Format::kInt8Relu,
     Format::kInt8},
    S4TP_BLOCK("hdv_history.attention"),
    S4TP_LINEAR("place.embed", kWidth, kPlace, kQ13, kInt16),
    S4TP_OTHER("token.add", kAdd, kOne, kInt8),
    S4TP_BLOCK("agent_1"),
    S4TP_OTHER("agent_2.input", kAdd, kTwo, kInt8),
    S4TP_BLOCK("agent_2"),
    S4TP_LINEAR("map.point_1", kWidth, kPoint, kQ13, kInt8Relu),
    S4TP_LINEAR("map.point_2", kWidth, kWidth, kInt8Relu, kInt8Relu),
    S4TP_BLOCK("lane"),
    S4TP_BLOCK("route"),
    S4TP_LINEAR("pair.pair_1", kWidth, kPair, kQ13, kInt8Relu),
    S4TP_LINEAR("pair.pair_2", kWidth, kWidth, kInt8Relu, kInt8Relu),
    S4TP_LINEAR("gate.gate_1", kWidth, kThreeWidths, kInt8, kInt8Relu),
    S4TP_LINEAR("gate.gate_2", kOne, kWidth, kInt8Relu, kQ12),
    {"start.state", LayerKind::kLinear, Size::kHidden, Size::kThreeWidths, Size::kModes, Format::kInt8,
     Format::kQ12},
    S4TP_LINEAR("own.embed", kEmbed, kOwn, kQ13, kInt16Relu),
    S4TP_LINEAR("plan.embed", kEmbed, kPlan, kQ13, kInt16Relu),
    S4TP_OTHER("null_plan", kVector, kEmbed, kInt16Relu),
    S4TP_OTHER("gru.mix", kAdd, kOne, kInt8Relu),
    S4TP_LINEAR("gru.gates", kTwoHidden, kGateInput, kInt8, kQ12),
    S4TP_LINEAR("gru.input", kHidden, kEmbed, kInt8Relu, kQ12),
    S4TP_LINEAR("gru.state", kHidden, kHidden, kInt8, kQ12),
    S4TP_LINEAR("head.increments", kIncrements, kHidden, kQ15, kReal),
    S4TP_LINEAR("head.modes", kTwo, kTwoHidden, kQ15, kReal),
};
static_assert(sizeof(kRows) / sizeof(kRows[0]) == kLayerCount, "one row for each of enum Layer");

#undef S4TP_BLOCK
#undef S4TP_OTHER
#undef S4TP_LINEAR

}  // namespace detail

constexpr LayerInfo layer_info(const NetworkShape& shape, int index) {
  const detail::Row& row = detail::kRows[index];
  return {row.name,
          row.kind,
          static_cast<std::int16_t>(detail::size_of(shape, row.rows)),
          static_cast<std::int16_t>(detail::size_of(shape, row.columns)),
          static_cast<std::int16_t>(detail::size_of(shape, row.bias_rows)),
          row.input,
          row.output};
}

/// Flash for one bank of weights. SATP-003 The deployed size fits, header included.
inline constexpr int kWeightBudgetBytes = 144 * 1024;

}  // namespace s4tp::satp
