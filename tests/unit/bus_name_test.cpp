#include "hal/linux/bus_name.hpp"

#include <gtest/gtest.h>

#include <string>

#include "hal/linux/named_bus.hpp"
#include "tests/support/free_port.hpp"

namespace s4tp::hal::linux_host {
namespace {

std::string refusal(const std::string& text) {
  BusName name;
  Reason reason;
  return parse_bus_name(text.c_str(), name, reason) ? "" : reason.text;
}

BusName parsed(const std::string& text) {
  BusName name;
  Reason reason;
  EXPECT_TRUE(parse_bus_name(text.c_str(), name, reason)) << reason.text;
  return name;
}

// LINUX-030 One of each kind.
TEST(BusName, EveryKind) {
  EXPECT_EQ(parsed("vcan0").kind, BusKind::kInterface);
  EXPECT_STREQ(parsed("vcan0").place, "vcan0");
  EXPECT_EQ(parsed("slcan:tcp:localhost:5000").kind, BusKind::kTcp);
  EXPECT_STREQ(parsed("slcan:tcp:localhost:5000").place, "localhost");
  EXPECT_EQ(parsed("slcan:tcp:::1:5000").port, 5000);
  EXPECT_STREQ(parsed("slcan:tcp:::1:5000").place, "::1");
  EXPECT_EQ(parsed("slcan:listen:127.0.0.1:65535").kind, BusKind::kListen);
  EXPECT_STREQ(parsed("slcan:pty:/dev/pts/3").place, "/dev/pts/3");
  EXPECT_EQ(parsed("slcan:tty:/dev/ttyACM0@3000000").baud, 3'000'000U);
  EXPECT_STREQ(parsed("slcan:tty:/dev/odd@name@1000000").place, "/dev/odd@name");
}

// LINUX-030 What is none says what would be one.
TEST(BusName, RefusesWithWhatIsAccepted) {
  for (const std::string text :
       {"", "a_name_too_long_for_linux", "slcan:", "slcan:udp:h:1", "slcan:tcp:host", "slcan:tcp::5000",
        "slcan:tcp:host:0", "slcan:tcp:host:65536", "slcan:tcp:host:5000x",
        "slcan:pty:", "slcan:tty:/dev/ttyS0", "slcan:tty:@1000000", "../can0", "can 0", ".."}) {
    EXPECT_NE(refusal(text).find("slcan:tcp:HOST:PORT"), std::string::npos) << text;
  }
  EXPECT_FALSE(refusal("slcan:pty:" + std::string(100, 'x')).empty());
  EXPECT_FALSE(refusal(std::string(1000, 'x')).empty());
}

// LINUX-031 22 characters of 10 bits at 115200 baud are 1.9 ms a frame: less than a third of what the bus
// carries.
TEST(BusName, RefusesSlowLines) {
  EXPECT_NE(refusal("slcan:tty:/dev/ttyS0@115200").find("1000000"), std::string::npos);
  EXPECT_NE(refusal("slcan:tty:/dev/ttyS0@999999").find("too slow"), std::string::npos);
  EXPECT_EQ(refusal("slcan:tty:/dev/ttyS0@1000000"), "");
}

// LINUX-032 What is not there is refused by name and reason, not by silence later.
TEST(NamedBus, RefusesWhatIsNotThere) {
  for (const std::string text : {"nocan7", "slcan:pty:/dev/pts/98765", "slcan:tty:/dev/nosuch@1000000",
                                 "slcan:pty:/dev/null", "slcan:tcp:no.such.host.invalid:5000"}) {
    NamedBus bus;
    Reason reason;
    EXPECT_FALSE(bus.open(text.c_str(), {}, reason)) << text;
    EXPECT_NE(std::string(reason.text), "") << text;
  }
}

// LINUX-042 All of a machine's addresses, in any spelling, want the word for it; one address does not.
TEST(NamedBus, ListensToEverybodyOnlyWhenTold) {
  for (const std::string host : {"0.0.0.0", "0", "::", "::ffff:0.0.0.0"}) {
    NamedBus bus;
    Reason reason;
    EXPECT_FALSE(bus.open(("slcan:listen:" + host + ":" + test::free_port()).c_str(), {}, reason)) << host;
    EXPECT_NE(std::string(reason.text).find("slcan:listen:anyone:PORT"), std::string::npos) << reason.text;
  }
  for (const std::string host : {"anyone", "127.0.0.1"}) {
    NamedBus bus;
    Reason reason;
    EXPECT_TRUE(bus.open(("slcan:listen:" + host + ":" + test::free_port()).c_str(), {}, reason))
        << reason.text;
  }
}

}  // namespace
}  // namespace s4tp::hal::linux_host
