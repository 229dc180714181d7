#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstring>
#include <string>
#include <vector>

#include "hal/slcan.hpp"

namespace s4tp::hal {
namespace {

CanFrame any_frame() {
  CanFrame frame;
  frame.id = *rc::gen::inRange(0U, 0x800U);
  frame.length = static_cast<std::uint8_t>(*rc::gen::inRange(0, 9));
  for (int i = 0; i < frame.length; ++i) frame.data[i] = *rc::gen::arbitrary<std::uint8_t>();
  return frame;
}

std::string text_of(const CanFrame& frame) {
  char line[kSlcanLineSize];
  return std::string(line, static_cast<std::size_t>(format_slcan(frame, line)));
}

bool same(const CanFrame& a, const CanFrame& b) {
  return a.id == b.id && a.length == b.length && std::memcmp(a.data, b.data, sizeof a.data) == 0;
}

std::vector<CanFrame> frames_in(const std::string& text) {
  SlcanParser parser;
  std::vector<CanFrame> frames;
  for (const char character : text) {
    CanFrame frame;
    if (parser.take(character, frame) == SlcanEvent::kFrame) frames.push_back(frame);
  }
  return frames;
}

// SLCAN-001, SLCAN-002 What is written is read back, however many frames follow one another.
TEST(SlcanProperty, RoundTrip) {
  EXPECT_TRUE(rc::check([] {
    const auto count = *rc::gen::inRange<std::size_t>(0, 20);
    std::vector<CanFrame> sent;
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
      sent.push_back(any_frame());
      text += text_of(sent.back());
    }
    const std::vector<CanFrame> read = frames_in(text);
    RC_ASSERT(read.size() == count);
    for (std::size_t i = 0; i < count; ++i) RC_ASSERT(same(read[i], sent[i]));
  }));
}

// SLCAN-007 Any bytes at all before a CR cost at most what stands before it: the next frame arrives whole.
TEST(SlcanProperty, GarbageDoesNotReachTheNextLine) {
  EXPECT_TRUE(rc::check([] {
    const auto garbage = *rc::gen::container<std::string>(rc::gen::arbitrary<char>());
    const CanFrame frame = any_frame();
    const std::vector<CanFrame> read = frames_in(garbage + "\r" + text_of(frame));
    RC_ASSERT(!read.empty());
    RC_ASSERT(same(read.back(), frame));
  }));
}

// SLCAN-002 Whatever is read as a frame is one: an 11-bit id, at most 8 bytes, zeros behind them. The text is
// made of lines that were right before up to three characters were put into them.
TEST(SlcanProperty, WhatIsReadIsAFrame) {
  EXPECT_TRUE(rc::check([] {
    std::string text;
    for (int line = *rc::gen::inRange(1, 8); line > 0; --line) {
      std::string one = text_of(any_frame());
      for (int change = *rc::gen::inRange(0, 4); change > 0; --change) {
        const auto where = *rc::gen::inRange<std::size_t>(0, one.size());
        one.insert(where, 1,
                   *rc::gen::element('t', 'T', 'r', 'z', '0', '8', '9', 'A', 'f', 'G', '\r', '\a', '\n'));
      }
      text += one;
    }
    const std::vector<CanFrame> read = frames_in(text);
    RC_CLASSIFY(!read.empty(), "some frame read");
    for (const CanFrame& frame : read) {
      RC_ASSERT(frame.id < 0x800U);
      RC_ASSERT(frame.length <= 8);
      for (int i = frame.length; i < 64; ++i) RC_ASSERT(frame.data[i] == 0);
    }
  }));
}

// SLCAN-007 A line with one character changed is garbage, foreign, or a frame; never two, never a crash.
TEST(SlcanProperty, OneBadCharacterCostsAtMostOneFrame) {
  EXPECT_TRUE(rc::check([] {
    const CanFrame first = any_frame();
    const CanFrame second = any_frame();
    std::string text = text_of(first);
    const auto where = *rc::gen::inRange<std::size_t>(0, text.size() - 1);
    text[where] = *rc::gen::distinctFrom(rc::gen::arbitrary<char>(), '\r');
    const std::vector<CanFrame> read = frames_in(text + text_of(second));
    RC_ASSERT(read.size() >= 1U);
    RC_ASSERT(read.size() <= 2U);
    RC_ASSERT(same(read.back(), second));
  }));
}

}  // namespace
}  // namespace s4tp::hal
