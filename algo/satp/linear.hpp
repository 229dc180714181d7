#pragma once
/// Linear layers with what follows them: y = requantize(bias + W x), saturated, ReLU where the name says so.
/// SATP-021 Whatever the input, outputs saturate at the ends of int8 and int16. Internal: for algo/satp's own
/// sources.
///
/// Inputs and outputs are rows of `stride` elements, 4-byte aligned; `count` of them, any number. `bias` is
/// the layer's, or one of its rows.

#include <cstdint>

#include "algo/satp/rows.hpp"
#include "algo/satp/weight_image.hpp"

namespace s4tp::satp {

void linear(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> outputs);
void linear_relu(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> outputs);
void linear_relu(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<std::int8_t> outputs);
/// int16 outputs, of int8 or int16 inputs.
void linear(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int16_t> outputs);
void linear(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<std::int16_t> outputs);
void linear_relu(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<std::int16_t> outputs);
/// Each row with a bias of its own: row i of the table is that of input i.
void linear_by_row(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> outputs);
/// Every input with every row of the bias table: row i * bias_rows + k of the outputs is that of input i and
/// bias row k. \pre count <= kMaxBatch, layer.rows <= kMaxRows
void linear_by_bias(const Linear& layer, Rows<const std::int8_t> inputs, int count, int bias_rows,
                    Rows<std::int16_t> outputs);
/// Real numbers: sums times the layer's scales.
void linear(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<float> outputs);

}  // namespace s4tp::satp
