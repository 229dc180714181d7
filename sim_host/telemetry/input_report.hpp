#pragma once
/// What became of the messages of the input topics.

#include <cstdint>

namespace s4tp::telemetry {

enum class Refusal : std::uint8_t {
  kNone = 0,
  kNotANumber,  ///< NaN or infinite
  kOutOfRange,  ///< no value of the wire's, or one that contradicts another
  kTooMany,     ///< objects, lanes, points or conflicts; too few points, too
  kFrame,       ///< another frame than "odom"
  kStamp,       ///< no time
  kTooOften,
  kCount
};

[[nodiscard]] constexpr const char* refusal_text(Refusal refusal) {
  constexpr const char* kTexts[] = {"taken",       "not a number", "out of range", "wrong count",
                                    "wrong frame", "wrong stamp",  "too often"};
  return kTexts[static_cast<int>(refusal)];
}

struct InputCounts {
  std::uint64_t by[static_cast<int>(Refusal::kCount)] = {};  ///< messages by Refusal
  [[nodiscard]] std::uint64_t taken() const { return by[0]; }
  [[nodiscard]] std::uint64_t refused() const {
    std::uint64_t sum = 0;
    for (int i = 1; i < static_cast<int>(Refusal::kCount); ++i) sum += by[i];
    return sum;
  }
};

struct InputReport {
  InputCounts objects;
  InputCounts maps;
};

}  // namespace s4tp::telemetry
