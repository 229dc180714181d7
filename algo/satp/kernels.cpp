#include "algo/satp/kernels.hpp"

#include <cstring>

// Integers only: this file may be vectorised (algo/CMakeLists.txt), which floats may not.
#if defined(__ARM_FEATURE_MVE) && (__ARM_FEATURE_MVE & 1)
#include <arm_mve.h>
#define S4TP_KERNELS_MVE
#elif defined(__ARM_FEATURE_DSP) && defined(__thumb__)
#define S4TP_KERNELS_DSP
#endif

namespace s4tp::satp {
namespace {

#if defined(S4TP_KERNELS_MVE)

// Sixteen products an instruction: four outputs share what is loaded of the input.
void multiply_one(const Linear& layer, const std::int32_t* bias, const std::int8_t* input,
                  std::int32_t* sums) {
  int o = 0;
  for (; o + 4 <= layer.rows; o += 4) {
    const std::int8_t* w0 = layer.weights + o * layer.stride;
    const std::int8_t* w1 = w0 + layer.stride;
    const std::int8_t* w2 = w1 + layer.stride;
    const std::int8_t* w3 = w2 + layer.stride;
    std::int32_t s0 = bias[o];
    std::int32_t s1 = bias[o + 1];
    std::int32_t s2 = bias[o + 2];
    std::int32_t s3 = bias[o + 3];
    for (int j = 0; j < layer.columns; j += 16) {
      const int8x16_t x = vldrbq_s8(input + j);
      s0 = vmladavaq_s8(s0, vldrbq_s8(w0 + j), x);
      s1 = vmladavaq_s8(s1, vldrbq_s8(w1 + j), x);
      s2 = vmladavaq_s8(s2, vldrbq_s8(w2 + j), x);
      s3 = vmladavaq_s8(s3, vldrbq_s8(w3 + j), x);
    }
    sums[o] = s0;
    sums[o + 1] = s1;
    sums[o + 2] = s2;
    sums[o + 3] = s3;
  }
  for (; o < layer.rows; ++o) {
    std::int32_t sum = bias[o];
    for (int j = 0; j < layer.columns; j += 16)
      sum = vmladavaq_s8(sum, vldrbq_s8(layer.weights + o * layer.stride + j), vldrbq_s8(input + j));
    sums[o] = sum;
  }
}

// Eight products an instruction; weights are widened as they are loaded. Rows end on a multiple of four.
void multiply_one(const Linear& layer, const std::int32_t* bias, const std::int16_t* input,
                  std::int32_t* sums) {
  for (int o = 0; o < layer.rows; ++o) {
    const std::int8_t* weights = layer.weights + o * layer.stride;
    std::int32_t sum = bias[o];
    for (int j = 0; j < layer.stride; j += 8) {
      const mve_pred16_t there = vctp16q(static_cast<std::uint32_t>(layer.stride - j));
      sum = vmladavaq_s16(sum, vldrbq_z_s16(weights + j, there), vldrhq_z_s16(input + j, there));
    }
    sums[o] = sum;
  }
}

template <typename In>
void multiply_all(const Linear& layer, const std::int32_t* bias, int bias_stride, const In* inputs,
                  int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  for (int b = 0; b < batch; ++b)
    multiply_one(layer, bias + b * bias_stride, inputs + b * input_stride, sums[b]);
}

#elif defined(S4TP_KERNELS_DSP)

// Two products an instruction, on halves of words: four weights w0 .. w3 in a word become (w0, w2) and (w1,
// w3), and inputs are kept in the same pairs.
constexpr int kMaxGroups = kMaxColumns / 4;

std::uint32_t load(const void* from) {
  std::uint32_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return word;
}
std::uint32_t even_bytes(std::uint32_t word) {
  std::uint32_t result = 0;
  asm("sxtb16 %0, %1" : "=r"(result) : "r"(word));
  return result;
}
std::uint32_t odd_bytes(std::uint32_t word) {
  std::uint32_t result = 0;
  asm("sxtb16 %0, %1, ror #8" : "=r"(result) : "r"(word));
  return result;
}
void pair_up(const std::int8_t* input, std::uint32_t* even, std::uint32_t* odd) {
  const std::uint32_t word = load(input);
  *even = even_bytes(word);
  *odd = odd_bytes(word);
}
void pair_up(const std::int16_t* input, std::uint32_t* even, std::uint32_t* odd) {
  const std::uint32_t first = load(input);
  const std::uint32_t second = load(input + 2);
  *even = (first & 0xFFFFU) | (second << 16U);
  *odd = (first >> 16U) | (second & 0xFFFF0000U);
}

// Four weights of one row, times what stands in that pair of words of `inputs` inputs. By hand, because the
// compiler keeps what it should load twice and spills what it should keep.
#define S4TP_WEIGHTS                 \
  "ldr %[even], [%[w]], #4\n"        \
  "sxtb16 %[odd], %[even], ror #8\n" \
  "sxtb16 %[even], %[even]\n"
#define S4TP_INPUT(sum)                \
  "ldrd %[p], %[q], [%[x]], #8\n"      \
  "smlad " sum ", %[even], %[p], " sum \
  "\n"                                 \
  "smlad " sum ", %[odd], %[q], " sum "\n"
#define S4TP_THREE S4TP_WEIGHTS S4TP_INPUT("%[s0]") S4TP_INPUT("%[s1]") S4TP_INPUT("%[s2]")
#define S4TP_SECOND_ROW                 \
  "ldr %[even], [%[v]], #4\n"           \
  "sxtb16 %[odd], %[even], ror #8\n"    \
  "sxtb16 %[even], %[even]\n"           \
  "smlad %[s1], %[even], %[p], %[s1]\n" \
  "smlad %[s1], %[odd], %[q], %[s1]\n"
#define S4TP_TWO_ROWS S4TP_WEIGHTS S4TP_INPUT("%[s0]") S4TP_SECOND_ROW

// One input: two outputs share what is loaded of it.
void multiply_one(const Linear& layer, const std::int32_t* bias, const std::uint32_t* pairs, int groups,
                  std::int32_t* sums) {
  int o = 0;
  for (; o + 2 <= layer.rows; o += 2) {
    const std::int8_t* w = layer.weights + o * layer.stride;
    const std::int8_t* v = w + layer.stride;
    const std::int8_t* const end = w + 4 * groups;
    const std::uint32_t* x = pairs;
    std::int32_t s0 = bias[o];
    std::int32_t s1 = bias[o + 1];
    std::uint32_t even = 0;
    std::uint32_t odd = 0;
    std::uint32_t p = 0;
    std::uint32_t q = 0;
    if (groups % 4 == 0) {
      asm volatile("1:\n" S4TP_TWO_ROWS S4TP_TWO_ROWS S4TP_TWO_ROWS S4TP_TWO_ROWS "cmp %[w], %[end]\nbne 1b\n"
                   : [s0] "+&r"(s0), [s1] "+&r"(s1), [w] "+&r"(w), [v] "+&r"(v), [x] "+&r"(x),
                     [even] "=&r"(even), [odd] "=&r"(odd), [p] "=&r"(p), [q] "=&r"(q)
                   : [end] "r"(end)
                   : "cc", "memory");
    } else {
      asm volatile("1:\n" S4TP_TWO_ROWS "cmp %[w], %[end]\nbne 1b\n"
                   : [s0] "+&r"(s0), [s1] "+&r"(s1), [w] "+&r"(w), [v] "+&r"(v), [x] "+&r"(x),
                     [even] "=&r"(even), [odd] "=&r"(odd), [p] "=&r"(p), [q] "=&r"(q)
                   : [end] "r"(end)
                   : "cc", "memory");
    }
    sums[o] = s0;
    sums[o + 1] = s1;
  }
  for (; o < layer.rows; ++o) {
    std::int32_t sum = bias[o];
    for (int j = 0; j < 4 * groups; ++j) {
      const auto pair = static_cast<std::int32_t>(pairs[j / 4 * 2 + j % 2]);
      sum += layer.weights[o * layer.stride + j] * (j % 4 < 2 ? static_cast<std::int16_t>(pair) : pair >> 16);
    }
    sums[o] = sum;
  }
}

// Three inputs share what is made of the weights.
void multiply_three(const Linear& layer, const std::int32_t* bias, int bias_stride,
                    const std::uint32_t* pairs, int groups, std::int32_t (*sums)[kMaxRows]) {
  const std::int8_t* w = layer.weights;
  for (int o = 0; o < layer.rows; ++o) {
    const std::int8_t* const end = w + 4 * groups;
    const std::uint32_t* x = pairs;
    std::int32_t s0 = bias[o];
    std::int32_t s1 = bias[bias_stride + o];
    std::int32_t s2 = bias[2 * bias_stride + o];
    std::uint32_t even = 0;
    std::uint32_t odd = 0;
    std::uint32_t p = 0;
    std::uint32_t q = 0;
    if (groups % 4 == 0) {
      asm volatile("1:\n" S4TP_THREE S4TP_THREE S4TP_THREE S4TP_THREE "cmp %[w], %[end]\nbne 1b\n"
                   : [s0] "+&r"(s0), [s1] "+&r"(s1), [s2] "+&r"(s2), [w] "+&r"(w), [x] "+&r"(x),
                     [even] "=&r"(even), [odd] "=&r"(odd), [p] "=&r"(p), [q] "=&r"(q)
                   : [end] "r"(end)
                   : "cc", "memory");
    } else {
      asm volatile("1:\n" S4TP_THREE "cmp %[w], %[end]\nbne 1b\n"
                   : [s0] "+&r"(s0), [s1] "+&r"(s1), [s2] "+&r"(s2), [w] "+&r"(w), [x] "+&r"(x),
                     [even] "=&r"(even), [odd] "=&r"(odd), [p] "=&r"(p), [q] "=&r"(q)
                   : [end] "r"(end)
                   : "cc", "memory");
    }
    sums[0][o] = s0;
    sums[1][o] = s1;
    sums[2][o] = s2;
  }
}

#undef S4TP_TWO_ROWS
#undef S4TP_SECOND_ROW
#undef S4TP_THREE
#undef S4TP_INPUT
#undef S4TP_WEIGHTS

template <typename In>
void multiply_all(const Linear& layer, const std::int32_t* bias, int bias_stride, const In* inputs,
                  int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  static_assert(kMaxBatch == 3);
  std::uint32_t pairs[kMaxGroups * kMaxBatch * 2];
  const int groups = layer.stride / 4;
  if (batch == kMaxBatch) {
    for (int b = 0; b < kMaxBatch; ++b) {
      const In* input = inputs + b * input_stride;
      std::uint32_t* pair = pairs + 2 * b;
      for (int g = 0; g < groups; ++g, input += 4, pair += 2 * kMaxBatch) pair_up(input, pair, pair + 1);
    }
    multiply_three(layer, bias, bias_stride, pairs, groups, sums);
    return;
  }
  for (int b = 0; b < batch; ++b) {
    const In* input = inputs + b * input_stride;
    std::uint32_t* pair = pairs;
    for (int g = 0; g < groups; ++g, input += 4, pair += 2) pair_up(input, pair, pair + 1);
    multiply_one(layer, bias + b * bias_stride, pairs, groups, sums[b]);
  }
}

#else

// In the order compilers make vectors of.
template <typename In>
void multiply_all(const Linear& layer, const std::int32_t* bias, int bias_stride, const In* inputs,
                  int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  for (int b = 0; b < batch; ++b) {
    const In* input = inputs + b * input_stride;
    for (int o = 0; o < layer.rows; ++o) {
      const std::int8_t* weights = layer.weights + o * layer.stride;
      std::int32_t sum = 0;
      for (int j = 0; j < layer.columns; ++j)
        sum += static_cast<std::int16_t>(weights[j]) * static_cast<std::int16_t>(input[j]);
      sums[b][o] = bias[b * bias_stride + o] + sum;
    }
  }
}

#endif

}  // namespace

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int8_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  multiply_all(layer, bias, bias_stride, inputs, input_stride, batch, sums);
}

void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int16_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]) {
  multiply_all(layer, bias, bias_stride, inputs, input_stride, batch, sums);
}

}  // namespace s4tp::satp
