#pragma once
/// Sums of products on Cortex-M with MVE: sixteen products of int8, eight of int16 an instruction.
/// Internal: for kernel_mve.hpp.

#include <arm_mve.h>

#include <cstdint>

#include "algo/satp/kernels.hpp"

namespace s4tp::satp::mve {

inline constexpr int kChunk = 48;  ///< rows whose sums are kept at a time
/// Of fewer inputs one is named twice.
template <typename In>
using Three = const In* [kMaxBatch];
using ChunkSums = std::int32_t[kMaxBatch][kChunk];

// Sixteen (int8) or eight (int16) columns of two rows against three inputs, so that every load is used again.
// By hand, because sums must stand in even registers. Where x0 .. x2, w0 and w1 point is told in full.
#define S4TP_LOAD(load, to, from) load " %q[" to "], " from "\n"
#define S4TP_ADD(add, sum, input) add " %[" sum "], %q[q0], %q[" input "]\n"
#define S4TP_COLUMNS(add, load_weights, load_inputs, w0, w1, x0, x1, x2) \
  S4TP_LOAD(load_weights, "q0", w0)                                      \
  S4TP_LOAD(load_inputs, "q1", x0)                                       \
  S4TP_ADD(add, "a0", "q1")                                              \
  S4TP_LOAD(load_inputs, "q2", x1)                                       \
  S4TP_ADD(add, "a1", "q2")                                              \
  S4TP_LOAD(load_inputs, "q3", x2)                                       \
  S4TP_ADD(add, "a2", "q3")                                              \
  S4TP_LOAD(load_weights, "q0", w1)                                      \
  S4TP_ADD(add, "b0", "q1") S4TP_ADD(add, "b1", "q2") S4TP_ADD(add, "b2", "q3")
// The loop's end instruction masks the columns beyond the last.
#define S4TP_LOOP(type, load_weights, load_inputs, bytes)                                                    \
  "dlstp." type " lr, %[columns]\n1:\n" S4TP_COLUMNS("vmladava.s" type, load_weights, load_inputs,           \
                                                     "[%[w0]], #" bytes, "[%[w1]], #" bytes, "[%[x0]], #16", \
                                                     "[%[x1]], #16", "[%[x2]], #16") "letp lr, 1b\n"
#define S4TP_BLOCK(add, at)                                                                           \
  S4TP_COLUMNS(add, "vldrb.8", "vldrb.8", "[%[w0], #" at "]", "[%[w1], #" at "]", "[%[x0], #" at "]", \
               "[%[x1], #" at "]", "[%[x2], #" at "]")
// A known number of blocks, one behind the other.
#define S4TP_BLOCKS                                            \
  S4TP_BLOCK("vmladav.s8", "0")                                \
  ".set s4tp_at, 16\n.rept %c[columns] / 16 - 1\n" S4TP_BLOCK( \
      "vmladava.s8", "s4tp_at") ".set s4tp_at, s4tp_at + 16\n.endr\n"

/// Products of two rows, for a number of columns known at compile time.
template <int kColumns>
void sum_up_known(const std::int8_t* weights, int rows, const Three<std::int8_t>& inputs, ChunkSums& sums) {
  register const std::int8_t* w0 asm("r1") = weights;
  register const std::int8_t* w1 asm("r3") = weights + kColumns;
  register const std::int8_t* x0 asm("r5") = inputs[0];
  register const std::int8_t* x1 asm("r11") = inputs[1];
  register const std::int8_t* x2 asm("r9") = inputs[2];
  std::int32_t* to = sums[0];
  const std::int32_t* const end = to + rows;
  do {
    register std::int32_t a0 asm("r0");
    register std::int32_t a1 asm("r2");
    register std::int32_t a2 asm("r4");
    register std::int32_t b0 asm("r6");
    register std::int32_t b1 asm("r8");
    register std::int32_t b2 asm("r10");
    int8x16_t q0;
    int8x16_t q1;
    int8x16_t q2;
    int8x16_t q3;
    asm volatile(
        S4TP_BLOCKS
        : [a0] "=r"(a0), [a1] "=r"(a1), [a2] "=r"(a2), [b0] "=r"(b0), [b1] "=r"(b1), [b2] "=r"(b2),
          [q0] "=w"(q0), [q1] "=w"(q1), [q2] "=w"(q2), [q3] "=w"(q3)
        : [w0] "r"(w0), [w1] "r"(w1), [x0] "r"(x0), [x1] "r"(x1), [x2] "r"(x2), [columns] "i"(kColumns)
        : "memory");
    to[0] = a0;
    to[1] = b0;
    to[kChunk] = a1;
    to[kChunk + 1] = b1;
    to[2 * kChunk] = a2;
    to[2 * kChunk + 1] = b2;
    to += 2;
    w0 += 2 * kColumns;
    w1 += 2 * kColumns;
  } while (to != end);
}

template <typename In>
[[gnu::always_inline]] inline void add_products(const std::int8_t* weights, int columns,
                                                const Three<In>& inputs, std::int32_t* sums) {
  register const std::int8_t* w0 asm("r1") = weights;
  register const std::int8_t* w1 asm("r3") = weights + columns;
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
#define S4TP_ASM(text)                                                                                     \
  asm volatile(text                                                                                        \
               : [a0] "+r"(a0), [a1] "+r"(a1), [a2] "+r"(a2), [b0] "+r"(b0), [b1] "+r"(b1), [b2] "+r"(b2), \
                 [w0] "+r"(w0), [w1] "+r"(w1), [x0] "+r"(x0), [x1] "+r"(x1), [x2] "+r"(x2), [q0] "=w"(q0), \
                 [q1] "=w"(q1), [q2] "=w"(q2), [q3] "=w"(q3)                                               \
               : [columns] "r"(columns)                                                                    \
               : "lr", "cc", "memory")
  if constexpr (sizeof(In) == 1) {
    S4TP_ASM(S4TP_LOOP("8", "vldrb.8", "vldrb.8", "16"));
  } else {
    S4TP_ASM(S4TP_LOOP("16", "vldrb.s16", "vldrh.16", "8"));
  }
#undef S4TP_ASM
  sums[0] = a0;
  sums[1] = b0;
  sums[kChunk] = a1;
  sums[kChunk + 1] = b1;
  sums[2 * kChunk] = a2;
  sums[2 * kChunk + 1] = b2;
}

#undef S4TP_BLOCKS
#undef S4TP_BLOCK
#undef S4TP_LOOP
#undef S4TP_COLUMNS
#undef S4TP_ADD
#undef S4TP_LOAD

/// Of at least two rows. Of an odd number the last pair overlaps the one before it.
template <typename In>
void sum_up(const std::int8_t* weights, int stride, int rows, const Three<In>& inputs, ChunkSums& sums) {
  const int last = rows - 2;
  for (int o = 0;; o = o + 2 < last ? o + 2 : last) {
    add_products(weights + o * stride, stride, inputs, sums[0] + o);
    if (o == last) return;
  }
}

/// Of 32 columns, the most frequent number: the inputs stay in registers.
inline void sum_up_32(const std::int8_t* weights, int rows, const Three<std::int8_t>& inputs,
                      ChunkSums& sums) {
  const int8x16_t x0 = vldrbq_s8(inputs[0]);
  const int8x16_t x1 = vldrbq_s8(inputs[1]);
  const int8x16_t x2 = vldrbq_s8(inputs[2]);
  const int8x16_t y0 = vldrbq_s8(inputs[0] + 16);
  const int8x16_t y1 = vldrbq_s8(inputs[1] + 16);
  const int8x16_t y2 = vldrbq_s8(inputs[2] + 16);
#pragma GCC unroll 1
  for (int o = 0; o < rows; ++o, weights += 32) {
    const int8x16_t w = vldrbq_s8(weights);
    const int8x16_t v = vldrbq_s8(weights + 16);
    sums[0][o] = vmladavaq_s8(vmladavq_s8(w, x0), v, y0);
    sums[1][o] = vmladavaq_s8(vmladavq_s8(w, x1), v, y1);
    sums[2][o] = vmladavaq_s8(vmladavq_s8(w, x2), v, y2);
  }
}

/// Of at most eight columns of int16, in the same way.
inline void sum_up_8(const std::int8_t* weights, int stride, int rows, const Three<std::int16_t>& inputs,
                     ChunkSums& sums) {
  const mve_pred16_t there = vctp16q(static_cast<std::uint32_t>(stride));
  const int16x8_t x0 = vldrhq_z_s16(inputs[0], there);
  const int16x8_t x1 = vldrhq_z_s16(inputs[1], there);
  const int16x8_t x2 = vldrhq_z_s16(inputs[2], there);
#pragma GCC unroll 1
  for (int o = 0; o < rows; ++o, weights += stride) {
    const int16x8_t w = vldrbq_z_s16(weights, there);
    sums[0][o] = vmladavq_s16(w, x0);
    sums[1][o] = vmladavq_s16(w, x1);
    sums[2][o] = vmladavq_s16(w, x2);
  }
}

/// Of nine to sixteen.
inline void sum_up_16(const std::int8_t* weights, int stride, int rows, const Three<std::int16_t>& inputs,
                      ChunkSums& sums) {
  const mve_pred16_t there = vctp16q(static_cast<std::uint32_t>(stride - 8));
  const int16x8_t x0 = vldrhq_s16(inputs[0]);
  const int16x8_t x1 = vldrhq_s16(inputs[1]);
  const int16x8_t x2 = vldrhq_s16(inputs[2]);
  const int16x8_t y0 = vldrhq_z_s16(inputs[0] + 8, there);
  const int16x8_t y1 = vldrhq_z_s16(inputs[1] + 8, there);
  const int16x8_t y2 = vldrhq_z_s16(inputs[2] + 8, there);
#pragma GCC unroll 1
  for (int o = 0; o < rows; ++o, weights += stride) {
    const int16x8_t w = vldrbq_s16(weights);
    const int16x8_t v = vldrbq_z_s16(weights + 8, there);
    sums[0][o] = vmladavaq_s16(vmladavq_s16(w, x0), v, y0);
    sums[1][o] = vmladavaq_s16(vmladavq_s16(w, x1), v, y1);
    sums[2][o] = vmladavaq_s16(vmladavq_s16(w, x2), v, y2);
  }
}

inline int16x8_t load_wide(const std::int8_t* from, mve_pred16_t there) {
  return vldrbq_z_s16(from, there);
}
inline int16x8_t load_wide(const std::int16_t* from, mve_pred16_t there) {
  return vldrhq_z_s16(from, there);
}

/// Of a single row.
template <typename In>
void sum_up_row(const std::int8_t* weights, int stride, const Three<In>& inputs, ChunkSums& sums) {
  for (int b = 0; b < kMaxBatch; ++b) {
    std::int32_t sum = 0;
    for (int j = 0; j < stride; j += 8) {
      const mve_pred16_t there = vctp16q(static_cast<std::uint32_t>(stride - j));
      sum = vmladavaq_s16(sum, vldrbq_z_s16(weights + j, there), load_wide(inputs[b] + j, there));
    }
    sums[b][0] = sum;
  }
}

inline void sum_up_chunk(const std::int8_t* weights, int stride, int rows, const Three<std::int8_t>& inputs,
                         ChunkSums& sums) {
  if (rows == 1) return sum_up_row(weights, stride, inputs, sums);
  if (stride == 32) return sum_up_32(weights, rows, inputs, sums);
  if (stride == 48 && rows % 2 == 0) return sum_up_known<48>(weights, rows, inputs, sums);
  if (stride == 80 && rows % 2 == 0) return sum_up_known<80>(weights, rows, inputs, sums);
  if (stride == 128 && rows % 2 == 0) return sum_up_known<128>(weights, rows, inputs, sums);
  sum_up(weights, stride, rows, inputs, sums);
}

inline void sum_up_chunk(const std::int8_t* weights, int stride, int rows, const Three<std::int16_t>& inputs,
                         ChunkSums& sums) {
  if (rows == 1) return sum_up_row(weights, stride, inputs, sums);
  if (stride <= 8) return sum_up_8(weights, stride, rows, inputs, sums);
  if (stride <= 16) return sum_up_16(weights, stride, rows, inputs, sums);
  sum_up(weights, stride, rows, inputs, sums);
}

}  // namespace s4tp::satp::mve
