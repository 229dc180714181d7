#include "algo/satp/softmax.hpp"

#include "algo/satp/activation.hpp"
#include "algo/satp/requantize.hpp"

namespace s4tp::satp {

std::int32_t softmax(const std::int32_t* scores, int count, std::uint32_t mask, std::int32_t multiplier,
                     std::int32_t* weights) {
  std::int32_t largest = 0;
  bool any = false;
  for (int j = 0; j < count; ++j) {
    if ((mask >> j & 1U) == 0U || (any && scores[j] <= largest)) continue;
    largest = scores[j];
    any = true;
  }
  std::int32_t sum = 0;
  for (int j = 0; j < count; ++j) {
    weights[j] = (mask >> j & 1U) == 0U ? 0 : exp_minus_q15(requantize(largest - scores[j], multiplier));
    sum += weights[j];
  }
  return sum;
}

}  // namespace s4tp::satp
