#pragma once
/// The network's inner loop in the order compilers make vectors of. Internal: for linear.cpp.

#include "algo/satp/kernels.hpp"
#include "algo/satp/output.hpp"
#include "algo/satp/rows.hpp"

namespace s4tp::satp {

template <typename Output, typename In>
typename Output::Type output_of(std::int32_t sum, std::int32_t multiplier) {
  if constexpr (!Output::kRescaled) {
    return Output::of(sum, multiplier);
  } else if constexpr (sizeof(In) == 1) {
    return Output::of(requantize(sum, multiplier));
  } else {
    return Output::of(requantize_wide(sum, multiplier));
  }
}

template <typename Output, typename In>
void multiply_rows(const Linear& layer, const std::int32_t* bias, int bias_stride, Rows<const In> inputs,
                   int count, Rows<typename Output::Type> outputs) {
  for (int b = 0; b < count; ++b) {
    const In* input = inputs[b];
    for (int o = 0; o < layer.rows; ++o) {
      const std::int8_t* weights = layer.weights + o * layer.stride;
      std::int32_t sum = 0;
      for (int j = 0; j < layer.columns; ++j)
        sum += static_cast<std::int16_t>(weights[j]) * static_cast<std::int16_t>(input[j]);
      outputs[b][o] = output_of<Output, In>(bias[b * bias_stride + o] + sum, layer.multiplier[o]);
    }
  }
}

}  // namespace s4tp::satp
