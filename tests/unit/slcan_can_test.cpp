// SLCAN over the links that every Linux has: TCP on loopback and pseudo terminals.
#include "hal/linux/slcan_can.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/support/free_port.hpp"

namespace s4tp::hal::linux_host {
namespace {

struct End {
  ByteLink link;
  SlcanCan can{link};

  explicit End(const std::string& text) {
    BusName name;
    Reason reason;
    EXPECT_TRUE(parse_bus_name(text.c_str(), name, reason)) << reason.text;
    EXPECT_TRUE(link.open(name, reason)) << reason.text;
  }
  /// Waits up to 2 s for a frame. \return its id, -1 without one
  int next() {
    CanFrame frame;
    for (int i = 0; i < 200; ++i) {
      if (can.receive(frame)) return static_cast<int>(frame.id);
      (void)can.wait(10);
    }
    return -1;
  }
  bool until(CanState state) {
    CanFrame frame;
    for (int i = 0; i < 200 && can.state() != state; ++i) {
      (void)can.wait(10);
      while (can.receive(frame)) {
      }
    }
    return can.state() == state;
  }
  std::vector<LinkNews> news() {
    std::vector<LinkNews> all;
    for (LinkNews one{}; can.take_news(one);) all.push_back(one);
    return all;
  }
};

CanFrame frame_of(std::uint32_t id) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  return frame;
}

/// A pseudo terminal; the test holds the end that a board would be.
struct Board {
  int end = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  std::string path;

