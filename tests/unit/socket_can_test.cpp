// The behaviour on top of a socket, with a socket whose every answer the test gives. With a real one:
// socket_pair_test; the socket itself, on a vcan: tests/machine.
#include "hal/linux/socket_can.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <deque>
#include <vector>

#include "hal/linux/can_socket.hpp"
#include "tests/support/fake_bus.hpp"

namespace s4tp::hal::linux_host {
namespace {

struct FakeSocket final : FrameSocket {
  struct Incoming {
    ReadResult result;
    Reading reading;
  };
  std::deque<Incoming> incoming;
  std::deque<WriteResult> answers;  ///< to the next writes; kSent when there is none
  std::vector<std::uint32_t> written;
  LinkState link = LinkState::kUp;
  bool there = true;
  bool is_open = false;
  bool can_restart = true;
  int opened = 0;
  std::uint64_t now = 0;
  std::vector<std::uint64_t> restarts_ms;

  bool open(Reason&) override {
    is_open = there;
    opened += there ? 1 : 0;
    return there;
  }
  void close() override { is_open = false; }
  ReadResult read(Reading& reading) override {
    if (incoming.empty()) return ReadResult::kNothing;
    const Incoming next = incoming.front();
    incoming.pop_front();
    reading = next.reading;
    return next.result;
  }
  WriteResult write(const CanFrame& frame) override {
    WriteResult answer = WriteResult::kSent;
    if (!answers.empty()) {
      answer = answers.front();
      answers.pop_front();
    }
    if (answer == WriteResult::kSent) written.push_back(frame.id);
    return answer;
  }
  bool wait(int timeout_ms) override {
    if (!incoming.empty()) return true;
    now += static_cast<std::uint64_t>(timeout_ms);
    return false;
  }
  LinkState look() override { return link; }
  bool restart() override {
    restarts_ms.push_back(now);
    return can_restart;
  }
  std::uint64_t now_ms() const override { return now; }

