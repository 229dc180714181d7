#include "hal/slcan.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace s4tp::hal {
namespace {

CanFrame frame_of(std::uint32_t id, const std::vector<std::uint8_t>& data) {
  CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) frame.data[i] = data[i];
  return frame;
}

std::string text_of(const CanFrame& frame) {
  char line[kSlcanLineSize];
  return std::string(line, static_cast<std::size_t>(format_slcan(frame, line)));
}

struct Stream {
  std::vector<SlcanEvent> events;
  std::vector<CanFrame> frames;

  explicit Stream(const std::string& text) {
    SlcanParser parser;
    for (const char character : text) {
      CanFrame frame;
      const SlcanEvent event = parser.take(character, frame);
      if (event != SlcanEvent::kNothing) events.push_back(event);
      if (event == SlcanEvent::kFrame) frames.push_back(frame);
    }
  }
};

SlcanEvent only_event(const std::string& text) {
  const Stream stream(text);
  EXPECT_EQ(stream.events.size(), 1U) << text;
  return stream.events.empty() ? SlcanEvent::kNothing : stream.events[0];
}

// SLCAN-001 The line of the Lawicel manual's kind: t, id 008, 8 bytes, CR: 1 + 3 + 1 + 16 + 1 = 22
// characters.
TEST(Slcan, WritesAFrame) {
  EXPECT_EQ(text_of(frame_of(0x008, {0xDE, 0xAD, 0, 1, 2, 3, 4, 0xFF})), "t0088DEAD0001020304FF\r");
  EXPECT_EQ(text_of(frame_of(0x7FF, {})), "t7FF0\r");
}

// SLCAN-001 What has no such line is not written: 29-bit ids, FD lengths.
TEST(Slcan, WritesNothingElse) {
  EXPECT_EQ(text_of(frame_of(0x800, {1})), "");
  EXPECT_EQ(text_of(frame_of(0x010, std::vector<std::uint8_t>(12))), "");
}

// SLCAN-002 With and without the adapter's time, digits of either case.
TEST(Slcan, ReadsAFrame) {
  for (const char* line : {"t1232BEEF\r", "t1232beef\r", "t1232BEEF1A2B\r", "\nt1232BEEF\r"}) {
    const Stream stream(line);
    ASSERT_EQ(stream.frames.size(), 1U) << line;
    EXPECT_EQ(stream.frames[0].id, 0x123U);
    EXPECT_EQ(stream.frames[0].length, 2);
    EXPECT_EQ(stream.frames[0].data[0], 0xBE);
    EXPECT_EQ(stream.frames[0].data[1], 0xEF);
  }
}

// SLCAN-003 Id 0x10 with 29 bits is another message than id 0x10 with 11; a remote frame carries no data.
TEST(Slcan, ForeignFramesAreNotOurs) {
  EXPECT_EQ(only_event("T000000108000102030405060 7\r"), SlcanEvent::kGarbage);
  EXPECT_EQ(only_event("T0000001080001020304050607\r"), SlcanEvent::kForeign);
  EXPECT_EQ(only_event("r0108\r"), SlcanEvent::kForeign);
  EXPECT_EQ(only_event("R000000108\r"), SlcanEvent::kForeign);
}

// SLCAN-004, SLCAN-005 Yes and no; a no in the middle of a line ends that line.
TEST(Slcan, AnswersOfAnAdapter) {
  EXPECT_EQ(only_event("\r"), SlcanEvent::kDone);
  EXPECT_EQ(only_event("z\r"), SlcanEvent::kDone);
  EXPECT_EQ(only_event("Z\r"), SlcanEvent::kDone);
  EXPECT_EQ(only_event("\a"), SlcanEvent::kRefused);
  const Stream stream("t0108\at1230\r");
  ASSERT_EQ(stream.events, (std::vector{SlcanEvent::kRefused, SlcanEvent::kFrame}));
  EXPECT_EQ(stream.frames[0].id, 0x123U);
}

// SLCAN-006 The other end may be told things meant for an adapter, or answer a question.
TEST(Slcan, CommandsAreRecognised) {
  for (const char* line : {"S6\r", "O\r", "C\r", "V1013\r", "NA123\r", "F00\r", "M00000000\r"}) {
    EXPECT_EQ(only_event(line), SlcanEvent::kCommand) << line;
  }
}

// SLCAN-007 One malformed line each: nothing is read from it.
TEST(Slcan, GarbageIsNoFrame) {
  for (const char* line :
       {"t010\r", "t0109000000000000000000\r", "t01010\r", "t0101000\r", "t010200010\r", "tG1000\r",
        "t8000\r", "s4tp ecu: kOk\r", "hello\r", "t0101000000000000000000000000000000000000000000\r"}) {
    EXPECT_EQ(only_event(line), SlcanEvent::kGarbage) << line;
  }
}

// SLCAN-007 A line of any length is one piece of garbage, and the line after it is read.
TEST(Slcan, OverlongLinesEndAtTheirCr) {
  const Stream stream("t010" + std::string(100'000, '0') + "\rt1230\r");
  ASSERT_EQ(stream.events, (std::vector{SlcanEvent::kGarbage, SlcanEvent::kFrame}));
  EXPECT_EQ(stream.frames[0].id, 0x123U);
}

// SLCAN-002 A frame is written only with its event: half a line leaves the caller's frame alone.
TEST(Slcan, HalfALineIsNothingYet) {
  SlcanParser parser;
  CanFrame frame = frame_of(0x7AA, {1, 2, 3});
  for (const char character : std::string("t1232BEEF")) {
    EXPECT_EQ(parser.take(character, frame), SlcanEvent::kNothing);
  }
  EXPECT_EQ(frame.id, 0x7AAU);
  EXPECT_EQ(parser.take('\r', frame), SlcanEvent::kFrame);
  EXPECT_EQ(frame.id, 0x123U);
}

// SLCAN-008 Of many lines only those of the id asked for end one, in capitals or not, and of these all; what an adapter's
// no cuts off, another id that begins alike, and the id inside another line do not count.
TEST(Slcan, WatchSeesTheEndOfItsLines) {
  const auto ends = [](std::uint32_t id, const std::string& stream) {
    SlcanWatch watch(id);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < stream.size(); ++i) {
      if (watch.take(stream[i])) found.push_back(i);
    }
    return found;
  };
  EXPECT_EQ(ends(0x010, "t0100\rt0110\r\rz\rt0102BEEF\r"), (std::vector<std::size_t>{5, 24}));
  EXPECT_EQ(ends(0x2AF, "t2af0\rt2AF0\r\nt2AF0\r"), (std::vector<std::size_t>{5, 11, 18}));
  EXPECT_EQ(ends(0x010, "t010\a0\rt01\rT000000101000\rxt0100\rr0100\rt1108t0100000\r"),
            std::vector<std::size_t>{});
}

}  // namespace
}  // namespace s4tp::hal
