#include "algo/satp/linear.hpp"

#include <cstring>

#include "algo/satp/kernels.hpp"
#include "algo/satp/requantize.hpp"

namespace s4tp::satp {
namespace {

std::int32_t rescale(const std::int8_t* /*input*/, std::int32_t sum, std::int32_t multiplier) {
  return requantize(sum, multiplier);
}

std::int32_t rescale(const std::int16_t* /*input*/, std::int32_t sum, std::int32_t multiplier) {
  return requantize_wide(sum, multiplier);
}

struct Signed8 {
  using Type = std::int8_t;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate8(q)); }
};

struct Relu8 {
  using Type = std::int8_t;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate_unsigned8(q) - 128); }
};

struct Signed16 {
  using Type = std::int16_t;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate16(q)); }
};

struct Relu16 {
  using Type = std::int16_t;
  static Type of(std::int32_t q) { return static_cast<Type>(saturate16(q < 0 ? 0 : q)); }
};

// Outputs are made in groups of kMaxRows, so that their sums need little of the stack.
template <typename Emit, typename In>
void sum_up(const Linear& layer, int bias_stride, Rows<const In> inputs, int count, const Emit& emit) {
  std::int32_t sums[kMaxBatch][kMaxRows];
  for (int done = 0; done < count; done += kMaxBatch) {
    const int batch = count - done < kMaxBatch ? count - done : kMaxBatch;
    for (int from = 0; from < layer.rows; from += kMaxRows) {
      Linear group = layer;
      group.weights += from * layer.stride;
      group.rows = static_cast<std::int16_t>(layer.rows - from < kMaxRows ? layer.rows - from : kMaxRows);
      const std::int32_t* bias = layer.bias + done * bias_stride + from;
      multiply(group, bias, bias_stride, inputs[done], inputs.stride, batch, sums);
      for (int b = 0; b < batch; ++b) emit(done + b, from, group.rows, sums[b]);
    }
  }
}

template <typename Output, typename In>
void run(const Linear& layer, int bias_stride, Rows<const In> inputs, int count,
         Rows<typename Output::Type> outputs) {
  sum_up(layer, bias_stride, inputs, count, [&](int row, int from, int rows, const std::int32_t* sums) {
    typename Output::Type* output = outputs[row] + from;
    const std::int32_t* multiplier = layer.multiplier + from;
    for (int o = 0; o < rows; ++o) output[o] = Output::of(rescale(inputs.data, sums[o], multiplier[o]));
  });
}

}  // namespace

void linear(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> outputs) {
  run<Signed8>(layer, 0, inputs, count, outputs);
}

void linear_relu(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> outputs) {
  run<Relu8>(layer, 0, inputs, count, outputs);
}

void linear_relu(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<std::int8_t> outputs) {
  run<Relu8>(layer, 0, inputs, count, outputs);
}

void linear(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int16_t> outputs) {
  run<Signed16>(layer, 0, inputs, count, outputs);
}

void linear(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<std::int16_t> outputs) {
  run<Signed16>(layer, 0, inputs, count, outputs);
}

void linear_relu(const Linear& layer, Rows<const std::int16_t> inputs, int count,
                 Rows<std::int16_t> outputs) {
  run<Relu16>(layer, 0, inputs, count, outputs);
}

void linear_by_row(const Linear& layer, Rows<const std::int8_t> inputs, int count,
                   Rows<std::int8_t> outputs) {
  run<Signed8>(layer, layer.rows, inputs, count, outputs);
}

void linear_by_bias(const Linear& layer, const std::int8_t* input, int bias_rows,
                    Rows<std::int16_t> outputs) {
  std::int32_t sums[kMaxBatch][kMaxRows];
  multiply(layer, layer.bias, 0, input, 0, 1, sums);
  for (int k = 0; k < bias_rows; ++k) {
    const std::int32_t* bias = layer.bias + k * layer.rows;
    for (int o = 0; o < layer.rows; ++o) {
      const std::int32_t sum = sums[0][o] + (bias[o] - layer.bias[o]);
      outputs[k][o] = Signed16::of(requantize(sum, layer.multiplier[o]));
    }
  }
}

void linear(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<float> outputs) {
  sum_up(layer, 0, inputs, count, [&](int row, int from, int rows, const std::int32_t* sums) {
    for (int o = 0; o < rows; ++o) {
      float scale = 0.0F;
      std::memcpy(&scale, &layer.multiplier[from + o], sizeof scale);
      outputs[row][from + o] = scale * static_cast<float>(sums[o]);
    }
  });
}

}  // namespace s4tp::satp
