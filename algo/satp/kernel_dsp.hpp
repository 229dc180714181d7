#pragma once
/// The network's inner loop on Cortex-M with the DSP extension: two products an instruction, on halves of
/// words. Internal: for linear.cpp.
///
/// Four weights w0 .. w3 in a word become (w0, w2) and (w1, w3); inputs are kept in the same pairs, those of
/// a batch side by side. Inputs of int8 are kept 256 times as large, as are their sums, so that rescaling
/// is one instruction behind both kinds.

#include <cstdint>
#include <cstring>

#include "algo/satp/kernels.hpp"
#include "algo/satp/output.hpp"
#include "algo/satp/rows.hpp"

namespace s4tp::satp::dsp {

inline constexpr int kMaxPairs = kMaxColumns / 2;

template <typename In>
inline constexpr int kShift = sizeof(In) == 1 ? 8 : 0;

inline std::uint32_t load(const void* from) {
  std::uint32_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return word;
}

inline void pair_up(const std::int8_t* input, std::uint32_t& even, std::uint32_t& odd) {
  constexpr std::uint32_t kUpperBytes = 0xFF00FF00U;
  const std::uint32_t word = load(input);
  even = (word << 8U) & kUpperBytes;
  odd = word & kUpperBytes;
}
inline void pair_up(const std::int16_t* input, std::uint32_t& even, std::uint32_t& odd) {
  const std::uint32_t first = load(input);
  const std::uint32_t second = load(input + 2);
  even = (first & 0xFFFFU) | (second << 16U);
  odd = (first >> 16U) | (second & 0xFFFF0000U);
}

// Two rows of weights against a batch of two or three inputs, by hand, because the compiler keeps what it
// should load twice and spills what it should keep. All fourteen registers are taken, so that the rows'
// distance and the end wait in those of floating point.
#define S4TP_ROWS_ANYWHERE            \
  "vmov r0, %[distance]\n"            \
  "ldr %[second], [%[weights], r0]\n" \
  "ldr %[first], [%[weights]], #4\n"
#define S4TP_ROWS_KNOWN                             \
  "ldr %[second], [%[weights], #%c[distance]]\n"    \
  "ldr %[first], [%[weights]], #4\n"
#define S4TP_TIMES(row, weights)                                       \
  "smlad %[" row "0], %[" weights "], r0, %[" row "0]\n"               \
  "smlad %[" row "1], %[" weights "], r1, %[" row "1]\n"
#define S4TP_TIMES_3(row, weights) \
  S4TP_TIMES(row, weights)         \
  "smlad %[" row "2], %[" weights "], r2, %[" row "2]\n"
#define S4TP_FOUR_COLUMNS(rows, inputs, times) \
  rows                                       \
  "ldm %[pairs]!, {" inputs "}\n"            \
  "sxtb16 %[part], %[first]\n"               \
  times("a", "part")                         \
  "sxtb16 %[part], %[second]\n"              \
  times("b", "part")                         \
  "ldm %[pairs]!, {" inputs "}\n"            \
  "sxtb16 %[first], %[first], ror #8\n"      \
  times("a", "first")                        \
  "sxtb16 %[second], %[second], ror #8\n"    \
  times("b", "second")
#define S4TP_2 S4TP_FOUR_COLUMNS(S4TP_ROWS_ANYWHERE, "r0, r1", S4TP_TIMES)
#define S4TP_3 S4TP_FOUR_COLUMNS(S4TP_ROWS_ANYWHERE, "r0, r1, r2", S4TP_TIMES_3)
#define S4TP_3_KNOWN S4TP_FOUR_COLUMNS(S4TP_ROWS_KNOWN, "r0, r1, r2", S4TP_TIMES_3)
#define S4TP_LOOP(body)      \
  "1:\n" body                \
  "vmov %[part], %[end]\n"   \
  "cmp %[pairs], %[part]\n"   \
  "bne 1b\n"
#define S4TP_ASM(body, apart, ...)                                                                          \
  asm volatile(S4TP_LOOP(body)                                                                       \
               : __VA_ARGS__, [weights] "+r"(w), [pairs] "+r"(x), [first] "=&r"(first),              \
                 [second] "=&r"(second), [part] "=&r"(part)                                          \
               : [distance] apart, [end] "t"(end)                                                \
               : "cc", "memory", "r0", "r1", "r2")

/// Adds the products of two rows, `distance` bytes apart, and `kBatch` inputs to their sums.
/// \tparam kStride  of the rows, when it is known: a multiple of 16; otherwise 0
template <int kBatch, int kStride>
[[gnu::always_inline]] inline void add_products(const std::int8_t* weights, std::int32_t distance,
                                                const std::uint32_t* pairs, const std::uint32_t* end,
                                                bool by_sixteen, std::int32_t (&a)[kBatch],
                                                std::int32_t (&b)[kBatch]) {
  register std::int32_t a0 asm("r3") = a[0];
  register std::int32_t a1 asm("r4") = a[1];
  register std::int32_t b0 asm("r5") = b[0];
  register std::int32_t b1 asm("r6") = b[1];
  register const std::int8_t* w asm("r7") = weights;
  register const std::uint32_t* x asm("r8") = pairs;
  register std::uint32_t first asm("r9");
  register std::uint32_t second asm("r10");
  register std::uint32_t part asm("r11");
  if constexpr (kBatch == 3) {
    register std::int32_t a2 asm("r12") = a[2];
    register std::int32_t b2 asm("lr") = b[2];
    if constexpr (kStride != 0) {
      S4TP_ASM(S4TP_3_KNOWN S4TP_3_KNOWN S4TP_3_KNOWN S4TP_3_KNOWN, "i"(kStride), [a0] "+r"(a0), [a1] "+r"(a1),
               [a2] "+r"(a2), [b0] "+r"(b0), [b1] "+r"(b1), [b2] "+r"(b2));
    } else if (by_sixteen) {
      S4TP_ASM(S4TP_3 S4TP_3 S4TP_3 S4TP_3, "t"(distance), [a0] "+r"(a0), [a1] "+r"(a1), [a2] "+r"(a2), [b0] "+r"(b0),
               [b1] "+r"(b1), [b2] "+r"(b2));
    } else {
      S4TP_ASM(S4TP_3, "t"(distance), [a0] "+r"(a0), [a1] "+r"(a1), [a2] "+r"(a2), [b0] "+r"(b0), [b1] "+r"(b1),
               [b2] "+r"(b2));
    }
    a[2] = a2;
    b[2] = b2;
  } else {
    S4TP_ASM(S4TP_2, "t"(distance), [a0] "+r"(a0), [a1] "+r"(a1), [b0] "+r"(b0), [b1] "+r"(b1));
  }
  a[0] = a0;
  a[1] = a1;
  b[0] = b0;
  b[1] = b1;
}

#undef S4TP_ASM
#undef S4TP_LOOP
#undef S4TP_3_KNOWN
#undef S4TP_3
#undef S4TP_2
#undef S4TP_FOUR_COLUMNS
#undef S4TP_TIMES_3
#undef S4TP_TIMES
#undef S4TP_ROWS_KNOWN
#undef S4TP_ROWS_ANYWHERE

template <typename Output, typename In>
typename Output::Type output_of(std::int32_t sum, std::int32_t multiplier) {
  if constexpr (Output::kRescaled) {
    return Output::of(requantize_wide(sum, multiplier));
  } else {
    return Output::of(sum >> kShift<In>, multiplier);
  }
}

/// Of kBatch inputs and at least two rows.
template <typename Output, int kBatch, int kStride, typename In>
void multiply_batch(const Linear& layer, int distance, const std::int32_t* bias, int bias_stride,
                    Rows<const In> inputs, Rows<typename Output::Type> outputs) {
  std::uint32_t pairs[kMaxPairs * kBatch];
  std::uint32_t* end = pairs;
  const int stride = kStride != 0 ? kStride : layer.stride;
  for (int j = 0; j < stride; j += 4, end += 2 * kBatch) {
#pragma GCC unroll 3
    for (int i = 0; i < kBatch; ++i) pair_up(inputs[i] + j, end[i], end[kBatch + i]);
  }
  const bool by_sixteen = stride % 16 == 0;
  const int last = layer.rows - 2;  // of an odd number of rows the last pair overlaps the one before it
  const std::int8_t* weights = layer.weights;
  const std::int32_t* multiplier = layer.multiplier;
  int o = 0;
  while (true) {
    std::int32_t a[kBatch];
    std::int32_t b[kBatch];
    const std::int32_t* from = bias + o;
#pragma GCC unroll 3
    for (int i = 0; i < kBatch; ++i, from += bias_stride) {
      a[i] = from[0] * (1 << kShift<In>);
      b[i] = from[1] * (1 << kShift<In>);
    }
    add_products<kBatch, kStride>(weights + o * stride, distance, pairs, end, by_sixteen, a, b);
    const std::int32_t first = multiplier[o];
    const std::int32_t second = multiplier[o + 1];
    typename Output::Type* to = outputs.data + o;
#pragma GCC unroll 3
    for (int i = 0; i < kBatch; ++i, to += outputs.stride) {
      to[0] = output_of<Output, In>(a[i], first);
      to[1] = output_of<Output, In>(b[i], second);
    }
    if (o == last) return;
    o = o + 2 < last ? o + 2 : last;
  }
}

/// The strides most of the network's time goes to have code of their own.
template <typename Output, typename In>
void multiply_three(const Linear& layer, const std::int32_t* bias, int bias_stride, Rows<const In> inputs,
                    Rows<typename Output::Type> outputs) {
  if constexpr (sizeof(In) == 1 && Output::kRescaled) {
    if (layer.stride == 32)
      return multiply_batch<Output, 3, 32, In>(layer, 32, bias, bias_stride, inputs, outputs);
    if constexpr (sizeof(typename Output::Type) == 2) {
      if (layer.stride == 48)
        return multiply_batch<Output, 3, 48, In>(layer, 48, bias, bias_stride, inputs, outputs);
      if (layer.stride == 80)
        return multiply_batch<Output, 3, 80, In>(layer, 80, bias, bias_stride, inputs, outputs);
      if (layer.stride == 128)
        return multiply_batch<Output, 3, 128, In>(layer, 128, bias, bias_stride, inputs, outputs);
    }
  }
  multiply_batch<Output, 3, 0, In>(layer, layer.stride, bias, bias_stride, inputs, outputs);
}

// A single row is computed twice.
template <typename Output, typename In>
void multiply_row(const Linear& layer, const std::int32_t* bias, const In* input,
                  typename Output::Type* output) {
  const std::int32_t biases[2] = {*bias, *bias};
  const std::int32_t multipliers[2] = {*layer.multiplier, *layer.multiplier};
  typename Output::Type outputs[2];
  Linear twice = layer;
  twice.multiplier = multipliers;
  twice.rows = 2;
  multiply_batch<Output, 2, 0, In>(twice, 0, biases, 0, {input, 0}, {outputs, 0});
  *output = outputs[0];
}

}  // namespace s4tp::satp::dsp

namespace s4tp::satp {

template <typename Output, typename In>
void multiply_rows(const Linear& layer, const std::int32_t* bias, int bias_stride, Rows<const In> inputs,
                   int count, Rows<typename Output::Type> outputs) {
  if (layer.rows == 1) {
    for (int i = 0; i < count; ++i)
      dsp::multiply_row<Output, In>(layer, bias + i * bias_stride, inputs[i], outputs[i]);
    return;
  }
  int i = 0;
  for (; i + 3 <= count; i += 3) {
    dsp::multiply_three<Output, In>(layer, bias + i * bias_stride, bias_stride, {inputs[i], inputs.stride},
                                    {outputs[i], outputs.stride});
  }
  if (i == count) return;
  const int pair = i + 1 < count ? 1 : 0;  // a single input is computed twice
  dsp::multiply_batch<Output, 2, 0, In>(layer, layer.stride, bias + i * bias_stride, pair * bias_stride,
                                     {inputs[i], pair * inputs.stride}, {outputs[i], pair * outputs.stride});
}

}  // namespace s4tp::satp
