#pragma once
/// The network's inner loop on Cortex-M with MVE: sixteen products of int8, eight of int16 an instruction.
/// Internal: for linear.cpp.

#include <arm_mve.h>

#include <cstdint>

#include "algo/satp/kernels.hpp"
#include "algo/satp/output.hpp"
#include "algo/satp/rows.hpp"

namespace s4tp::satp::mve {

inline constexpr int kChunk = 48;  ///< rows whose sums are kept at a time
/// A batch; where there are fewer, one is named twice.
template <typename In>
using Three = const In* [kMaxBatch];
using ChunkSums = std::int32_t[kMaxBatch][kChunk];

// Two rows against three inputs, so that every load is used again. By hand, because sums must stand in even
// registers, and because the loop's end instruction masks the columns beyond the last.
#define S4TP_TWO_BY_THREE(type, load_weights, load_inputs)                                                  \
  "dlstp." type " lr, %[columns]\n1:\n" load_weights " %q[q0], [%[w0]], #%c[weight_bytes]\n" load_inputs    \
  " %q[q1], [%[x0]], #16\n"                                                                                 \
  "vmladava.s" type " %[a0], %q[q0], %q[q1]\n" load_inputs " %q[q2], [%[x1]], #16\n"                        \
  "vmladava.s" type " %[a1], %q[q0], %q[q2]\n" load_inputs " %q[q3], [%[x2]], #16\n"                        \
  "vmladava.s" type " %[a2], %q[q0], %q[q3]\n" load_weights " %q[q0], [%[w1]], #%c[weight_bytes]\n"         \
  "vmladava.s" type " %[b0], %q[q0], %q[q1]\n"                                                              \
  "vmladava.s" type " %[b1], %q[q0], %q[q2]\n"                                                              \
  "vmladava.s" type " %[b2], %q[q0], %q[q3]\n"                                                              \
  "letp lr, 1b\n"
#define S4TP_ASM(text, bytes)                                                                              \
  asm volatile(text                                                                                        \
               : [a0] "+r"(a0), [a1] "+r"(a1), [a2] "+r"(a2), [b0] "+r"(b0), [b1] "+r"(b1),           \
                 [b2] "+r"(b2), [w0] "+r"(w0), [w1] "+r"(w1), [x0] "+r"(x0), [x1] "+r"(x1),               \
                 [x2] "+r"(x2), [q0] "=w"(q0), [q1] "=w"(q1), [q2] "=w"(q2), [q3] "=w"(q3)             \
               : [columns] "r"(columns), [weight_bytes] "i"(bytes)                                         \
               : "lr", "cc", "memory")

template <typename In>
[[gnu::always_inline]] inline void add_products(const std::int8_t* weights, int distance, int columns,
                                                const Three<In>& inputs, ChunkSums& sums, int row) {
  register const std::int8_t* w0 asm("r1") = weights;
  register const std::int8_t* w1 asm("r3") = weights + distance;
  register const In* x0 asm("r5") = inputs[0];
  register const In* x1 asm("r11") = inputs[1];
  register const In* x2 asm("r9") = inputs[2];
  register std::int32_t a0 asm("r0") = 0;
  register std::int32_t a1 asm("r2") = 0;
  register std::int32_t a2 asm("r4") = 0;
  register std::int32_t b0 asm("r6") = 0;
  register std::int32_t b1 asm("r8") = 0;
  register std::int32_t b2 asm("r10") = 0;
  int8x16_t q0;
  int8x16_t q1;
  int8x16_t q2;
  int8x16_t q3;
  if constexpr (sizeof(In) == 1) {
    S4TP_ASM(S4TP_TWO_BY_THREE("8", "vldrb.8", "vldrb.8"), 16);
  } else {
    S4TP_ASM(S4TP_TWO_BY_THREE("16", "vldrb.s16", "vldrh.16"), 8);
  }
  sums[0][row] = a0;
  sums[0][row + 1] = b0;
  sums[1][row] = a1;
  sums[1][row + 1] = b1;
  sums[2][row] = a2;
  sums[2][row + 1] = b2;
}

#undef S4TP_ASM
#undef S4TP_TWO_BY_THREE

/// Products of three inputs and at most kChunk rows. Of an odd number the last pair of rows overlaps the one
/// before it; a single row is computed twice.
template <typename In>
[[gnu::noinline]] void sum_up(const std::int8_t* weights, int stride, int rows, const Three<In>& inputs,
                              ChunkSums& sums) {
  const int last = rows > 1 ? rows - 2 : 0;
  const int distance = rows > 1 ? stride : 0;
  for (int o = 0;; o = o + 2 < last ? o + 2 : last) {
    add_products(weights + o * stride, distance, stride, inputs, sums, o);
    if (o == last) return;
  }
}

/// The same of 32 columns, the network's most frequent layer: the inputs stay in registers.
inline void sum_up_32(const std::int8_t* weights, int rows, const Three<std::int8_t>& inputs,
                      ChunkSums& sums) {
  const int8x16_t x0 = vldrbq_s8(inputs[0]);
  const int8x16_t x1 = vldrbq_s8(inputs[1]);
  const int8x16_t x2 = vldrbq_s8(inputs[2]);
  const int8x16_t y0 = vldrbq_s8(inputs[0] + 16);
  const int8x16_t y1 = vldrbq_s8(inputs[1] + 16);
  const int8x16_t y2 = vldrbq_s8(inputs[2] + 16);
  for (int o = 0; o < rows; ++o, weights += 32) {
    const int8x16_t w = vldrbq_s8(weights);
    const int8x16_t v = vldrbq_s8(weights + 16);
    sums[0][o] = vmladavaq_s8(vmladavq_s8(w, x0), v, y0);
    sums[1][o] = vmladavaq_s8(vmladavq_s8(w, x1), v, y1);
    sums[2][o] = vmladavaq_s8(vmladavq_s8(w, x2), v, y2);
  }
}

inline void store(Sums /*output*/, std::int32_t* to, int32x4_t q) {
  vstrwq_s32(to, q);
}
inline void store(Signed8 /*output*/, std::int8_t* to, int32x4_t q) {
  const int16x8_t half = vqmovnbq_s32(vreinterpretq_s16_s32(q), q);
  vstrbq_s32(to, vreinterpretq_s32_s8(vqmovnbq_s16(vreinterpretq_s8_s16(half), half)));
}
inline void store(Relu8 /*output*/, std::int8_t* to, int32x4_t q) {
  store(Signed8(), to, vqsubq_n_s32(q, 128));  // to 0 .. 255, then less 128, is the same
}
inline void store(Signed16 /*output*/, std::int16_t* to, int32x4_t q) {
  vstrhq_s32(to, vreinterpretq_s32_s16(vqmovnbq_s32(vreinterpretq_s16_s32(q), q)));
}
inline void store(Relu16 /*output*/, std::int16_t* to, int32x4_t q) {
  store(Signed16(), to, vmaxq_s32(q, vdupq_n_s32(0)));
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

/// Outputs of one input.
template <typename Output, typename In>
void finish(const std::int32_t* sums, const std::int32_t* bias, const std::int32_t* multiplier, int rows,
            typename Output::Type* outputs) {
  int o = 0;
  if constexpr (Output::kRescaled) {
    for (; o + 4 <= rows; o += 4) {
      const int32x4_t sum = vaddq_s32(vldrwq_s32(sums + o), vldrwq_s32(bias + o));
      store(Output(), outputs + o,
            vrmulhq_s32(vshlq_n_s32(sum, kShift<In>), vldrwq_s32(multiplier + o)));
    }
  }
  for (; o < rows; ++o) outputs[o] = output_of<Output, In>(sums[o] + bias[o], multiplier[o]);
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
      if constexpr (sizeof(In) == 1) {
        if (layer.stride == 32) {mve::sum_up_32(layer.weights + o * layer.stride, rows, these, sums);} else
      mve::sum_up<In>(layer.weights + o * layer.stride, layer.stride, rows, these, sums);
      } else
      mve::sum_up<In>(layer.weights + o * layer.stride, layer.stride, rows, these, sums);
      for (int b = 0; b < batch; ++b) {
        mve::finish<Output, In>(sums[b], bias + (i + b) * bias_stride + o, layer.multiplier + o, rows,
                                outputs[i + b] + o);
      }
    }
  }
}

}  // namespace s4tp::satp
