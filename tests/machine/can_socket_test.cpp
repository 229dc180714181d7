// The socket on a kernel that has CAN, and the interface taken away from under it. Runs as root beside a
// vcan0 of its own: in the machine (toolchain/vcan_machine.sh), never on a host's buses.
#include "hal/linux/can_socket.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "hal/linux/named_bus.hpp"

namespace s4tp::hal::linux_host {
namespace {

void shell(const std::string& command) {
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

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

/// A plain socket that sends anything.
struct Attacker {
  int descriptor = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  Attacker() {
    ifreq request{};
    std::snprintf(request.ifr_name, sizeof request.ifr_name, "vcan0");
    EXPECT_EQ(ioctl(descriptor, SIOCGIFINDEX, &request), 0);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = request.ifr_ifindex;
    EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Attacker() { close(descriptor); }
  void send(canid_t id, const std::vector<std::uint8_t>& data = std::vector<std::uint8_t>(8)) const {
    can_frame frame{};
    frame.can_id = id;
    frame.len = static_cast<std::uint8_t>(data.size());
    for (std::size_t i = 0; i < data.size(); ++i) frame.data[i] = data[i];
    ASSERT_EQ(write(descriptor, &frame, sizeof frame), static_cast<ssize_t>(sizeof frame));
  }
};

CanFrame frame_of(std::uint32_t id, std::uint8_t length = 8) {
  CanFrame frame;
  frame.id = id;
  frame.length = length;
  for (int i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(i);
  return frame;
}

class Vcan : public testing::Test {
 protected:
  void SetUp() override {
    (void)std::system("ip link del vcan0 2>/dev/null; ip link del bus7 2>/dev/null");
    shell("ip link add vcan0 type vcan && ip link set vcan0 mtu 72 up");
  }

  struct End {
    NamedBus bus;
    explicit End(const CanSocketOptions& options = {}) {
      Reason reason;
      EXPECT_TRUE(bus.open("vcan0", options, reason)) << reason.text;
    }
    LinuxCan& can() { return bus.can(); }
    /// Everything that comes until nothing has come for `quiet_ms`.
    std::vector<std::uint32_t> ids(int quiet_ms = 50) {
      std::vector<std::uint32_t> all;
      CanFrame frame;
      do {
        while (can().receive(frame)) all.push_back(frame.id);
      } while (can().wait(quiet_ms));
      return all;
    }
    /// Lets the bus run until its state is `wanted`, for 2 s at most.
    bool until(CanState wanted) {
      CanFrame frame;
      for (int i = 0; i < 100 && can().state() != wanted; ++i) {
        (void)can().wait(20);
        while (can().receive(frame)) {
        }
      }
      return can().state() == wanted;
    }
    std::vector<LinkNews> news() {
      std::vector<LinkNews> all;
      for (LinkNews one{}; can().take_news(one);) all.push_back(one);
      return all;
    }
  };
};

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

// LINUX-005, LINUX-006 Down and up: the same socket goes on.
TEST_F(Vcan, DownAndUp) {
  End from;
  End to;
  shell("ip link set vcan0 down");
  ASSERT_TRUE(to.until(CanState::kDown));
  EXPECT_FALSE(to.can().send(frame_of(1)));
  ASSERT_TRUE(from.until(CanState::kDown));
  shell("ip link set vcan0 up");
  ASSERT_TRUE(to.until(CanState::kActive));
  ASSERT_TRUE(from.until(CanState::kActive));
  EXPECT_TRUE(from.can().send(frame_of(2)));
  EXPECT_EQ(to.ids(), (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(to.news(), (std::vector{LinkNews::kDown, LinkNews::kBack}));
}

// LINUX-005 A sender alone notices as well, by the write that fails or the look at the link.
TEST_F(Vcan, SenderNoticesThatTheInterfaceIsDown) {
  End from;
  shell("ip link set vcan0 down");
  (void)from.can().send(frame_of(1));
  EXPECT_EQ(from.can().state(), CanState::kDown);
  EXPECT_EQ(from.can().counters().dropped, 1U);
}

// LINUX-005, LINUX-006, LINUX-023 Removed; another interface of that name is the bus again, with the filters
// it had.
TEST_F(Vcan, RemovedAndBack) {
  const std::uint32_t ids[] = {2};
  CanSocketOptions options;
  options.ids = ids;
  options.id_count = 1;
  End to(options);
  shell("ip link del vcan0");
  ASSERT_TRUE(to.until(CanState::kDown));
  shell("ip link add vcan0 type vcan && ip link set vcan0 up");
  ASSERT_TRUE(to.until(CanState::kActive));
  const Attacker attacker;
  attacker.send(1);
  attacker.send(2);
  EXPECT_EQ(to.ids(), (std::vector<std::uint32_t>{2}));
  const std::vector<LinkNews> news = to.news();
  ASSERT_FALSE(news.empty());
  EXPECT_EQ(news.back(), LinkNews::kBack);
  EXPECT_NE(std::find(news.begin(), news.end(), LinkNews::kGone), news.end());
}

// LINUX-023 Renamed: frames of the interface that now is bus7 are not taken; with its old name they are
// again.
TEST_F(Vcan, RenamedAndBack) {
  End to;
  shell("ip link set vcan0 down && ip link set vcan0 name bus7 && ip link set bus7 up");
  ASSERT_TRUE(to.until(CanState::kDown));
  shell("cansend bus7 001#00");
  EXPECT_TRUE(to.ids(300).empty());
  shell("ip link set bus7 down && ip link set bus7 name vcan0 && ip link set vcan0 up");
  ASSERT_TRUE(to.until(CanState::kActive));
  shell("cansend vcan0 002#00");
  EXPECT_EQ(to.ids(300), (std::vector<std::uint32_t>{2}));
  const std::vector<LinkNews> news = to.news();
  EXPECT_NE(std::find(news.begin(), news.end(), LinkNews::kRenamed), news.end());
  EXPECT_EQ(news.back(), LinkNews::kBack);
}

// LINUX-004, LINUX-010 What a controller reports: passive, bus-off, restarted. A vcan has no controller to
// restart.
TEST_F(Vcan, ErrorFramesBecomeStates) {
  CanSocketOptions options;
  options.believe_local_reports = true;
  End end(options);
  shell("cansend vcan0 20000004#0020000000000000");  // CAN_ERR_CRTL, transmitter passive
  ASSERT_TRUE(end.until(CanState::kPassive));
  shell("cansend vcan0 20000040#0000000000000000");  // CAN_ERR_BUSOFF
  ASSERT_TRUE(end.until(CanState::kBusOff));
  EXPECT_FALSE(end.can().send(frame_of(1)));
  (void)end.ids(200);
  shell("cansend vcan0 20000100#0000000000000000");  // CAN_ERR_RESTARTED
  ASSERT_TRUE(end.until(CanState::kActive));
  EXPECT_TRUE(end.can().send(frame_of(1)));
  EXPECT_EQ(end.news(), (std::vector{LinkNews::kPassive, LinkNews::kBusOff, LinkNews::kRestartRefused,
                                     LinkNews::kActive}));
  EXPECT_EQ(end.can().counters().errors, 3U);
}

// LINUX-020 An error frame that a program of this machine wrote is no controller's word.
TEST_F(Vcan, ForgedErrorFramesChangeNothing) {
  End end;
  shell("cansend vcan0 20000040#0000000000000000");
  (void)end.ids(100);
  EXPECT_EQ(end.can().state(), CanState::kActive);
  EXPECT_EQ(end.can().counters().errors, 0U);
}

// LINUX-032 Down, absent, and no CAN interface: each refused with its reason.
TEST_F(Vcan, RefusesWhatIsNoBus) {
  shell("ip link set vcan0 down");
  for (const auto& [name, reason_part] :
       {std::pair{"vcan0", "is down"}, std::pair{"vcan9", "no such interface"},
        std::pair{"lo", "not a CAN"}}) {
    NamedBus bus;
    Reason reason;
    EXPECT_FALSE(bus.open(name, {}, reason));
    EXPECT_NE(std::string(reason.text).find(reason_part), std::string::npos) << reason.text;
  }
}

}  // namespace
}  // namespace s4tp::hal::linux_host
