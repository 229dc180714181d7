// The socket on a kernel that has CAN. Runs as root beside a vcan0 of its own: in the machine
// (toolchain/vcan_machine.sh), never on a host's buses.
#include "hal/linux/can_socket.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "tests/machine/vcan.hpp"

namespace s4tp::hal::linux_host {
namespace {

std::string output_of(const std::string& command) {
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  for (int character = fgetc(pipe); character != EOF; character = fgetc(pipe))
    text += static_cast<char>(character);
  pclose(pipe);
  return text;
}

/// Frames tc says it had to drop.
int dropped_by_queue() {
  const std::string text = output_of("tc -s qdisc show dev vcan0");
  const std::size_t at = text.find("dropped ");
  return at == std::string::npos ? -1 : std::atoi(text.c_str() + at + 8);
}

// LINUX-020 Of six frames two are ours: the others have another id, 29 bits, or no data.
TEST_F(Vcan, FiltersLeaveOurFramesOnly) {
  const std::uint32_t ids[] = {0x010, 0x013};
  CanSocketOptions options;
  options.ids = ids;
  options.id_count = 2;
  End end(options);
  const Attacker attacker;
  for (const canid_t id : {canid_t{0x010}, canid_t{0x011}, CAN_EFF_FLAG | 0x010U, CAN_RTR_FLAG | 0x010U,
                           CAN_EFF_FLAG | CAN_RTR_FLAG | 0x013U, canid_t{0x013}}) {
    attacker.send(id);
  }
  EXPECT_EQ(end.ids(), (std::vector<std::uint32_t>{0x010, 0x013}));
  EXPECT_EQ(end.can().counters().received, 2U);
}

// LINUX-020 Without ids every 11-bit data frame is taken, and nothing else.
TEST_F(Vcan, NoIdsMeansAll) {
  End end;
  const Attacker attacker;
  for (const canid_t id : {canid_t{0}, CAN_EFF_FLAG | 0x010U, CAN_RTR_FLAG | 0x010U, canid_t{0x7FF}})
    attacker.send(id);
  EXPECT_EQ(end.ids(), (std::vector<std::uint32_t>{0, 0x7FF}));
}

// LINUX-021 Frames carry the time they arrived, not the time they were read. (The kernel begins to stamp a
// moment after the first socket of the machine asks for it.)
TEST_F(Vcan, TimesAreThoseOfArrival) {
  End end;
  usleep(500'000);
  const Attacker attacker;
  attacker.send(1);
  usleep(300'000);
  attacker.send(2);
  CanFrame frame;
  ASSERT_TRUE(end.can().receive(frame));
  const std::uint64_t first_us = end.can().received_at_us();
  ASSERT_TRUE(end.can().receive(frame));
  const std::uint64_t second_us = end.can().received_at_us();
  EXPECT_GE(second_us - first_us, 300'000U);
  EXPECT_LT(second_us - first_us, 2'000'000U);
  EXPECT_NEAR(static_cast<double>(second_us) / 1e6, static_cast<double>(std::time(nullptr)), 3.0);
}

// LINUX-021, LINUX-007 Nobody reads while 5000 frames come: what the socket has no room for is counted, to
// the frame. (The count comes with the next frame that is queued.)
TEST_F(Vcan, LossesAreCounted) {
  End end;
  const Attacker attacker;
  for (int i = 0; i < 5000; ++i) attacker.send(1);
  const std::size_t kept = end.ids().size();
  attacker.send(2);
  EXPECT_EQ(end.ids().size(), 1U);
  EXPECT_LT(kept, 5000U);
  EXPECT_EQ(kept + end.can().counters().dropped, 5000U);
}

// LINUX-002 A bus slower than we are. Its queue of 4 frames (16 bytes each to tc) is full: ENOBUFS, which tc
// counts as drops; or our socket is full before: EAGAIN, and tc has dropped nothing. All frames arrive, in
// order, either way.
TEST_F(Vcan, FullBusLosesNothing) {
  for (const bool enobufs : {true, false}) {
    shell(std::string("tc qdisc replace dev vcan0 root tbf rate 256kbit burst 128 limit ") +
          (enobufs ? "64" : "65536"));
    End from;
    End to;
    std::vector<std::uint32_t> sent;
    std::vector<std::uint32_t> received;
    const auto read_all = [&] {
      CanFrame frame;
      while (to.can().receive(frame)) received.push_back(frame.id);
    };
    for (std::uint32_t id = 0; id < 1000; ++id) {
      if (id % 200 == 199) (void)from.can().wait(60);  // five times the queue: 1000 frames take 0.5 s
      while (from.can().counters().sent + 250 < id) (void)from.can().wait(1);
      ASSERT_TRUE(from.can().send(frame_of(id))) << id;
      sent.push_back(id);
      read_all();
    }
    for (int i = 0; i < 3000 && received.size() < sent.size(); ++i) {
      (void)from.can().wait(1);
      read_all();
    }
    EXPECT_EQ(received, sent);
    EXPECT_EQ(from.can().counters().dropped, 0U);
    EXPECT_EQ(dropped_by_queue() > 0, enobufs) << output_of("tc -s qdisc show dev vcan0");
    shell("tc qdisc del dev vcan0 root");
  }
}

// LINUX-022 64 bytes on an interface for CAN FD; on a classic one they are refused and counted, and 8 still
// go.
TEST_F(Vcan, FlexibleFramesNeedAnInterfaceForThem) {
  {
    End from;
    End to;
    ASSERT_TRUE(from.can().send(frame_of(1, 64)));
    CanFrame frame;
    ASSERT_TRUE(to.can().wait(1000));
    ASSERT_TRUE(to.can().receive(frame));
    EXPECT_EQ(frame.length, 64);
    EXPECT_EQ(frame.data[63], 63);
  }
  shell("ip link set vcan0 down && ip link set vcan0 mtu 16 up");
  End from;
  End to;
  (void)from.can().send(frame_of(1, 64));
  EXPECT_EQ(from.can().counters().dropped, 1U);
  ASSERT_TRUE(from.can().send(frame_of(2, 8)));
  EXPECT_EQ(to.ids(), (std::vector<std::uint32_t>{2}));
}

}  // namespace
}  // namespace s4tp::hal::linux_host
