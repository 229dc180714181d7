#include "firmware/wire/candump.hpp"

#include <gtest/gtest.h>

#include <string>

namespace s4tp::wire {
namespace {

CandumpResult parse(const std::string& line, LoggedFrame& logged) {
  return parse_candump(line.data(), static_cast<int>(line.size()), logged);
}

LoggedFrame parsed(const std::string& line) {
  LoggedFrame logged;
  EXPECT_EQ(parse(line, logged), CandumpResult::kFrame) << line;
  return logged;
}

std::string formatted(const LoggedFrame& logged) {
  char line[kCandumpLineSize];
  const int size = format_candump(logged, line);
  EXPECT_EQ(line[size], '\0');
  return {line, static_cast<std::size_t>(size)};
}

// WIRE-040
TEST(Candump, ReadsALine) {
  const LoggedFrame logged = parsed("(1700000000.010000) can0 010#0102030405060708");
  EXPECT_EQ(logged.time_us, 1'700'000'000'010'000U);
  EXPECT_STREQ(logged.interface, "can0");
  EXPECT_EQ(logged.frame.id, 0x010U);
  EXPECT_EQ(logged.frame.length, 8);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(logged.frame.data[i], i + 1);
}

// WIRE-040: small letters, no payload, a direction, blanks around, a line end of another system.
TEST(Candump, ReadsWhatOtherToolsWrite) {
  EXPECT_EQ(parsed("(0.000001) vcan0 7ff#aBcD").frame.data[0], 0xAB);
  EXPECT_EQ(parsed("(0.000001) vcan0 7FF#").frame.length, 0);
  EXPECT_EQ(parsed("(0.000001) vcan0 123#11 R").frame.length, 1);
  EXPECT_EQ(parsed("  (0.000001)  vcan0  123#11 T\r\n").frame.length, 1);
}

// WIRE-041
TEST(Candump, SkipsBlankAndCommentLines) {
  LoggedFrame logged;
  for (const char* line : {"", "   ", "\r\n", "# seed 1", "  # (0.000001) can0 123#11"}) {
    EXPECT_EQ(parse(line, logged), CandumpResult::kSkipped) << line;
  }
}

// WIRE-042: among them extended ids, remote and FD frames, which the wire does not use.
TEST(Candump, MalformedLinesChangeNothing) {
  for (const char* line : {"(1700000000.010000)",
                           "(1700000000.010000) can0",
                           "(1700000000.01) can0 010#01",
                           "1.000000 can0 010#01",
                           "(.000001) can0 010#01",
                           "(1.000000)can0 010#01",
                           "(1.000000) can0 010",
                           "(1.000000) can0 800#01",
                           "(1.000000) can0 10#01",
                           "(1.000000) can0 00000010#01",
                           "(1.000000) can0 010#R",
                           "(1.000000) can0 010##101",
                           "(1.000000) can0 010#0",
                           "(1.000000) can0 010#010203040506070809",
                           "(1.000000) can0 010#0G",
                           "(1.000000) can0 010#01 X",
                           "(1.000000) can0 010#01 R R",
                           "(1.000000) sixteencharacters 010#01",
                           "(99999999999999.000000) can0 010#01",
                           "(18446744073709.551616) can0 010#01"}) {
    LoggedFrame logged{77, "can9", {0x055, 2, {1, 2}}};
    EXPECT_EQ(parse(line, logged), CandumpResult::kMalformed) << line;
    EXPECT_EQ(formatted(logged), "(0000000000.000077) can9 055#0102") << line;
  }
}

// WIRE-040: only `size` characters belong to the line.
TEST(Candump, StopsAtTheEndOfTheLine) {
  const std::string two = "(1.000000) can0 010#0102(2.000000) can0 011#";
  LoggedFrame logged;
  EXPECT_EQ(parse_candump(two.data(), 24, logged), CandumpResult::kFrame);
  EXPECT_EQ(logged.frame.length, 2);
}

TEST(Candump, WritesTheLineItReads) {
  for (const std::string line :
       {"(1700000000.010000) can0 010#0102030405060708", "(0000000000.000000) vcan12 7FF#",
        "(18446744073709.551615) fifteen_letters 000#FFFFFFFFFFFFFFFF"}) {
    EXPECT_EQ(formatted(parsed(line)), line);
  }
}

TEST(Candump, AFrameWithoutInterfaceIsOnCan0) {
  EXPECT_EQ(formatted({10'000, "", {0x013, 1, {0xAA}}}), "(0000000000.010000) can0 013#AA");
}

}  // namespace
}  // namespace s4tp::wire