  void frame(std::uint32_t id, bool local = true, std::uint32_t lost = 0) {
    Incoming next{ReadResult::kFrame, {}};
    next.reading.frame.id = id;
    next.reading.local = local;
    next.reading.lost = lost;
    next.reading.time_us = 1000 + id;
    incoming.push_back(next);
  }
  void report(bool ControllerReport::*what) {
    Incoming next{ReadResult::kReport, {}};
    next.reading.report.*what = true;
    incoming.push_back(next);
  }
  void fails() { incoming.push_back({ReadResult::kFailed, {}}); }
};

class SocketCanTest : public testing::Test {
 protected:
  SocketCanTest() {
    Reason reason;
    EXPECT_TRUE(can.open(reason));
  }
  std::vector<LinkNews> news() {
    std::vector<LinkNews> all;
    for (LinkNews one{}; can.take_news(one);) all.push_back(one);
    return all;
  }
  void run(int duration_ms) {
    CanFrame frame;
    const std::uint64_t end = socket.now + static_cast<std::uint64_t>(duration_ms);
    while (socket.now < end) {
      const std::uint64_t left = end - socket.now;
      (void)can.wait(left < 10 ? static_cast<int>(left) : 10);
      while (can.receive(frame)) {
      }
    }
  }
  FakeSocket socket;
  SocketCan can{socket};
};

// LINUX-001, LINUX-007 Order, time of arrival, and what the socket lost before the second frame.
TEST_F(SocketCanTest, ReceivesInOrderWithTimeAndLosses) {
  socket.frame(1);
  socket.report(&ControllerReport::passive);
  socket.frame(2, true, 5);
  CanFrame frame;
  ASSERT_TRUE(can.receive(frame));
  EXPECT_EQ(frame.id, 1U);
  EXPECT_EQ(can.received_at_us(), 1001U);
  ASSERT_TRUE(can.receive(frame));
  EXPECT_EQ(frame.id, 2U);
  EXPECT_FALSE(can.receive(frame));
  EXPECT_EQ(can.counters().received, 2U);
  EXPECT_EQ(can.counters().dropped, 5U);
  EXPECT_EQ(can.counters().errors, 1U);
}

// LINUX-002 A full socket keeps nothing back but time: the frames go out later, all of them, in order.
TEST_F(SocketCanTest, FullSocketLosesNothing) {
  socket.answers.assign(7, WriteResult::kFull);
  for (std::uint32_t id = 1; id <= 5; ++id) EXPECT_TRUE(can.send(frame_of(id)));
  EXPECT_TRUE(socket.written.empty());
  run(20);
  EXPECT_EQ(socket.written, (std::vector<std::uint32_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(can.counters().sent, 5U);
  EXPECT_EQ(can.counters().dropped, 0U);
}

// LINUX-003 256 frames fit; the next one is refused and counted, and those before it still go out.
TEST_F(SocketCanTest, FullQueueRefusesTheNewest) {
  socket.answers.assign(100'000, WriteResult::kFull);
  for (std::uint32_t id = 0; id < SocketCan::kQueueFrames; ++id) ASSERT_TRUE(can.send(frame_of(id)));
  EXPECT_FALSE(can.send(frame_of(0x7FF)));
  EXPECT_EQ(can.counters().dropped, 1U);
  socket.answers.clear();
  run(2);
  ASSERT_EQ(socket.written.size(), 256U);
  EXPECT_EQ(socket.written.back(), 255U);
}

// LINUX-003 Lengths CAN FD does not have, ids of 29 bits: refused before they reach the socket.
TEST_F(SocketCanTest, RefusesWhatIsNoFrame) {
  for (const int length : {9, 11, 13, 25, 33, 63, 65}) {
    EXPECT_FALSE(can.send(frame_of(1, static_cast<std::uint8_t>(length)))) << length;
  }
  for (const int length : {0, 8, 12, 16, 20, 24, 32, 48, 64}) {
    EXPECT_TRUE(can.send(frame_of(1, static_cast<std::uint8_t>(length)))) << length;
  }
  EXPECT_FALSE(can.send(frame_of(0x800)));
  EXPECT_EQ(can.counters().dropped, 8U);
  EXPECT_EQ(can.counters().sent, 9U);
}

// LINUX-007 A frame the socket refuses for good does not stand in the way of the next one.
TEST_F(SocketCanTest, RefusedFrameMakesWay) {
  socket.answers = {WriteResult::kRefused};
  EXPECT_TRUE(can.send(frame_of(1, 64)));
  EXPECT_TRUE(can.send(frame_of(2)));
  EXPECT_EQ(socket.written, (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(can.counters().dropped, 1U);
  EXPECT_EQ(can.counters().errors, 1U);
}

// LINUX-004 Passive and back, without ceasing to send.
TEST_F(SocketCanTest, PassiveAndBack) {
  socket.report(&ControllerReport::passive);
  run(10);
  EXPECT_EQ(can.state(), CanState::kPassive);
  EXPECT_TRUE(can.send(frame_of(1)));
  socket.report(&ControllerReport::active);
  run(10);
  EXPECT_EQ(can.state(), CanState::kActive);
  EXPECT_EQ(news(), (std::vector{LinkNews::kPassive, LinkNews::kActive}));
}

// LINUX-004, LINUX-003 Bus-off refuses frames and drops those that wait; the controller's word ends it.
TEST_F(SocketCanTest, BusOffAndBack) {
  socket.answers.assign(3, WriteResult::kFull);
  EXPECT_TRUE(can.send(frame_of(1)));
  socket.report(&ControllerReport::bus_off);
  CanFrame frame;
  EXPECT_FALSE(can.receive(frame));
  EXPECT_EQ(can.state(), CanState::kBusOff);
  EXPECT_FALSE(can.send(frame_of(2)));
  EXPECT_EQ(can.counters().dropped, 2U);
  socket.answers.clear();
  socket.report(&ControllerReport::active);
  run(10);
  EXPECT_EQ(can.state(), CanState::kActive);
  EXPECT_TRUE(socket.written.empty());
  EXPECT_TRUE(can.send(frame_of(3)));
  EXPECT_EQ(socket.written, (std::vector<std::uint32_t>{3}));
}

// LINUX-004 Another node's frame can only come through a controller that is on the bus; a local program's
// proves nothing.
TEST_F(SocketCanTest, OnlyAnotherNodesFrameEndsBusOff) {
  socket.report(&ControllerReport::bus_off);
  socket.frame(1, true);
  run(10);
  EXPECT_EQ(can.state(), CanState::kBusOff);
  socket.frame(2, false);
  run(10);
  EXPECT_EQ(can.state(), CanState::kActive);
}

// LINUX-010 100 ms after bus-off, then 200, 400, 800 and 1600 ms apart: 100, 300, 700, 1500, 3100, 4700.
TEST_F(SocketCanTest, AsksForARestartEverMoreRarely) {
  socket.report(&ControllerReport::bus_off);
  run(5000);
  ASSERT_EQ(socket.restarts_ms.size(), 6U);
  const std::uint64_t expected_ms[] = {100, 300, 700, 1500, 3100, 4700};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(static_cast<double>(socket.restarts_ms[static_cast<std::size_t>(i)]),
                static_cast<double>(expected_ms[i]), 60.0);
  }
  socket.report(&ControllerReport::active);
  run(5000);
  EXPECT_EQ(socket.restarts_ms.size(), 6U);
}

// LINUX-010 Without the right to restart it is said once, and tried on.
TEST_F(SocketCanTest, SaysOnceThatItCannotRestart) {
  socket.can_restart = false;
  socket.report(&ControllerReport::bus_off);
  run(2000);
  EXPECT_EQ(news(), (std::vector{LinkNews::kBusOff, LinkNews::kRestartRefused}));
  EXPECT_GE(socket.restarts_ms.size(), 3U);
}

// LINUX-005, LINUX-006 Down: told by a failing read at once; the queue is dropped; up again: the same socket
// goes on.
TEST_F(SocketCanTest, InterfaceDownAndUp) {
  socket.answers.assign(2, WriteResult::kFull);
  EXPECT_TRUE(can.send(frame_of(1)));
  socket.link = LinkState::kDown;
  socket.fails();
  CanFrame frame;
  EXPECT_FALSE(can.receive(frame));
  EXPECT_EQ(can.state(), CanState::kDown);
  EXPECT_FALSE(can.send(frame_of(2)));
  EXPECT_EQ(can.counters().dropped, 2U);
  run(500);
  EXPECT_EQ(can.state(), CanState::kDown);
  socket.link = LinkState::kUp;
  socket.answers.clear();
  run(200);
  EXPECT_EQ(can.state(), CanState::kActive);
  EXPECT_TRUE(can.send(frame_of(3)));
  EXPECT_EQ(socket.written, (std::vector<std::uint32_t>{3}));
  EXPECT_EQ(socket.opened, 1);
  EXPECT_EQ(news(), (std::vector{LinkNews::kDown, LinkNews::kBack}));
}

// LINUX-005, LINUX-006 Gone, noticed within 100 ms though nothing fails; a new interface of that name is
// opened anew.
TEST_F(SocketCanTest, InterfaceGoneAndBack) {
  for (const LinkState how : {LinkState::kGone, LinkState::kRenamed}) {
    const int opened = socket.opened;
    socket.link = how;
    socket.there = false;
    run(110);
    EXPECT_EQ(can.state(), CanState::kDown);
    EXPECT_FALSE(socket.is_open);
    run(1000);
    socket.link = LinkState::kUp;
    socket.there = true;
    run(210);
    EXPECT_EQ(can.state(), CanState::kActive);
    EXPECT_EQ(socket.opened, opened + 1);
  }
  EXPECT_EQ(news(), (std::vector{LinkNews::kGone, LinkNews::kBack, LinkNews::kRenamed, LinkNews::kBack}));
}

// LINUX-005 An interface is taken down before it can be renamed: both are told, and the old name counts.
TEST_F(SocketCanTest, DownThenRenamed) {
  socket.link = LinkState::kDown;
  run(110);
  socket.link = LinkState::kRenamed;
  socket.there = false;
  run(110);
  EXPECT_FALSE(socket.is_open);
  EXPECT_EQ(news(), (std::vector{LinkNews::kDown, LinkNews::kRenamed}));
}

// LINUX-005 A failing write is noticed like a failing read; nothing is counted as sent.
TEST_F(SocketCanTest, FailingWriteIsNoticed) {
  socket.answers.assign(5, WriteResult::kFailed);
  socket.link = LinkState::kDown;
  (void)can.send(frame_of(1));
  EXPECT_EQ(can.state(), CanState::kDown);
  EXPECT_EQ(can.counters().sent, 0U);
}

// A time-out is kept whatever the link does: 250 ms of waiting are 250 ms.
TEST_F(SocketCanTest, WaitsAsLongAsItIsTold) {
  EXPECT_FALSE(can.wait(250));
  EXPECT_EQ(socket.now, 250U);
  socket.there = false;
  socket.link = LinkState::kGone;
  EXPECT_FALSE(can.wait(250));
  EXPECT_EQ(socket.now, 500U);
}

}  // namespace
}  // namespace s4tp::hal::linux_host
