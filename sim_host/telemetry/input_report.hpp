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

/// TELE-043 How often messages of a topic are taken: 40 ms apart. While more than 25 come in a second, none
/// is, until a second has passed in which fewer came. The first of a flood is taken: nobody knows it yet.
class RateGuard {
 public:
  static constexpr std::uint32_t kApartMs = 40;
  static constexpr std::uint32_t kWindowMs = 1000;
  static constexpr std::uint32_t kMostInWindow = 25;

  [[nodiscard]] bool admits(std::uint32_t now_ms) {
    const std::uint32_t passed_ms = now_ms - window_ms_;
    if (!begun_ || passed_ms >= kWindowMs) {
      flooded_ = begun_ && passed_ms < 2 * kWindowMs && count_ > kMostInWindow;
      window_ms_ = now_ms;
      count_ = 0;
    }
    flooded_ = ++count_ > kMostInWindow || flooded_;
    if (flooded_ || (begun_ && now_ms - admitted_ms_ < kApartMs)) return false;
    begun_ = true;
    admitted_ms_ = now_ms;
    return true;
  }

 private:
  bool begun_ = false;
  bool flooded_ = false;
  std::uint32_t window_ms_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t admitted_ms_ = 0;
};

}  // namespace s4tp::telemetry
