#pragma once
/// Holds the network's elementwise arithmetic of this processor against its plain words, on random numbers and
/// on those at the ends of their ranges.

#include <cstdint>
#include <cstring>

#include "algo/satp/lanes.hpp"
#include "tests/support/random_network.hpp"

namespace s4tp::test {

/// Too large for a small stack: keep it in static memory.
class LaneAgreement {
 public:
  /// \return name of the first function that differs, or null
  const char* first_difference(std::uint64_t seed, int rounds) {
    Random random(seed);
    for (int round = 0; round < rounds; ++round) {
      fill(random);
      const char* name = differing(random);
      if (name != nullptr) return name;
    }
    return nullptr;
  }

 private:
  static constexpr int kCount = 48;
  static constexpr int kKeys = 17;
  static constexpr int kSize = kCount * kKeys;

  // Every third number at an end of its range.
  static int number(Random& random, int low, int high) {
    const int kind = random.integer(0, 5);
    return kind == 0 ? low : (kind == 1 ? high : random.integer(low, high));
  }
  template <typename T>
  static void fill(Random& random, T* values, int count, int low, int high) {
    for (int i = 0; i < count; ++i) values[i] = static_cast<T>(number(random, low, high));
  }
  template <typename T>
  static bool same(const T* a, const T* b, int count) {
    return std::memcmp(a, b, sizeof(T) * static_cast<unsigned>(count)) == 0;
  }
  void fill(Random& random) {
    for (satp::Stretch& stretch : table_) {
      stretch.value = static_cast<std::int16_t>(number(random, -32768, 32767));
      stretch.rise = static_cast<std::int16_t>(number(random, 0, 32767));
    }
    fill(random, any_, kCount, -32768, 32767);
    fill(random, other_, kCount, -32768, 32767);
    fill(random, share_, kCount, 0, 32767);
    fill(random, positive_, kCount, 0, 32767);
    fill(random, bytes_, kSize, -128, 127);
    fill(random, weights_, kKeys, 0, 32767);
    fill(random, words_, kCount, -131071, 131071);
    fill(random, gains_, kCount, -65536, 65536);
    for (std::int32_t& bias : biases_)
      bias = random.integer(0, 3) == 0 ? 2147483647 : static_cast<std::int32_t>(random.next());
  }

  const char* differing(Random& random) {
    namespace lanes = satp::lanes;
    namespace plain = satp::plain;
    const int share = number(random, 0, 32767);
    const int multiplier = static_cast<int>(random.next() >> 1U);

    begin16();
    lanes::look_up(table_, fast16_, kCount);
    plain::look_up(table_, plain16_, kCount);
    if (!same(fast16_, plain16_, kCount)) return "look_up";
    begin16();
    lanes::add_shares(share_, other_, kCount, fast16_);
    plain::add_shares(share_, other_, kCount, plain16_);
    if (!same(fast16_, plain16_, kCount)) return "add_shares";
    begin16();
    lanes::blend(share_, other_, kCount, fast16_);
    plain::blend(share_, other_, kCount, plain16_);
    if (!same(fast16_, plain16_, kCount)) return "blend";

    lanes::narrow(any_, kCount, fast8_);
    plain::narrow(any_, kCount, plain8_);
    if (!same(fast8_, plain8_, kCount)) return "narrow";
    lanes::mix(positive_, share_, share, multiplier >> 6, kCount, fast8_);
    plain::mix(positive_, share_, share, multiplier >> 6, kCount, plain8_);
    if (!same(fast8_, plain8_, kCount)) return "mix";

    lanes::add_rescaled(bytes_, multiplier, any_, kCount, fast32_);
    plain::add_rescaled(bytes_, multiplier, any_, kCount, plain32_);
    if (!same(fast32_, plain32_, kCount)) return "add_rescaled";
    std::memcpy(fast32_, words_, sizeof words_);
    std::memcpy(plain32_, words_, sizeof words_);
    if (lanes::centre(fast32_, kCount) != plain::centre(plain32_, kCount) || !same(fast32_, plain32_, kCount))
      return "centre";
    const int shift = random.integer(0, 13);
    lanes::scale(words_, shift, multiplier >> 15, gains_, biases_, kCount, fast8_);
    plain::scale(words_, shift, multiplier >> 15, gains_, biases_, kCount, plain8_);
    if (!same(fast8_, plain8_, kCount)) return "scale";

    const int keys = random.integer(1, kKeys);
    lanes::score(bytes_, {bytes_ + 8, kCount}, keys - 1, fast32_);
    plain::score(bytes_, {bytes_ + 8, kCount}, keys - 1, plain32_);
    if (!same(fast32_, plain32_, keys - 1)) return "score";
    lanes::weigh(weights_, {bytes_ + 8, 32}, keys, fast_sums_);
    plain::weigh(weights_, {bytes_ + 8, 32}, keys, plain_sums_);
    if (!same(fast_sums_, plain_sums_, satp::kHeadWidth)) return "weigh";
    return nullptr;
  }

  void begin16() {
    std::memcpy(fast16_, any_, sizeof any_);
    std::memcpy(plain16_, any_, sizeof any_);
  }

  satp::Stretch table_[256];
  alignas(8) std::int16_t any_[kCount], other_[kCount], share_[kCount], positive_[kCount];
  alignas(8) std::int16_t fast16_[kCount], plain16_[kCount];
  alignas(8) std::int8_t bytes_[kSize], fast8_[kCount], plain8_[kCount];
  std::int32_t weights_[kKeys], words_[kCount], gains_[kCount], biases_[kCount];
  std::int32_t fast32_[kCount], plain32_[kCount];
  std::int32_t fast_sums_[satp::kHeadWidth], plain_sums_[satp::kHeadWidth];
};

}  // namespace s4tp::test
