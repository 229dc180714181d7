#pragma once
/// candump's log format, one frame a line: "(1700000000.010000) can0 010#0102030405060708".
/// Read and written without heap, so that an image can replay a log too. Classic data frames with 11-bit ids
/// only; a direction (" R" or " T") at the end is read over.

#include <cstdint>

#include "firmware/wire/frame.hpp"

namespace s4tp::wire {

struct LoggedFrame {
  std::uint64_t time_us = 0;
  char interface[16] = {};
  Frame frame;
};

enum class CandumpResult : std::uint8_t {
  kFrame = 0,      ///< WIRE-040 a frame was read
  kSkipped = 1,    ///< WIRE-041 blank or comment line (# at the start)
  kMalformed = 2,  ///< WIRE-042 neither; nothing was changed
};

/// \param line  one line without its end; `size` characters
[[nodiscard]] CandumpResult parse_candump(const char* line, int size, LoggedFrame& logged);

inline constexpr int kCandumpLineSize = 80;
/// An empty interface name is written as can0. \pre logged.frame.id < 0x800, logged.frame.length <= 8
/// \return length of the line written (no line end, zero terminated)
int format_candump(const LoggedFrame& logged, char (&line)[kCandumpLineSize]);

}  // namespace s4tp::wire
