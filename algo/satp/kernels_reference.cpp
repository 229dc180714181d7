#include "algo/satp/kernels.hpp"

namespace s4tp::satp::reference {
namespace {

template <typename T>
void multiply_plainly(const Linear& layer, const std::int32_t* bias, int bias_stride, const T* inputs,
                      int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  for (int b = 0; b < batch; ++b) {
    for (int o = 0; o < layer.rows; ++o) {
      std::int32_t sum = bias[b * bias_stride + o];
      for (int j = 0; j < layer.columns; ++j) {
        sum += static_cast<std::int32_t>(layer.weights[o * layer.stride + j]) * inputs[b * input_stride + j];
      }
      sums[b][o] = sum;
    }
  }
}

}  // namespace

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int8_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  multiply_plainly(layer, bias, bias_stride, inputs, input_stride, batch, sums);
}

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int16_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  multiply_plainly(layer, bias, bias_stride, inputs, input_stride, batch, sums);
}

}  // namespace s4tp::satp::reference
