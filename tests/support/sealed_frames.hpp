#pragma once
/// Frames as one end of the bus sends them.

#include <gtest/gtest.h>

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::test {

template <class Message>
wire::Frame sealed(const Message& message, wire::E2eSender& sender) {
  wire::Frame frame;
  EXPECT_TRUE(wire::encode(message, frame));
  sender.protect(frame);
  return frame;
}

}  // namespace s4tp::test

namespace s4tp::processes {

template <class Message>
hal::CanFrame sealed(const Message& message, wire::E2eSender& sender) {
  return to_hal(test::sealed(message, sender));
}

inline hal::CanFrame hello() {
  wire::E2eSender sender;
  return sealed(wire::VersionEcu{}, sender);
}

inline hal::CanFrame tick_frame(int number, wire::E2eSender& sender) {
  wire::Tick tick;
  tick.tick = static_cast<std::uint16_t>(number);
  return sealed(tick, sender);
}

}  // namespace s4tp::processes
