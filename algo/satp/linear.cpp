#include "algo/satp/linear.hpp"

#include "algo/satp/kernels.hpp"
#include "algo/satp/output.hpp"

#if defined(__ARM_FEATURE_MVE) && (__ARM_FEATURE_MVE & 1)
#include "algo/satp/kernel_mve.hpp"
#elif defined(__ARM_FEATURE_DSP) && defined(__thumb__)
#include "algo/satp/kernel_dsp.hpp"
#else
#include "algo/satp/kernel_portable.hpp"
#endif

namespace s4tp::satp {

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int8_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  multiply_rows<Sums, std::int8_t>(layer, bias, bias_stride, {inputs, input_stride}, batch,
                                   {sums[0], kMaxRows});
}

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int16_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  multiply_rows<Sums, std::int16_t>(layer, bias, bias_stride, {inputs, input_stride}, batch,
                                    {sums[0], kMaxRows});
}

void linear(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> outputs) {
  multiply_rows<Signed8>(layer, layer.bias, 0, inputs, count, outputs);
}

void linear_relu(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int8_t> outputs) {
  multiply_rows<Relu8>(layer, layer.bias, 0, inputs, count, outputs);
}

void linear_relu(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<std::int8_t> outputs) {
  multiply_rows<Relu8>(layer, layer.bias, 0, inputs, count, outputs);
}

void linear(const Linear& layer, Rows<const std::int8_t> inputs, int count, Rows<std::int16_t> outputs) {
  multiply_rows<Signed16>(layer, layer.bias, 0, inputs, count, outputs);
}

void linear(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<std::int16_t> outputs) {
  multiply_rows<Signed16>(layer, layer.bias, 0, inputs, count, outputs);
}

void linear_relu(const Linear& layer, Rows<const std::int16_t> inputs, int count,
                 Rows<std::int16_t> outputs) {
  multiply_rows<Relu16>(layer, layer.bias, 0, inputs, count, outputs);
}

void linear_by_row(const Linear& layer, Rows<const std::int8_t> inputs, int count,
                   Rows<std::int8_t> outputs) {
  multiply_rows<Signed8>(layer, layer.bias, layer.rows, inputs, count, outputs);
}

void linear_by_bias(const Linear& layer, Rows<const std::int8_t> inputs, int count, int bias_rows,
                    Rows<std::int16_t> outputs) {
  std::int32_t sums[kMaxBatch][kMaxRows];
  multiply(layer, layer.bias, 0, inputs.data, inputs.stride, count, sums);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < bias_rows; ++k) {
      const std::int32_t* bias = layer.bias + k * layer.rows;
      std::int16_t* output = outputs[i * bias_rows + k];
      for (int o = 0; o < layer.rows; ++o) {
        const std::int32_t sum = sums[i][o] + (bias[o] - layer.bias[o]);
        output[o] = Signed16::of(requantize(sum, layer.multiplier[o]));
      }
    }
  }
}

void linear(const Linear& layer, Rows<const std::int16_t> inputs, int count, Rows<float> outputs) {
  multiply_rows<Real>(layer, layer.bias, 0, inputs, count, outputs);
}

}  // namespace s4tp::satp
