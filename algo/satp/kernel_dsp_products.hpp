#pragma once
/// Two rows of weights against a batch of inputs, on Cortex-M with the DSP extension. Internal: for
/// kernel_dsp.hpp, which says how weights and inputs stand in words.

#include <cstdint>

namespace s4tp::satp::dsp {

// Two rows of weights against a batch of two or three inputs, by hand, because the compiler keeps what it
// should load twice and spills what it should keep. All fourteen registers are taken, so that the rows'
// distance and the end wait in those of floating point.
#define S4TP_ROWS_ANYWHERE            \
  "vmov r0, %[distance]\n"            \
  "ldr %[second], [%[weights], r0]\n" \
  "ldr %[first], [%[weights]], #4\n"
#define S4TP_ROWS_KNOWN                          \
  "ldr %[second], [%[weights], #%c[distance]]\n" \
  "ldr %[first], [%[weights]], #4\n"
#define S4TP_ADD(sum, weights, input) "smlad %[" sum "], %[" weights "], " input ", %[" sum "]\n"
#define S4TP_TIMES_2(row, weights) S4TP_ADD(row "0", weights, "r0") S4TP_ADD(row "1", weights, "r1")
#define S4TP_TIMES_3(row, weights) S4TP_TIMES_2(row, weights) S4TP_ADD(row "2", weights, "r2")
#define S4TP_LOAD(inputs) "ldm %[pairs]!, {" inputs "}\n"
#define S4TP_EVEN(to, from) "sxtb16 %[" to "], %[" from "]\n"
#define S4TP_ODD(to, from) "sxtb16 %[" to "], %[" from "], ror #8\n"
#define S4TP_FOUR_COLUMNS(rows, inputs, times)                                                     \
  rows S4TP_LOAD(inputs) S4TP_EVEN("part", "first") times("a", "part") S4TP_EVEN("part", "second") \
      times("b", "part") S4TP_LOAD(inputs) S4TP_ODD("first", "first") times("a", "first")          \
          S4TP_ODD("second", "second") times("b", "second")
#define S4TP_2 S4TP_FOUR_COLUMNS(S4TP_ROWS_ANYWHERE, "r0, r1", S4TP_TIMES_2)
#define S4TP_3 S4TP_FOUR_COLUMNS(S4TP_ROWS_ANYWHERE, "r0, r1, r2", S4TP_TIMES_3)
#define S4TP_3_KNOWN S4TP_FOUR_COLUMNS(S4TP_ROWS_KNOWN, "r0, r1, r2", S4TP_TIMES_3)
#define S4TP_LOOP(body)     \
  "1:\n" body               \
  "vmov %[part], %[end]\n"  \
  "cmp %[pairs], %[part]\n" \
  "bne 1b\n"
#define S4TP_ASM(body, apart, ...)                                                      \
  asm volatile(body                                                                     \
               : __VA_ARGS__, [weights] "+r"(w), [pairs] "+r"(x), [first] "=&r"(first), \
                 [second] "=&r"(second), [part] "=&r"(part)                             \
               : [distance] apart, [end] "t"(end)                                       \
               : "cc", "memory", "r0", "r1", "r2")

/// Adds the products of two rows, `distance` bytes apart, and `kBatch` inputs to their sums.
/// \tparam kStride  of the rows, when it is known: 8, 12 or a multiple of 16; otherwise 0
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
    if constexpr (kStride == 8) {
      S4TP_ASM(S4TP_3_KNOWN S4TP_3_KNOWN, "i"(kStride), [a0] "+r"(a0), [a1] "+r"(a1), [a2] "+r"(a2),
               [b0] "+r"(b0), [b1] "+r"(b1), [b2] "+r"(b2));
    } else if constexpr (kStride == 12) {
      S4TP_ASM(S4TP_3_KNOWN S4TP_3_KNOWN S4TP_3_KNOWN, "i"(kStride), [a0] "+r"(a0), [a1] "+r"(a1),
               [a2] "+r"(a2), [b0] "+r"(b0), [b1] "+r"(b1), [b2] "+r"(b2));
    } else if constexpr (kStride != 0) {
      S4TP_ASM(S4TP_LOOP(S4TP_3_KNOWN S4TP_3_KNOWN S4TP_3_KNOWN S4TP_3_KNOWN), "i"(kStride), [a0] "+r"(a0),
               [a1] "+r"(a1), [a2] "+r"(a2), [b0] "+r"(b0), [b1] "+r"(b1), [b2] "+r"(b2));
    } else if (by_sixteen) {
      S4TP_ASM(S4TP_LOOP(S4TP_3 S4TP_3 S4TP_3 S4TP_3), "t"(distance), [a0] "+r"(a0), [a1] "+r"(a1),
               [a2] "+r"(a2), [b0] "+r"(b0), [b1] "+r"(b1), [b2] "+r"(b2));
    } else {
      S4TP_ASM(S4TP_LOOP(S4TP_3), "t"(distance), [a0] "+r"(a0), [a1] "+r"(a1), [a2] "+r"(a2), [b0] "+r"(b0),
               [b1] "+r"(b1), [b2] "+r"(b2));
    }
    a[2] = a2;
    b[2] = b2;
  } else {
    S4TP_ASM(S4TP_LOOP(S4TP_2), "t"(distance), [a0] "+r"(a0), [a1] "+r"(a1), [b0] "+r"(b0), [b1] "+r"(b1));
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
#undef S4TP_ODD
#undef S4TP_EVEN
#undef S4TP_LOAD
#undef S4TP_TIMES_3
#undef S4TP_TIMES_2
#undef S4TP_ADD
#undef S4TP_ROWS_KNOWN
#undef S4TP_ROWS_ANYWHERE

}  // namespace s4tp::satp::dsp
