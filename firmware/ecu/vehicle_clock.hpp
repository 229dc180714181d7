#pragma once
/// Vehicle time: the motion frame's 16-bit milliseconds, extended to 32 bit. ECU-072 Those wrap, after 49.7
/// days: times are compared by their difference, and ages are counted, not subtracted.

#include <cstdint>

#include "algo/core/vehicle_time.hpp"

namespace s4tp::ecu {

inline constexpr std::uint32_t kTickMs = 10;            ///< control period
inline constexpr std::uint32_t kNeverMs = 0xFFFFFFFFU;  ///< age of what has not been seen yet

/// How long ago something was, however long that is.
class Age {
 public:
  void renew() { ms_ = 0; }
  void pass(std::uint32_t duration_ms) {
    if (ms_ == kNeverMs) return;
    ms_ = ms_ < kOldestMs - duration_ms ? ms_ + duration_ms : kOldestMs;
  }
  [[nodiscard]] std::uint32_t ms() const { return ms_; }
  [[nodiscard]] bool known() const { return ms_ != kNeverMs; }

 private:
  static constexpr std::uint32_t kOldestMs = kNeverMs - 1U;
  std::uint32_t ms_ = kNeverMs;
};

class VehicleClock {
 public:
  /// A valid motion frame's stamp. ECU-070 Time never runs back: a stamp not later than the one before lets
  /// one tick pass and counts from there. \return interval to the stamp before [ms]; 10 for the first
  std::int32_t update(std::uint16_t stamp_ms);

  /// ECU-071 A tick without a valid motion frame: time goes on by one tick, and joins the stamps again when
  /// they return.
  void coast();

  [[nodiscard]] std::uint32_t now_ms() const { return now_ms_; }
  [[nodiscard]] bool started() const { return started_; }

  /// The full time of a 16-bit stamp within half a turn of now.
  [[nodiscard]] std::uint32_t extend(std::uint16_t stamp_ms) const;

 private:
  bool started_ = false;
  std::uint16_t last_stamp_ms_ = 0;
  std::uint32_t last_ms_ = 0;  ///< full time of last_stamp_ms_
  std::uint32_t now_ms_ = 0;
};

}  // namespace s4tp::ecu
