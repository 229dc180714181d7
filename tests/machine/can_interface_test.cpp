// The socket when the interface under it goes down, is taken away or renamed, or reports errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/machine/vcan.hpp"

namespace s4tp::hal::linux_host {
namespace {

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
