// SocketCAN on a real pair of sockets, which needs no CAN in the kernel and fills up as a CAN socket does.

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <memory>
#include <vector>

#include "hal/linux/can_socket.hpp"
#include "hal/linux/socket_can.hpp"
#include "tests/support/fake_bus.hpp"

namespace s4tp::hal::linux_host {
namespace {

// LINUX-002 With a real socket that is full after a few frames (EAGAIN) and a reader that is slow: 2000
// frames go in as fast as they are taken, 2000 come out, in order.
TEST(CanSocketPair, FullSocketLosesNothing) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  const int size = 2048;
  ASSERT_EQ(setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &size, sizeof size), 0);
  CanSocket socket;
  socket.adopt(ends[0]);
  SocketCan can(socket);
  Reason reason;
  ASSERT_TRUE(can.open(reason)) << reason.text;

  constexpr std::uint32_t kFrames = 2000;
  std::uint32_t next = 0;
  std::uint32_t read = 0;
  bool was_full = false;
  for (int turn = 0; turn < 10'000 && read < kFrames; ++turn) {
    while (next < kFrames && can.queued() < SocketCan::kQueueFrames)
      ASSERT_TRUE(can.send(frame_of(next++ % 0x800)));
    was_full = was_full || can.queued() == SocketCan::kQueueFrames;
    can_frame frame{};
    for (int i = 0; i < 3 && recv(ends[1], &frame, sizeof frame, MSG_DONTWAIT) > 0; ++i) {
      ASSERT_EQ(frame.can_id, read++ % 0x800);
    }
    CanFrame nothing;
    EXPECT_FALSE(can.receive(nothing));
  }
  EXPECT_EQ(read, kFrames);
  EXPECT_TRUE(was_full);
  EXPECT_EQ(can.counters().sent, kFrames);
  EXPECT_EQ(can.counters().dropped, 0U);
  close(ends[1]);
}

// LINUX-022 Frames of 8 bytes and less are classic ones (16 bytes to the kernel), longer ones are FD frames
// (72); both are read back with their length.
TEST(CanSocketPair, LengthsGoThrough) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  CanSocket sockets[2];
  std::vector<std::unique_ptr<SocketCan>> can;
  Reason reason;
  for (int i = 0; i < 2; ++i) {
    sockets[i].adopt(ends[i]);
    can.push_back(std::make_unique<SocketCan>(sockets[i]));
    ASSERT_TRUE(can.back()->open(reason));
  }
  for (int length = 0; length <= 64; ++length) {
    CanFrame frame = frame_of(0x123, static_cast<std::uint8_t>(length));
    for (int i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(200 - i);
    ASSERT_EQ(can[0]->send(frame), is_can_length(frame.length)) << length;
    CanFrame read;
    ASSERT_EQ(can[1]->receive(read), is_can_length(frame.length)) << length;
    if (!is_can_length(frame.length)) continue;
    EXPECT_EQ(read.length, length);
    EXPECT_EQ(std::memcmp(read.data, frame.data, sizeof read.data), 0);
  }
}

// LINUX-001 Messages that are no frames, and frames of other kinds, are read over; what follows them arrives.
TEST(CanSocketPair, OtherMessagesAreReadOver) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
  CanSocket socket;
  socket.adopt(ends[0]);
  SocketCan can(socket);
  Reason reason;
  ASSERT_TRUE(can.open(reason));
  can_frame frame{};
  frame.len = 8;
  for (const canid_t id : {CAN_EFF_FLAG | 0x10U, CAN_RTR_FLAG | 0x10U, canid_t{0x7AA}}) {
    frame.can_id = id;
    ASSERT_GT(send(ends[1], &frame, sizeof frame, 0), 0);
    ASSERT_GT(send(ends[1], "short", 5, 0), 0);
  }
  CanFrame read;
  ASSERT_TRUE(can.receive(read));
  EXPECT_EQ(read.id, 0x7AAU);
  EXPECT_FALSE(can.receive(read));
  close(ends[1]);
}

}  // namespace
}  // namespace s4tp::hal::linux_host
