#pragma once
/// A classic CAN frame as both ends of the bus see it.

#include <cstdint>

namespace s4tp::wire {

struct Frame {
  std::uint32_t id = 0;     ///< 11 bit
  std::uint8_t length = 0;  ///< 0 .. 8; every message of s4tp.dbc has 8
  std::uint8_t data[8] = {};
};

}  // namespace s4tp::wire
