#pragma once
/// The network's layers on Cortex-M with MVE: sums first, then their outputs.
/// Internal: for linear.cpp.

#include <arm_mve.h>

#include <cstdint>

#include "algo/satp/kernel_mve_sums.hpp"
#include "algo/satp/kernels.hpp"
#include "algo/satp/output.hpp"
#include "algo/satp/rows.hpp"

namespace s4tp::satp::mve {

// What lies in the lanes the conversion leaves alone does not matter; `spare` saves clearing them.
inline void store(Signed16 /*output*/, std::int16_t* to, int32x4_t q, int16x8_t& spare) {
  spare = vqmovnbq_s32(spare, q);
  vstrhq_s32(to, vreinterpretq_s32_s16(spare));
}
inline void store(Relu16 /*output*/, std::int16_t* to, int32x4_t q, int16x8_t& spare) {
  store(Signed16(), to, vmaxq_s32(q, vdupq_n_s32(0)), spare);
}
inline void store(Signed8 /*output*/, std::int8_t* to, int32x4_t q, int16x8_t& spare) {
  spare = vqmovnbq_s32(spare, q);
  spare = vreinterpretq_s16_s8(vqmovnbq_s16(vreinterpretq_s8_s16(spare), spare));
  vstrbq_s32(to, vreinterpretq_s32_s16(spare));
}
inline void store(Relu8 /*output*/, std::int8_t* to, int32x4_t q, int16x8_t& spare) {
  store(Signed8(), to, vqsubq_n_s32(q, 128), spare);  // to 0 .. 255, then less 128, is the same
}

template <typename In>
inline constexpr int kShift = sizeof(In) == 1 ? 8 : 0;

template <typename Output, typename In>
typename Output::Type output_of(std::int32_t sum, std::int32_t multiplier) {
  if constexpr (!Output::kRescaled) {
    return Output::of(sum, multiplier);
  } else {
    return Output::of(requantize_wide(sum * (1 << kShift<In>), multiplier));
  }
}

template <typename Output, typename In>
void store_rescaled(int32x4_t sum, int32x4_t multiplier, typename Output::Type* to, int16x8_t& spare) {
  if constexpr (sizeof(In) == 1) sum = vshlq_n_s32(sum, kShift<In>);
  store(Output(), to, vrmulhq_s32(sum, multiplier), spare);
}

/// Outputs of one input, from row `o` on.
template <typename Output, typename In>
void finish(const std::int32_t* sums, const std::int32_t* bias, const std::int32_t* multiplier, int o,
            int rows, typename Output::Type* outputs) {
  if constexpr (Output::kRescaled) {
    int16x8_t spare = vdupq_n_s16(0);
#pragma GCC unroll 1
    for (; o + 4 <= rows; o += 4) {
      const int32x4_t sum = vaddq_s32(vldrwq_s32(sums + o), vldrwq_s32(bias + o));
      store_rescaled<Output, In>(sum, vldrwq_s32(multiplier + o), outputs + o, spare);
    }
  }
#pragma GCC unroll 1
  for (; o < rows; ++o) outputs[o] = output_of<Output, In>(sums[o] + bias[o], multiplier[o]);
}

/// Outputs of three inputs with one bias. \return how many rows it has finished: all but the last few
template <typename Output, typename In>
int finish_three(const ChunkSums& sums, const std::int32_t* bias, const std::int32_t* multiplier, int rows,
                 typename Output::Type* first, typename Output::Type* second, typename Output::Type* third) {
  int16x8_t spare = vdupq_n_s16(0);
  const std::int32_t* sum = sums[0];
#pragma GCC unroll 1
  for (int i = 0; i < rows / 4; ++i) {
    const int32x4_t add = vldrwq_s32(bias);
    const int32x4_t by = vldrwq_s32(multiplier);
    store_rescaled<Output, In>(vaddq_s32(vldrwq_s32(sum), add), by, first, spare);
    store_rescaled<Output, In>(vaddq_s32(vldrwq_s32(sum + kChunk), add), by, second, spare);
    store_rescaled<Output, In>(vaddq_s32(vldrwq_s32(sum + 2 * kChunk), add), by, third, spare);
    bias += 4;
    multiplier += 4;
    sum += 4;
    first += 4;
    second += 4;
    third += 4;
  }
  return rows / 4 * 4;
}

}  // namespace s4tp::satp::mve

namespace s4tp::satp {

template <typename Output, typename In>
void multiply_rows(const Linear& layer, const std::int32_t* bias, int bias_stride, Rows<const In> inputs,
                   int count, Rows<typename Output::Type> outputs) {
  mve::ChunkSums sums;
  for (int i = 0; i < count; i += kMaxBatch) {
    const int batch = count - i < kMaxBatch ? count - i : kMaxBatch;
    const mve::Three<In> these = {inputs[i], inputs[i + (batch > 1 ? 1 : 0)], inputs[i + batch - 1]};
    for (int o = 0; o < layer.rows; o += mve::kChunk) {
      const int rows = layer.rows - o < mve::kChunk ? layer.rows - o : mve::kChunk;
      mve::sum_up_chunk(layer.weights + o * layer.stride, layer.stride, rows, these, sums);
      const std::int32_t* multiplier = layer.multiplier + o;
      int done = 0;
      if constexpr (Output::kRescaled) {
        if (batch == kMaxBatch && bias_stride == 0) {
          done = mve::finish_three<Output, In>(sums, bias + o, multiplier, rows, outputs[i] + o,
                                               outputs[i + 1] + o, outputs[i + 2] + o);
        }
      }
      if (done == rows) continue;
      for (int b = 0; b < batch; ++b) {
        mve::finish<Output, In>(sums[b], bias + (i + b) * bias_stride + o, multiplier, done, rows,
                                outputs[i + b] + o);
      }
    }
  }
}

}  // namespace s4tp::satp
