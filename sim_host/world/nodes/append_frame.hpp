#pragma once
/// How a node of the world says something: encoded, protected, behind what it has said so far.

#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::nodes {

/// A message with a value that the wire cannot carry is not said.
template <class Message>
void append(const Message& message, wire::E2eSender& sender, std::vector<wire::Frame>& frames) {
  wire::Frame frame;
  if (!wire::encode(message, frame)) return;
  sender.protect(frame);
  frames.push_back(frame);
}

}  // namespace s4tp::nodes