  Board() {
    EXPECT_EQ(grantpt(end), 0);
    EXPECT_EQ(unlockpt(end), 0);
    if (const char* name = ptsname(end); name != nullptr) path = name;  // without devpts there is none
  }
  ~Board() { close(end); }
  void say(const std::string& text) {
    EXPECT_EQ(write(end, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// All that comes until `last` does, or nothing for 2 s.
  std::string hear(const std::string& last) {
    std::string heard;
    for (int i = 0; i < 2000 && heard.find(last) == std::string::npos; ++i) {
      char text[256];
      const ssize_t size = read(end, text, sizeof text);
      if (size > 0) heard.append(text, static_cast<std::size_t>(size));
      if (size <= 0) usleep(1000);
    }
    return heard;
  }
};

// LINUX-050, LINUX-051 Both ways between a listener and a caller, though each is told S6 and O by the other.
TEST(SlcanTcp, BothWays) {
  const std::string place = "127.0.0.1:" + test::free_port();
  End world("slcan:listen:" + place);
  End board("slcan:tcp:" + place);
  ASSERT_TRUE(board.until(CanState::kActive));
  ASSERT_TRUE(world.until(CanState::kActive));
  for (std::uint32_t id = 1; id <= 100; ++id) {
    ASSERT_TRUE(world.can.send(frame_of(id)));
    ASSERT_EQ(board.next(), static_cast<int>(id));
    ASSERT_TRUE(board.can.send(frame_of(id + 0x100)));
    ASSERT_EQ(world.next(), static_cast<int>(id + 0x100));
  }
  EXPECT_EQ(world.can.counters().errors, 0U);
  EXPECT_EQ(world.can.counters().sent, 100U);
}

// LINUX-051 A peer that does not read for a while costs nothing as long as the queue has room: what the
// kernel's buffers do not take waits, and comes out in order.
TEST(SlcanTcp, SlowPeerLosesNothing) {
  const std::string place = "127.0.0.1:" + test::free_port();
  End world("slcan:listen:" + place);
  End board("slcan:tcp:" + place);
  ASSERT_TRUE(board.until(CanState::kActive));
  ASSERT_TRUE(world.until(CanState::kActive));
  std::uint32_t accepted = 0;
  while (accepted < 2'000'000 && world.can.send(frame_of(accepted % 0x800))) ++accepted;
  EXPECT_EQ(world.can.counters().dropped, 1U);  // the one that ended the loop
  CanFrame frame;
  std::uint32_t read = 0;
  for (int turn = 0; turn < 100'000 && read < accepted; ++turn) {
    while (board.can.receive(frame)) ASSERT_EQ(frame.id, read++ % 0x800);
    (void)world.can.wait(0);
    if (read < accepted) (void)board.can.wait(1);
  }
  EXPECT_EQ(read, accepted);
}

// LINUX-052, LINUX-041 The peer goes: down, and frames are refused; another one comes: back.
TEST(SlcanTcp, PeerGoneAndBack) {
  const std::string place = "127.0.0.1:" + test::free_port();
  auto world = std::make_unique<End>("slcan:listen:" + place);
  End board("slcan:tcp:" + place);
  ASSERT_TRUE(world->until(CanState::kActive));
  ASSERT_TRUE(board.until(CanState::kActive));
  EXPECT_TRUE(board.news().empty());  // the first peer is no news
  world.reset();
  ASSERT_TRUE(board.until(CanState::kDown));
  EXPECT_FALSE(board.can.send(frame_of(1)));
  EXPECT_EQ(board.can.counters().dropped, 1U);
  world = std::make_unique<End>("slcan:listen:" + place);
  ASSERT_TRUE(board.until(CanState::kActive));
  ASSERT_TRUE(world->until(CanState::kActive));
  EXPECT_TRUE(board.can.send(frame_of(2)));
  EXPECT_EQ(world->next(), 2);
  EXPECT_EQ(board.news(), (std::vector{LinkNews::kGone, LinkNews::kBack}));
}

// LINUX-041 Nobody there yet is no error: the caller calls again.
TEST(SlcanTcp, ListenerMayComeLater) {
  const std::string place = "127.0.0.1:" + test::free_port();
  End board("slcan:tcp:" + place);
  EXPECT_FALSE(board.can.wait(20));
  EXPECT_FALSE(board.can.send(frame_of(1)));
  End world("slcan:listen:" + place);
  EXPECT_TRUE(board.until(CanState::kActive));
}

// LINUX-052 An adapter is told to open at 500 kbit/s (S6) before anything else; what it answers is not a
// frame.
TEST(SlcanPty, OpensTheAdapter) {
  Board board;
  End end("slcan:pty:" + board.path);
  ASSERT_TRUE(end.until(CanState::kActive));
  ASSERT_TRUE(end.can.send(frame_of(0x123)));
  EXPECT_EQ(board.hear("t12380000000000000000\r"), "C\rS6\rO\rt12380000000000000000\r");
  board.say("\r\r\rz\rt0101AB\r");
  EXPECT_EQ(end.next(), 0x010);
  EXPECT_EQ(end.can.counters().errors, 0U);
}

// LINUX-050 A board that prints text between its frames, and says no: counted, and the frames are read.
TEST(SlcanPty, GarbageIsCountedAndReadOver) {
  Board board;
  End end("slcan:pty:" + board.path);
  board.say("booting...\r\nt0100\r\a\xFF\xFEt0110\rt0120\r");
  EXPECT_EQ(end.next(), 0x010);
  EXPECT_EQ(end.next(), 0x012);  // 011 stood behind bytes that are none of a line
  EXPECT_EQ(end.can.counters().errors, 3U);
}

// LINUX-050 With a filter, only its ids; the first and the last there are, among them.
TEST(SlcanPty, FilterLeavesItsIds) {
  Board board;
  End end("slcan:pty:" + board.path);
  const std::uint32_t ids[] = {0x000, 0x013, 0x7FF};
  end.can.filter(ids, 3);
  board.say("t0120\rt0130\rt7FE0\rt7FF0\rt0000\r");
  EXPECT_EQ(end.next(), 0x013);
  EXPECT_EQ(end.next(), 0x7FF);
  EXPECT_EQ(end.next(), 0x000);
  EXPECT_EQ(end.can.counters().received, 3U);
}

// LINUX-040 A pseudo terminal takes any rate asked for by name; rates Linux has no name for are refused.
TEST(SlcanTty, RateMustBeOneThatExists) {
  Board board;
  BusName name;
  Reason reason;
  {
    ByteLink link;
    ASSERT_TRUE(parse_bus_name(("slcan:tty:" + board.path + "@2000000").c_str(), name, reason));
    EXPECT_TRUE(link.open(name, reason)) << reason.text;
  }
  ByteLink link;
  ASSERT_TRUE(parse_bus_name(("slcan:tty:" + board.path + "@1234567").c_str(), name, reason));
  EXPECT_FALSE(link.open(name, reason));
  EXPECT_NE(std::string(reason.text).find("rate"), std::string::npos) << reason.text;
}

}  // namespace
}  // namespace s4tp::hal::linux_host
