#include "firmware/wire/codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>

#include "firmware/wire/generated/s4tp_fields.hpp"
#include "firmware/wire/version.hpp"

namespace s4tp::wire {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string hex(const Frame& frame) {
  std::string text;
  for (const std::uint8_t byte : frame.data) {
    for (const int shift : {4, 0}) text += "0123456789ABCDEF"[(byte >> shift) & 0xF];
  }
  return text;
}

Frame encoded(const auto& message) {
  Frame frame;
  EXPECT_TRUE(encode(message, frame));
  return frame;
}

float speed_limit_after_the_wire(float speed_limit_mps) {
  LaneHeader header;
  header.speed_limit_mps = speed_limit_mps;
  LaneHeader decoded;
  EXPECT_TRUE(decode(encoded(header), decoded));
  return decoded.speed_limit_mps;
}

float origin_after_the_wire(float x_m) {
  MapOrigin origin;
  origin.x_m = x_m;
  MapOrigin decoded;
  EXPECT_TRUE(decode(encoded(origin), decoded));
  return decoded.x_m;
}

// WIRE-002: 0x1234 ms from bit 12, 10 m/s = 2000 steps = 0x7D0 from bit 28, -0.02 m/s^2 = -1 = 0x7FF from bit
// 42, 0.002 rad/s = 1 from bit 53: 0x20'0000'0000'0000 | 0x1F'FC00'0000'0000 | 0x7D'0000'0000 | 0x123'4000.
TEST(Codec, PacksBitsInLittleEndianOrder) {
  Motion motion;
  motion.vehicle_time_ms = 0x1234;
  motion.speed_mps = 10.0F;
  motion.acceleration_mps2 = -0.02F;
  motion.yaw_rate_radps = 0.002F;
  const Frame frame = encoded(motion);
  EXPECT_EQ(frame.id, 0x010U);
  EXPECT_EQ(frame.length, 8);
  EXPECT_EQ(hex(frame), "004023017DFC3F00");
}

// WIRE-002, WIRE-003: every message at its limits and at mixed values, packed by an encoder that is not ours
// (tests/golden/make_wire_frames.py). crc and counter are zero.
TEST(Codec, AgreesWithAnEncoderThatIsNotOurs) {
  std::ifstream golden(S4TP_SOURCE_DIR "/tests/golden/wire_frames.txt");
  int lines = 0;
  for (std::string line; std::getline(golden, line); ++lines) {
    std::istringstream words(line);
    std::string name;
    std::string payload;
    words >> name >> payload;
    std::map<std::string, double> values;
    for (std::string word; words >> word;) {
      values[word.substr(0, word.find('='))] = std::stod(word.substr(word.find('=') + 1));
    }
    for_each_message([&](auto message) {
      Frame id;
      ASSERT_TRUE(encode(message, id));
      if (name != message_name(id.id)) return;
      std::size_t fields = 0;
      for_each_field(message, [&](const FieldInfo& info, auto& field) {
        ++fields;
        field = static_cast<std::remove_reference_t<decltype(field)>>(values.at(info.name));
      });
      EXPECT_EQ(fields, values.size()) << line;
      const Frame frame = encoded(message);
      EXPECT_EQ(hex(frame), payload) << line;
      auto back = decltype(message){};
      ASSERT_TRUE(decode(frame, back)) << line;
      for_each_field(back, [&](const FieldInfo& info, const auto& field) {
        if constexpr (std::is_same_v<decltype(field), const float&>) {
          EXPECT_FLOAT_EQ(field, static_cast<float>(values.at(info.name))) << line;
        } else {
          EXPECT_EQ(field, values.at(info.name)) << line;
        }
      });
    });
  }
  EXPECT_EQ(lines, 6 * static_cast<int>(std::size(kMessages)));
}

// WIRE-002: steps of 0.25: 0.124 is 0.496 steps, 0.125 is a tie and goes up, 0.374 is 1.496 steps.
TEST(Codec, RoundsToTheNearestStep) {
  EXPECT_EQ(speed_limit_after_the_wire(0.124F), 0.0F);
  EXPECT_EQ(speed_limit_after_the_wire(0.125F), 0.25F);
  EXPECT_EQ(speed_limit_after_the_wire(0.374F), 0.25F);
  EXPECT_EQ(speed_limit_after_the_wire(0.375F), 0.5F);
}

// WIRE-002: steps of 0.1: 0.25 and -0.25 are ties, 2.5 steps, and go away from zero.
TEST(Codec, RoundsTiesAwayFromZero) {
  EXPECT_EQ(origin_after_the_wire(0.25F), 0.3F);
  EXPECT_EQ(origin_after_the_wire(-0.25F), -0.3F);
  EXPECT_EQ(origin_after_the_wire(-0.24F), -0.2F);
}

// WIRE-002: 60 m/s is the most a track may have; the next float is refused, and so are NaN and infinity.
TEST(Codec, RefusesWhatLiesOutsideTheRange) {
  TrackMotion motion;
  const Frame untouched{0x123, 1, {9}};
  for (const float speed : {std::nextafter(60.0F, 61.0F), -0.001F, kNan, kInfinity, -kInfinity}) {
    motion.speed_mps = speed;
    Frame frame = untouched;
    EXPECT_FALSE(encode(motion, frame)) << speed;
    EXPECT_EQ(frame.id, untouched.id);
    EXPECT_EQ(frame.length, untouched.length);
    EXPECT_EQ(hex(frame), hex(untouched));
  }
  motion.speed_mps = 60.0F;
  EXPECT_EQ(hex(encoded(motion)), "000000E803000000");
}

// WIRE-002: whole numbers are range checked too: a lane has at most 12 points, a Command's tick 12 bits.
TEST(Codec, RefusesWholeNumbersOutsideTheRange) {
  Frame frame;
  LaneHeader header;
  header.point_count = 13;
  EXPECT_FALSE(encode(header, frame));
  header.point_count = 12;
  header.changes_needed = -9;
  EXPECT_FALSE(encode(header, frame));
  header.changes_needed = -8;
  EXPECT_TRUE(encode(header, frame));
  Command command;
  command.tick = 4096;
  EXPECT_FALSE(encode(command, frame));
}

// WIRE-003: 13 bits hold headings up to 4095 steps; pi would be 4096 and takes the last one: 3.1408.
TEST(Codec, TakesAHeadingUpToPi) {
  constexpr float kPi = 3.14159265F;
  Pose pose;
  Pose decoded;
  pose.heading_rad = kPi;
  ASSERT_TRUE(decode(encoded(pose), decoded));
  EXPECT_NEAR(decoded.heading_rad, 3.1408F, 1e-4F);
  pose.heading_rad = -kPi;
  ASSERT_TRUE(decode(encoded(pose), decoded));
  EXPECT_EQ(decoded.heading_rad, -kPi);
}

// WIRE-003: raw 1001 would be 60.06 m/s: out of range, and the message keeps what it had.
TEST(Codec, DecodingRefusesRawValuesOutsideTheRange) {
  TrackMotion message;
  message.speed_mps = 7.0F;
  message.id = 42;
  Frame frame{kTrackMotionId, 8, {0, 0, 1, 0xE9, 0x03}};
  EXPECT_FALSE(decode(frame, message));
  EXPECT_EQ(message.speed_mps, 7.0F);
  EXPECT_EQ(message.id, 42);
  frame.data[3] = 0xE8;
  EXPECT_TRUE(decode(frame, message));
  EXPECT_EQ(message.speed_mps, 60.0F);
  EXPECT_EQ(message.id, 1);
}

// WIRE-003
TEST(Codec, DecodingRefusesAnotherIdOrLength) {
  Steering message;
  EXPECT_TRUE(decode(Frame{kSteeringId, 8, {}}, message));
  EXPECT_FALSE(decode(Frame{kMotionId, 8, {}}, message));
  EXPECT_FALSE(decode(Frame{kSteeringId, 7, {}}, message));
  EXPECT_FALSE(decode(Frame{kSteeringId, 9, {}}, message));
}

TEST(Codec, NamesItsMessages) {
  EXPECT_STREQ(message_name(kTrackPoseId), "TrackPose");
  EXPECT_STREQ(message_name(0x7FF), "?");
}

// WIRE-050: VERSION of the DBC; that the hash follows the layout is shown where the generator is tested.
TEST(Version, IsWhatTheGeneratorFound) {
  EXPECT_EQ(wire_version(), 8);
  EXPECT_EQ(layout_hash(), kLayoutHash);
  EXPECT_NE(layout_hash(), 0U);
}

}  // namespace
}  // namespace s4tp::wire
