#include "algo/satp/kernels.hpp"

namespace s4tp::satp {

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int8_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  reference::multiply(layer, bias, bias_stride, inputs, input_stride, batch, sums);
}

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int16_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  reference::multiply(layer, bias, bias_stride, inputs, input_stride, batch, sums);
}

}  // namespace s4tp::satp
