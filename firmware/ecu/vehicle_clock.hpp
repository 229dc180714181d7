#pragma once
/// Vehicle time: the motion frame's 16-bit milliseconds, extended to 32 bit.

#include <cstdint>

namespace s4tp::ecu {

inline constexpr std::uint32_t kTickMs = 10;  ///< control period

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

  /// The full time of a 16-bit stamp within half a turn of now; 0 for one before the start.
  [[nodiscard]] std::uint32_t extend(std::uint16_t stamp_ms) const;

 private:
  bool started_ = false;
  std::uint16_t last_stamp_ms_ = 0;
  std::uint32_t last_ms_ = 0;  ///< full time of last_stamp_ms_
  std::uint32_t now_ms_ = 0;
};

}  // namespace s4tp::ecu
