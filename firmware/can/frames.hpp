#pragma once
/// The same frame as the wire knows it and as the hardware layer does.

#include "firmware/wire/frame.hpp"
#include "hal/can.hpp"

namespace s4tp {

/// A length past 8 is kept, for the other end to refuse; the bytes are eight at most.
[[nodiscard]] inline hal::CanFrame to_hal(const wire::Frame& frame) {
  hal::CanFrame can;
  can.id = frame.id;
  can.length = frame.length;
  for (int i = 0; i < frame.length && i < 8; ++i) can.data[i] = frame.data[i];
  return can;
}

/// No FD frame is ours: what is longer than 8 bytes has none here, and is no message of s4tp.dbc.
[[nodiscard]] inline wire::Frame to_wire(const hal::CanFrame& can) {
  wire::Frame frame;
  frame.id = can.id;
  frame.length = can.length <= 8 ? can.length : std::uint8_t{0};
  for (int i = 0; i < frame.length; ++i) frame.data[i] = can.data[i];
  return frame;
}

}  // namespace s4tp
