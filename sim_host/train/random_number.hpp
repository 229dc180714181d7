#pragma once
/// Random numbers as a function of what they are for, so that nothing depends on what was drawn before: a
/// training that goes on after an interruption draws what it would have drawn.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace s4tp::train {

/// 64 even bits out of a seed and an index (SplitMix64's finalizer, Steele et al. 2014, applied to both).
[[nodiscard]] constexpr std::uint64_t random_number(std::uint64_t seed, std::uint64_t index) {
  auto mix = [](std::uint64_t x) {
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
  };
  return mix(mix(seed + 0x9E3779B97F4A7C15ULL) + index * 0x9E3779B97F4A7C15ULL);
}

/// Even in 0 .. 1, without 1.
[[nodiscard]] constexpr double random_share(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(random_number(seed, index) >> 11U) * 0x1p-53;
}

/// `items` in a random order of their own for each seed (Fisher and Yates).
template <class T>
void shuffle(std::vector<T>& items, std::uint64_t seed) {
  for (std::size_t i = items.size(); i > 1; --i) {
    std::swap(items[i - 1], items[random_number(seed, i) % i]);
  }
}

}  // namespace s4tp::train
