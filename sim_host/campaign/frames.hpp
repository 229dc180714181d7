#pragma once
/// The same frame as the wire knows it and as the hardware layer does.

#include <algorithm>
#include <cstring>

#include "firmware/wire/frame.hpp"
#include "hal/can.hpp"

namespace s4tp::campaign {

inline hal::CanFrame to_hal(const wire::Frame& frame) {
  hal::CanFrame can;
  can.id = frame.id;
  can.length = frame.length;
  std::memcpy(can.data, frame.data, sizeof frame.data);
  return can;
}

/// \pre can.length <= 8
inline wire::Frame to_wire(const hal::CanFrame& can) {
  wire::Frame frame;
  frame.id = can.id;
  frame.length = std::min<std::uint8_t>(can.length, sizeof frame.data);
  std::memcpy(frame.data, can.data, sizeof frame.data);
  return frame;
}

}  // namespace s4tp::campaign
