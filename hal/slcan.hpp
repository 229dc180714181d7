#pragma once
/// SLCAN, the ASCII protocol of serial CAN adapters (Lawicel): a frame as a line, and frames out of a stream.
///
/// \code
///   t iii l dd..dd CR    data frame: 11-bit id, length 0 .. 8, bytes; four digits of a time may follow
///   T r R                29-bit ids and remote frames: recognised, never taken for one of ours
///   CR, z CR, Z CR       the adapter did what it was told        BEL    it did not
///   S O L C V N F M X .. commands to an adapter, and its answers
/// \endcode
/// Needs 10 bits of the line for each of up to 22 characters a frame: 1 Mbaud or more for a bus of ours.

#include <cstdint>

#include "hal/can.hpp"

namespace s4tp::hal {

inline constexpr int kSlcanLineSize = 22;  ///< t, 3 digits, length, 16 digits, CR
inline constexpr std::uint32_t kSlcanLeastBaud = 1'000'000;

/// SLCAN-001 Writes the line of a classic data frame with an 11-bit id, CR included, no zero at the end.
/// \return its length; 0, nothing written, for any other frame
[[nodiscard]] int format_slcan(const CanFrame& frame, char (&line)[kSlcanLineSize]);

/// What a character completed.
enum class SlcanEvent : std::uint8_t {
  kNothing = 0,
  kFrame = 1,    ///< SLCAN-002 a data frame with an 11-bit id
  kForeign = 2,  ///< SLCAN-003 a well-formed frame of another kind: 29-bit id, remote
  kDone = 3,     ///< SLCAN-004 the adapter's yes
  kRefused = 4,  ///< SLCAN-005 the adapter's no (BEL); a line begun before it is forgotten
  kCommand = 5,  ///< SLCAN-006 a command, or an answer to one
  kGarbage = 6,  ///< SLCAN-007 anything else, overlong lines too; what follows its CR is read as ever
};

/// Takes a stream character by character.
class SlcanParser {
 public:
  /// \param frame  written only with kFrame
  [[nodiscard]] SlcanEvent take(char character, CanFrame& frame);

 private:
  [[nodiscard]] SlcanEvent judge(CanFrame& frame) const;

  static constexpr int kLongest = 31;  ///< T, 8 digits, length, 16 digits, 4 of time; and one to spare
  char line_[kLongest] = {};
  int size_ = 0;  ///< kLongest + 1: overlong
};

/// SLCAN-008 Knows when a data frame of one 11-bit id ends in a stream, and nothing else about it: for an interrupt that
/// notes when frames arrive.
class SlcanWatch {
 public:
  explicit SlcanWatch(std::uint32_t id) : id_(id) {}
  /// \return whether this character ends such a line
  [[nodiscard]] bool take(char character);

 private:
  static constexpr int kBegin = 4;  ///< t and three digits
  std::uint32_t id_;
  int matched_ = 0;  ///< characters of the begin; -1: the line is another one
};

}  // namespace s4tp::hal
