#pragma once
/// A sender of maps and who receives them.

#include <gtest/gtest.h>

#include "firmware/wire/lane_map.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::wire {

inline constexpr std::uint32_t kTick_ms = 10;

class LaneMapTest : public ::testing::Test {
 protected:
  /// Lets time pass. `pass` decides which frames get through. \return how many maps became whole
  template <typename Pass>
  int run(std::uint32_t duration_ms, int pace, Pass pass) {
    int maps = 0;
    for (const std::uint32_t end_ms = now_ms_ + duration_ms; now_ms_ != end_ms; now_ms_ += kTick_ms) {
      for (const Frame& frame : frames_of(sender_, now_ms_, pace)) {
        if (!pass(frame) || !receiver_.accept(frame)) continue;
        ++maps;
        whole_ms_ = now_ms_;
      }
    }
    return maps;
  }
  int run(std::uint32_t duration_ms, int pace = 10) {
    return run(duration_ms, pace, [](const Frame&) { return true; });
  }

  MapSender sender_;
  MapReceiver receiver_;
  std::uint32_t now_ms_ = 0xFFFFFF00U;  ///< the time wraps soon
  std::uint32_t whole_ms_ = 0;
};

}  // namespace s4tp::wire
